"""``roadproof.classify``: mutually exclusive classes of scenarios, with a drive and shares for each."""

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
from roadproof.extensions.surveys.classify.data import ClassData, ClassesData, add_counts
from roadproof.extensions.surveys.classify.division import divide
from roadproof.extensions.surveys.classify.question import ClassesView, ClassifyQuestion, question_of
from roadproof.extensions.surveys.classify.shares import SHARES, shares_table
from roadproof.extensions.surveys.classify.simulated import simulated_shares
from roadproof.extensions.surveys.classify.text import claims_text
from roadproof.extensions.surveys.classify.traffic_shares import Shares, count_shares
from roadproof.extensions.surveys.keywords import ClassifyKeywords
from roadproof.extensions.surveys.report import classify as report
from roadproof.extensions.traffic.formats.sources import find_sources
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.picture import Picture, drawn, picture
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import numbers_of
from roadproof.library.words import ScenarioWords, words_by_number
from roadproof.questions.views import placing
from roadproof.runtime.files import make_folder, write_atomic
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict, exit_code

CLAIMS_FILE = "claims.txt"


@dataclass(frozen=True, repr=False)
class Classifications(QuestionAnswers[ClassesView]):
    """Classes with drives, proofs that they are a partition, and their ``shares`` in recordings."""

    question: ClassifyQuestion
    shares: Shares | None = None
    pieces: ClassVar[str] = "groups of drives and claims"

    @property
    def text(self) -> str:
        """The classes as a specification file."""
        return self.question.text

    @property
    def verdicts(self) -> dict[str, Verdict]:
        view = self.view
        verdicts: dict[str, Verdict] = {x.one.name: x.verdict for x in view.examples}
        verdicts |= {x.claim.name: x.verdict for x in view.decisions}
        return verdicts | {x.about: Verdict.UNKNOWN for x in view.doubts}

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: UNKNOWN if a class has no drive, or if a part of the division is undecided."""
        view = self.view
        verdicts = [Verdict.UNKNOWN for _ in view.doubts]
        verdicts += [Verdict.PROVED if x.verdict is Verdict.WITNESSED else x.verdict for x in view.examples]
        verdicts += [Verdict.PROVED if x.holds else x.verdict for x in view.decisions]
        code = exit_code((verdict, Verdict.PROVED) for verdict in verdicts)
        broken = self.shares is not None and self.shares.broken
        return max(code, ExitCode.CROSSCHECK_FAILED) if broken else code

    def _data(self) -> ClassesData:
        data = self.question.data(self.view, placing(self.folder), self.seconds)
        shares = self.shares
        return data if shares is None else add_counts(data, shares.data, shares.situations, shares.traces)

    def as_data(self) -> JsonObject:
        return write(self._data())

    @property
    def _sheet(self) -> Sheet[ClassData]:
        """An entry for each class; situations where shares were counted."""
        return report.sheet_of(self._data().classes)

    @cached_property
    def words(self) -> ScenarioWords:
        """The titles of the scenarios."""
        return words_by_number(self.question.basis.specification)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield the picture of the scenarios in each class, with its frequency."""
        title = f"Classes of scenarios of set {self.question.classes.plan.set_name}"
        drawn = report.draw_classes(self.view.examples, self.shares, title, self.words)
        yield "classes", picture(drawn)

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return the files: claims for ``prove --claims``, counts, and the picture."""
        return self.texts() | drawn(self.pictures() if pictures else {})

    def texts(self) -> dict[str, bytes]:
        """Return the text files: claims for ``prove --claims``, and counts."""
        made = {CLAIMS_FILE: claims_text(tuple(self.question.claims.values())).encode()}
        if self.shares is not None:
            shares = self.shares
            made[SHARES] = shares_table(shares.data, shares.situations, shares.traces).encode()
        return made

    def __str__(self) -> str:
        view = self.view
        table = [report.as_table(view.examples, self.shares, self.words), ""] if view.examples else []
        return "\n".join([*table, *report.summary(view, self.shares)])


@takes(settings.Classify)
def classify(
    among: Among = None, using: Definitions | None = None, **options: Unpack[ClassifyKeywords]
) -> Classifications:
    """Divide scenarios into mutually exclusive classes, and find a drive for each.

    ``among``: whole rows of the table, such as "1-8" (all if None). ``shares``: whether to count each class,
    in the recordings of ``on`` or else in simulated traffic; ``strict``: refuse recordings with unreliable
    vehicles. ``preventable``, ``unpreventable``: as for ``witness``. ``out``: a folder for answers, which are
    written as they come. Raises ``InputError``, ``UsageError``.
    """
    started = time.monotonic()
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
    result = Classifications.decide(question, replace(given, out=folder))
    result = replace(result, shares=counts, seconds=time.monotonic() - started)
    if folder is not None:
        for name, content in result.texts().items():
            write_atomic(folder / name, content)
    return result
