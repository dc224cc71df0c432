"""Runs the questions of the atlas; their answers are stored in folders of evidence below the pages."""

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
from roadproof.extensions.pages.command_lines import flags_of
from roadproof.extensions.pages.settings import AtlasSettings
from roadproof.extensions.surveys import classifying, covering
from roadproof.extensions.surveys.classify.data import ClassesData
from roadproof.extensions.surveys.coverage.schema import CoverageData
from roadproof.extensions.surveys.redundancies import redundancy
from roadproof.extensions.surveys.redundancy import RedundancyData
from roadproof.frontends.api import drives, ordering, relations
from roadproof.frontends.api import proofs as proving
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.report.picture import Picture
from roadproof.frontends.settings.groups import Readings
from roadproof.library.scenarios import numbers_of
from roadproof.library.specification import Library
from roadproof.questions.order.data import OrderData
from roadproof.questions.overlap_data import OverlapData
from roadproof.questions.prove_data import ClaimsData
from roadproof.questions.question import QUESTION

TOPICS: Final = ("proofs", "drives", "overlaps", "implications", "redundancy", "gaps", "classes", "plates")
"""The topics of the atlas, as ``--topics`` names them."""
OBJECTIVES: Final = ("typical", "mild", "severe")
EVIDENCE: Final = "evidence"


@dataclass(frozen=True)
class EvidenceSource:
    """The evidence file for a statement, relative to the pages, and the command that reproduces it."""

    command: str
    file: str = ""


@dataclass(frozen=True)
class SourcedDrive:
    """A drive with its source."""

    file: DriveFile
    source: EvidenceSource


@dataclass
class Answers:
    """The answers about the scenarios ``numbers`` that pages show; None or empty where a question was not
    asked.

    ``folder``: that of the pages. ``titles``: statements of the listed properties, by id and set (P1@base).
    ``drives``: by objective and scenario number. ``diagram``: a picture of the implications. ``library``: the
    library with the classes.
    """

    home: Definitions
    folder: Path
    numbers: tuple[int, ...]
    proofs: ClaimsData | None = None
    titles: Mapping[str, str] = field(default_factory=dict)
    drives: dict[str, dict[int, SourcedDrive]] = field(default_factory=dict)
    overlap: OverlapData | None = None
    order: OrderData | None = None
    diagram: Picture | None = None
    redundancy: RedundancyData | None = None
    coverage: CoverageData | None = None
    classes: ClassesData | None = None
    library: Library | None = None
    plates: dict[str, PreventableData] = field(default_factory=dict)

    def source(self, command: str, arguments: str, place: str = "", file: object = None) -> EvidenceSource:
        """Return the source of a statement; ``file``: its evidence in the folder ``place``, by default the
        question there.
        """
        name = f"{EVIDENCE}/{place}/{file if isinstance(file, str) else QUESTION}" if place else ""
        words = ["roadproof", command, *arguments.split(), *_flags(self.home, command)]
        return EvidenceSource(shlex.join(words), name)


def name_in(evidence: Sequence[object]) -> str | None:
    """Return the file name of the first of some files of evidence; None for none."""
    return Path(str(evidence[0])).name if evidence else None


def _flags(home: Definitions, command: str) -> list[str]:
    """Return the flags for the definitions of ``home``; without the set for questions about several sets."""
    options = home.library.options
    readings = {k: v for k, v in home.specification.options.items() if v != options[k].values[0]}
    specs = [x.name for x in home.library.files if x.name]
    definitions = Readings(sets=home.sets, specs=specs, readings=readings or None)
    return flags_of(
        replace(definitions, sets=("base",)) if command in ("order", "preventable") else definitions
    )


def answer_topics(home: Definitions, plain: bool, settings: AtlasSettings) -> Answers:
    """Ask all questions of the atlas, or those of ``settings.topics``; evidence goes below ``settings.out``.

    ``plain``: ``home`` has no definitions but the library's. Raises ``InputError``, ``UsageError``.
    """
    for topic in settings.topics:
        if topic not in TOPICS:
            raise UsageError(f"topics={topic}: write some of {', '.join(TOPICS)}")
    assert settings.out is not None, "--out is required"
    numbers = home.among(settings.among) or numbers_of(home.alone)
    answers = Answers(home, Path(settings.out), numbers)
    questions = _Questions(answers, plain, settings)
    for topic in TOPICS:
        if topic in (settings.topics or TOPICS):
            getattr(questions, topic)()
    return answers


@dataclass(frozen=True)
class _Questions:
    """A method for each topic, which asks its questions and stores the answers."""

    answers: Answers
    plain: bool
    settings: AtlasSettings

    @property
    def among(self) -> str | None:
        """The scenarios that are asked about; None for all."""
        return None if self.settings.among is None else ",".join(map(str, self.answers.numbers))

    @property
    def using(self) -> Definitions | None:
        """The definitions, None for the default ones of a question."""
        return None if self.plain else self.answers.home

    def _keywords(self, folder: str) -> dict[str, Any]:
        settings = self.settings
        run = {"jobs": settings.jobs, "progress": settings.progress, "say": None, "fresh": settings.fresh}
        return {"out": self.answers.folder / EVIDENCE / folder, **run}

    def proofs(self) -> None:
        claims = () if self.among is None else (self.among,)
        result = proving.prove(*claims, using=self.using, **self._keywords("proofs"))
        self.answers.titles = {f"{x.task.id}@{x.task.set_name}": x.task.title for x in result.answers}
        self.answers.proofs = read(ClaimsData, result.as_data(), "proofs")

    def drives(self) -> None:
        for objective in OBJECTIVES:
            place = f"drives-{objective}"
            options: Any = {"objective": objective, "pictures": False, **self._keywords(place)}
            result = drives.witness(*self.answers.numbers, using=self.answers.home, **options)
            shown = self.answers.drives.setdefault(objective, {})
            for name, outcome in result.named.items():
                if outcome.drives and outcome.scenario is not None:
                    arguments = f"{outcome.scenario} --objective {objective}"
                    source = self.answers.source("witness", arguments, place, f"{name}.json")
                    shown[outcome.scenario] = SourcedDrive(outcome.drives[0].file, source)

    def overlaps(self) -> None:
        if len(self.answers.numbers) > 1:
            result = relations.overlap(self.among, self.answers.home, **self._keywords("overlap"))
            self.answers.overlap = read(OverlapData, result.as_data(), "overlap")

    def implications(self) -> None:
        result = ordering.order(self.among, self.using, **self._keywords("order"))
        self.answers.diagram = result.plot()
        self.answers.order = read(OrderData, result.as_data(), "order")

    def redundancy(self) -> None:
        result = redundancy(self.among, self.answers.home, **self._keywords("redundancy"))
        self.answers.redundancy = read(RedundancyData, result.as_data(), "redundancy")

    def gaps(self) -> None:
        result = covering.coverage(self.answers.home, **self._keywords("coverage"))
        self.answers.coverage = read(CoverageData, result.as_data(), "coverage")

    def classes(self) -> None:
        options: Any = {"shares": False, **self._keywords("classes")}
        result = classifying.classify(self.among, self.answers.home, **options)
        self.answers.library = result.library
        self.answers.classes = read(ClassesData, result.as_data(), "classes")

    def plates(self) -> None:
        for manoeuvre in MANOEUVRES:
            place = f"plates-{manoeuvre}"
            result = preventing.preventable(manoeuvre, **self._keywords(place))
            self.answers.plates[manoeuvre] = read(PreventableData, result.as_data(), place)
