"""Classes of scenarios that exclude each other, with a drive and shares for each."""

import time
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.evidence.codec import write
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.surveys import settings
from roadproof.extensions.surveys.classify.classes import plan_of
from roadproof.extensions.surveys.classify.data import ClassData, ClassesData, counted
from roadproof.extensions.surveys.classify.division import divide
from roadproof.extensions.surveys.classify.question import ClassesView, ClassifyQuestion, question_of
from roadproof.extensions.surveys.classify.shares import SHARES, shares_table
from roadproof.extensions.surveys.classify.simulated import simulated_shares
from roadproof.extensions.surveys.classify.text import claims_text
from roadproof.extensions.surveys.classify.traffic_shares import Shares, count_shares
from roadproof.extensions.surveys.keywords import ClassifyKeywords
from roadproof.extensions.surveys.report import classify as report
from roadproof.extensions.traffic.formats.sources import find_sources
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.pictures import drawn
from roadproof.frontends.api.questioned import QuestionAnswers
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import numbers_of
from roadproof.library.words import Called, called
from roadproof.questions.views import placing
from roadproof.runtime.files import make_folder, write_whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict, exit_code

CLAIMS_FILE = "claims.txt"


@dataclass(frozen=True, repr=False)
class Classifications(QuestionAnswers[ClassesView]):
    """Classes with a drive for each, and proofs that they are a division; ``shares`` in recordings."""

    question: ClassifyQuestion
    shares: Shares | None = None
    pieces: ClassVar[str] = "groups of drives and claims"

    @property
    def text(self) -> str:
        """The classes as a specification file."""
        return self.question.text

    @property
    def verdicts(self) -> dict[str, Verdict]:
        found = self.view
        verdicts: dict[str, Verdict] = {x.one.name: x.verdict for x in found.examples}
        verdicts |= {x.claim.name: x.verdict for x in found.decisions}
        return verdicts | {x.about: Verdict.UNKNOWN for x in found.doubts}

    @property
    def exit_code(self) -> ExitCode:
        """A class without a drive is in doubt, and so are all where a part of the division is."""
        found = self.view
        verdicts = [Verdict.UNKNOWN for _ in found.doubts]
        verdicts += [Verdict.PROVED if x.verdict is Verdict.WITNESSED else x.verdict for x in found.examples]
        verdicts += [Verdict.PROVED if x.holds else x.verdict for x in found.decisions]
        code = exit_code((verdict, Verdict.PROVED) for verdict in verdicts)
        broken = self.shares is not None and self.shares.broken
        return max(code, ExitCode.CROSSCHECK_FAILED) if broken else code

    def _data(self) -> ClassesData:
        data = self.question.data(self.view, placing(self.folder), self.seconds)
        found = self.shares
        return data if found is None else counted(data, found.told, found.situations, found.traces)

    def as_data(self) -> JsonObject:
        return write(self._data())

    @property
    def _sheet(self) -> Sheet[ClassData]:
        """An entry for each class; situations where shares were counted."""
        return report.sheet_of(self._data().classes)

    @cached_property
    def words(self) -> Called:
        """What the scenarios are called."""
        return called(self.question.basis.specification)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Which scenarios make up which class, and how often it occurs."""
        title = f"Classes of scenarios of set {self.question.classes.plan.set_name}"
        drawn = report.draw_classes(self.view.examples, self.shares, title, self.words)
        yield "classes", picture(drawn)

    def files(self, pictures: bool) -> dict[str, bytes]:
        """The claims, for ``prove --claims``, what was counted, and the picture."""
        return self.texts() | drawn(self.pictures() if pictures else {})

    def texts(self) -> dict[str, bytes]:
        """Return the claims, for ``prove --claims``, and what was counted."""
        made = {CLAIMS_FILE: claims_text(tuple(self.question.claims.values())).encode()}
        if self.shares is not None:
            found = self.shares
            made[SHARES] = shares_table(found.told, found.situations, found.traces).encode()
        return made

    def __str__(self) -> str:
        found = self.view
        table = [report.as_table(found.examples, self.shares, self.words), ""] if found.examples else []
        return "\n".join([*table, *report.summary(found, self.shares)])


@takes(settings.Classify)
def classify(
    among: Among = None, using: Definitions | None = None, **options: Unpack[ClassifyKeywords]
) -> Classifications:
    """Divide scenarios into classes that exclude each other, and show a drive for each.

    ``among``: whole rows of the table, such as "1-8" (all where None). ``shares``: whether it is counted how
    often each class occurs, in the recordings of ``on`` or else in simulated traffic; ``strict``: in none
    without bad vehicles. ``preventable``,
    ``unpreventable``: as for ``witness``. ``out``: a folder in
    which answers are kept as they come. Raises ``InputError``, ``UsageError``.
    """
    begun = time.monotonic()
    given = settings.Classify.of(options)
    home = given.modified(definitions_of(using), among)
    basis = basis_of(home, given, given.vehicles)
    plan = plan_of(home.alone, home.among(among) or numbers_of(home.alone))
    folder = None if given.out is None else Path(given.out)
    if folder is not None:
        make_folder(folder)
    sources = () if given.on is None else find_sources(Path(given.on), given.strict)
    division = divide(basis, plan, given.jobs, given.progress, fresh=given.fresh)
    question = question_of(basis, division)
    if division.cut_off:
        folder = None  # what earlier runs have found stays
    counts = None
    if given.shares and not division.cut_off:
        if given.on is None:
            counts = simulated_shares(question.basis, question.classes, given.fresh)
        else:
            about, values = question.basis.specification, question.basis.all_values()
            recordings = (source.read() for source in sources)
            counts = count_shares(question.classes, about, values, recordings, source=str(given.on))
    found = Classifications.settled(question, replace(given, out=folder))
    found = replace(found, shares=counts, seconds=time.monotonic() - begun)
    if folder is not None:
        for name, content in found.texts().items():
            write_whole(folder / name, content)
    return found
