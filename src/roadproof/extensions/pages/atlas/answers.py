"""The questions of the atlas and their answers, kept in folders of evidence below the pages."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from roadproof.errors import UsageError
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.drivers import preventing
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.preventable.data import PreventableData
from roadproof.extensions.pages.settings import Atlas
from roadproof.extensions.surveys import classifying, covering
from roadproof.extensions.surveys.classify.data import ClassesData
from roadproof.extensions.surveys.coverage.kept import CoverageData
from roadproof.extensions.surveys.redundancies import redundancy
from roadproof.extensions.surveys.redundancy import RedundancyData
from roadproof.frontends.api import drives, studies
from roadproof.frontends.api import proofs as proving
from roadproof.frontends.api.answer import Picture
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.settings.flags import flags_of
from roadproof.frontends.settings.groups import Readings
from roadproof.library.scenarios import numbers_of
from roadproof.library.specification import Library
from roadproof.questions.data import QUESTION
from roadproof.questions.order.data import OrderData
from roadproof.questions.overlap import OverlapData
from roadproof.questions.prove import ClaimsData

TOPICS: Final = ("proofs", "drives", "overlaps", "implications", "redundancy", "gaps", "classes", "plates")
"""What the atlas asks, in the words of ``--topics``."""
OBJECTIVES: Final = ("smooth", "mild", "severe")
EVIDENCE: Final = "evidence"


@dataclass(frozen=True)
class Source:
    """Where the evidence for a statement is, relative to the pages, and the command that makes it again."""

    command: str
    file: str = ""


@dataclass(frozen=True)
class ShownDrive:
    """A drive with its source."""

    file: DriveFile
    source: Source


@dataclass
class Answers:
    """What is known about the scenarios ``numbers``; None or empty where it was not asked.

    ``folder``: that of the pages. ``titles``: what the properties of the list say, by id and set (P1@base).
    ``drives``: by objective
    and number. ``diagram``: a picture of the implications. ``library``: that with the classes.
    """

    home: Definitions
    folder: Path
    numbers: tuple[int, ...]
    proofs: ClaimsData | None = None
    titles: Mapping[str, str] = field(default_factory=dict)
    drives: dict[str, dict[int, ShownDrive]] = field(default_factory=dict)
    overlap: OverlapData | None = None
    order: OrderData | None = None
    diagram: Picture | None = None
    redundancy: RedundancyData | None = None
    coverage: CoverageData | None = None
    classes: ClassesData | None = None
    library: Library | None = None
    plates: dict[str, PreventableData] = field(default_factory=dict)

    def source(self, command: str, arguments: str, place: str = "", file: object = None) -> Source:
        """The source of a statement; ``file``: its evidence in the folder ``place``, or else its question."""
        name = f"{EVIDENCE}/{place}/{file if isinstance(file, str) else QUESTION}" if place else ""
        words = ["roadproof", command, *arguments.split(), *_flags(self.home, command)]
        return Source(shlex.join(words), name)


def name_in(evidence: Sequence[object]) -> str | None:
    """Return the name of the first of some files of evidence; None where there is none."""
    return Path(str(evidence[0])).name if evidence else None


def _flags(home: Definitions, command: str) -> list[str]:
    """The flags for the definitions of ``home``; of a question about several sets without the set."""
    options = home.library.options
    readings = {k: v for k, v in home.specification.options.items() if v != options[k].values[0]}
    specs = [x.name for x in home.library.files if x.name]
    given = Readings(sets=home.sets, specs=specs, readings=readings or None)
    return flags_of(replace(given, sets=("base",)) if command in ("order", "preventable") else given)


def ask(home: Definitions, plain: bool, given: Atlas) -> Answers:
    """Ask all questions of the atlas, or those of ``given.topics``; evidence goes below ``given.out``.

    ``plain``: ``home`` has no other definitions than the library's. Raises ``InputError``, ``UsageError``.
    """
    for topic in given.topics:
        if topic not in TOPICS:
            raise UsageError(f"topics={topic}: write some of {', '.join(TOPICS)}")
    assert given.out is not None, "--out is required"
    numbers = home.among(given.among) or numbers_of(home.alone)
    answers = Answers(home, Path(given.out), numbers)
    asked = _Questions(answers, plain, given)
    for topic in TOPICS:
        if topic in (given.topics or TOPICS):
            getattr(asked, topic)()
    return answers


@dataclass(frozen=True)
class _Questions:
    """A function for each topic, which asks and fills in the answers."""

    answers: Answers
    plain: bool
    given: Atlas

    @property
    def among(self) -> str | None:
        """The scenarios that are asked about; None for all."""
        return None if self.given.among is None else ",".join(map(str, self.answers.numbers))

    @property
    def using(self) -> Definitions | None:
        """The definitions where they are not the usual ones of a question."""
        return None if self.plain else self.answers.home

    def _keywords(self, folder: str) -> dict[str, Any]:
        given = self.given
        run = {"jobs": given.jobs, "progress": given.progress, "say": None, "fresh": given.fresh}
        return {"out": self.answers.folder / EVIDENCE / folder, **run}

    def proofs(self) -> None:
        what = () if self.among is None else (self.among,)
        found = proving.prove(*what, using=self.using, **self._keywords("proofs"))
        self.answers.titles = {f"{x.task.id}@{x.task.set_name}": x.task.title for x in found.answers}
        self.answers.proofs = read(ClaimsData, found.as_data(), "proofs")

    def drives(self) -> None:
        for objective in OBJECTIVES:
            place = f"drives-{objective}"
            told: Any = {"objective": objective, "pictures": False, **self._keywords(place)}
            found = drives.witness(*self.answers.numbers, using=self.answers.home, **told)
            shown = self.answers.drives.setdefault(objective, {})
            for name, outcome in found.named.items():
                if outcome.drives and outcome.scenario is not None:
                    arguments = f"{outcome.scenario} --objective {objective}"
                    source = self.answers.source("witness", arguments, place, f"{name}.json")
                    shown[outcome.scenario] = ShownDrive(outcome.drives[0].file, source)

    def overlaps(self) -> None:
        if len(self.answers.numbers) > 1:
            found = studies.overlap(self.among, self.answers.home, **self._keywords("overlap"))
            self.answers.overlap = read(OverlapData, found.as_data(), "overlap")

    def implications(self) -> None:
        found = studies.order(self.among, self.using, **self._keywords("order"))
        self.answers.diagram = found.plot()
        self.answers.order = read(OrderData, found.as_data(), "order")

    def redundancy(self) -> None:
        found = redundancy(self.among, self.answers.home, **self._keywords("redundancy"))
        self.answers.redundancy = read(RedundancyData, found.as_data(), "redundancy")

    def gaps(self) -> None:
        found = covering.coverage(self.answers.home, **self._keywords("coverage"))
        self.answers.coverage = read(CoverageData, found.as_data(), "coverage")

    def classes(self) -> None:
        told: Any = {"shares": False, **self._keywords("classes")}
        found = classifying.classify(self.among, self.answers.home, **told)
        self.answers.library = found.library
        self.answers.classes = read(ClassesData, found.as_data(), "classes")

    def plates(self) -> None:
        for manoeuvre in MANOEUVRES:
            place = f"plates-{manoeuvre}"
            found = preventing.preventable(manoeuvre, **self._keywords(place))
            self.answers.plates[manoeuvre] = read(PreventableData, found.as_data(), place)
