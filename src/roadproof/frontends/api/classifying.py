"""Classes of scenarios that exclude each other, with a drive and shares for each."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.analysis.basis import ProofResult
from roadproof.analysis.classify.classes import plan_of
from roadproof.analysis.classify.divide import divide
from roadproof.analysis.classify.drives import Example
from roadproof.analysis.classify.shares import Shares, count_shares
from roadproof.analysis.classify.simulated import simulated_shares
from roadproof.analysis.classify.study import (
    Classification,
    ClassificationResult,
    classification_of,
    make_room,
)
from roadproof.analysis.classify.text import ClassClaim, claims_text
from roadproof.analysis.study.frame import StudyResult
from roadproof.evidence.answers import classify as kept
from roadproof.evidence.kinds import Evidence
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.restricting import restricted
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.api.studied import StudyAnswers, drawn
from roadproof.frontends.report import classify as report
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings import studies as settings
from roadproof.frontends.settings.keywords import ClassifyKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import numbers_of
from roadproof.library.words import Called, called
from roadproof.recordings.formats.sources import find_sources
from roadproof.runtime.files import make_folder, write_whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict, exit_code

CLAIMS_FILE = "claims.txt"


@dataclass(frozen=True, repr=False)
class Classifications(StudyAnswers[Classification, Example | ProofResult[ClassClaim], kept.Record]):
    """Classes with a drive for each, and proofs that they are a division; ``shares`` in recordings."""

    shares: Shares | None = None
    pieces: ClassVar[str] = "groups of drives and claims"

    @cached_property
    def classified(self) -> ClassificationResult:
        """All answers together, in the order of the classes and of the claims."""
        return self.study.classified(self.found.answers, self.shares)

    @property
    def text(self) -> str:
        """The classes as a specification file."""
        return self.study.text

    @property
    def verdicts(self) -> dict[str, Verdict]:
        found = self.classified
        verdicts: dict[str, Verdict] = {x.one.name: x.verdict for x in found.examples}
        verdicts |= {x.claim.name: x.verdict for x in found.decisions}
        return verdicts | {x.about: Verdict.UNKNOWN for x in found.doubts}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        drives = (x.drive for x in self.classified.examples)
        proofs = (x.certificate for x in self.classified.decisions)
        return tuple(x for x in (*drives, *proofs) if x is not None)

    @property
    def exit_code(self) -> ExitCode:
        """A class without a drive is in doubt, and so are all where a part of the division is."""
        found = self.classified
        verdicts = [Verdict.UNKNOWN for _ in found.doubts]
        verdicts += [Verdict.PROVED if x.verdict is Verdict.WITNESSED else x.verdict for x in found.examples]
        verdicts += [Verdict.PROVED if x.holds else x.verdict for x in found.decisions]
        code = exit_code((verdict, Verdict.PROVED) for verdict in verdicts)
        broken = self.shares is not None and self.shares.broken
        return max(code, ExitCode.CROSSCHECK_FAILED) if broken else code

    @property
    def _sheet(self) -> Sheet[kept.CountedClass]:
        """An entry for each class; situations where shares were counted."""
        return report.sheet_of(self._index(self.found.records).classes)

    @cached_property
    def words(self) -> Called:
        """What the scenarios are called."""
        return called(self.study.basis.specification)

    def _index(self, records: Mapping[str, kept.Record]) -> kept.Index:
        return self.study.index(self.classified, records, self.seconds)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Which scenarios make up which class, and how often it occurs."""
        title = f"Classes of scenarios of set {self.study.classes.plan.set_name}"
        drawn = report.draw_classes(self.classified.examples, self.shares, title, self.words)
        yield "classes", picture(drawn)

    def _write_index(
        self, folder: Path, found: StudyResult[Example | ProofResult[ClassClaim], kept.Record]
    ) -> None:
        write_whole(folder / CLAIMS_FILE, self.files(False)[CLAIMS_FILE])
        super()._write_index(folder, found)

    def files(self, pictures: bool) -> dict[str, bytes]:
        """The claims, for ``prove --claims``, and the picture."""
        claims = {CLAIMS_FILE: claims_text(self.study.claims).encode()}
        return claims | drawn(self.pictures() if pictures else {})

    def __str__(self) -> str:
        found = self.classified
        table = [report.as_table(found.examples, self.shares, self.words), ""] if found.examples else []
        return "\n".join([*table, *report.summary(found)])


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
    home = restricted(definitions_of(using), given, among)
    basis = basis_of(home, given, given.vehicles)
    plan = plan_of(home.alone, home.among(among) or numbers_of(home.alone))
    folder = None if given.out is None else Path(given.out)
    if folder is not None:
        make_folder(folder)
    sources = () if given.on is None else find_sources(Path(given.on), given.strict)
    division = divide(basis, plan, given.jobs, given.progress, fresh=given.fresh)
    study = classification_of(basis, division)
    if division.cut_off:
        folder = None  # what earlier runs have found stays
    if folder is not None:
        make_room(folder, study.question)
    counted = None
    if given.shares and not division.cut_off:
        if given.on is None:
            counted = simulated_shares(study.basis, study.classes, given.fresh)
        else:
            about, values = study.basis.specification, study.basis.all_values()
            recordings = (source.read() for source in sources)
            counted = count_shares(study.classes, about, values, recordings, source=str(given.on))
    more = {"shares": counted}
    return Classifications.asked(study, replace(given, out=folder), more=lambda: more, begun=begun)
