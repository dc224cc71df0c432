"""Findings of ``roadproof check`` with the formula, definitions and values that each of them is about."""

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from roadproof.errors import RoadproofError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.files import read_evidence
from roadproof.evidence.finding import Finding
from roadproof.evidence.specifications import read_beside
from roadproof.evidence.strict import LARGEST_INDEX, Fields, JsonObject, read_json
from roadproof.extensions.assurance.answers.trace import LinkedEvidence
from roadproof.extensions.catalogue.kept import SCHEMA as CATALOGUE
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.motion import split
from roadproof.library.specification import Library, Specification, on_request
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.questions.checking import is_question
from roadproof.questions.data import QUESTION
from roadproof.questions.views import folder_data
from roadproof.runtime.files import read_limited


@dataclass(frozen=True)
class Meaning:
    """What a claim says: a formula without names of definitions, under assumptions as text."""

    formula: Formula
    assuming: tuple[str, ...] = ()

    @property
    def opposite(self) -> "Meaning":
        """Of a claim without assumptions: that it is false."""
        return Meaning(f.negation(self.formula), self.assuming)


@dataclass(frozen=True)
class CheckedEvidence:
    """A finding, and what it is about.

    ``meaning`` None: its claim cannot be read. ``values``: of parameters, as the evidence itself names them.
    ``digest``: SHA-256 of its file, empty where there is none. ``vehicles``: those of a drive. ``remark``:
    what the catalogue says against a test.
    """

    finding: Finding
    specification: Specification
    meaning: Meaning | None = None
    values: Mapping[str, Fraction] = field(default_factory=dict)
    digest: str = ""
    vehicles: tuple[str, ...] = ()
    remark: str = ""

    @property
    def path(self) -> Path:
        """The file of the evidence."""
        return Path(self.finding.where)

    @property
    def is_drive(self) -> bool:
        """Whether a drive shows it, which has one value for each parameter."""
        return self.finding.kind in ("drive", "test")

    @property
    def kept(self) -> LinkedEvidence:
        """As answers have it."""
        x = self.finding
        return LinkedEvidence(
            where=x.where,
            label=x.label,
            verdict=x.verdict,
            claim=" ".join(x.claim.split()),
            outcome=x.outcome,
            reason=x.reason,
        )


def meaning_of(specification: Specification, claim: str, source: str = "claim") -> Meaning:
    """What a claim means in a specification. Raises ``InputError``."""
    assuming, rest = split(claim, source)
    return Meaning(without_names(read_claim(specification, rest, source).formula), assuming)


def read_findings(
    findings: Iterable[Finding], specs: Sequence[Path], home: Specification
) -> list[CheckedEvidence]:
    """What each finding is about. ``specs``: files that all evidence was made with; ``home``: the set and the
    readings of evidence that does not name its own."""
    reader = _Reader(tuple(specs), home)
    return [reader.read(x) for x in findings]


class _Reader:
    """Reads files of evidence and indices, each folder's definitions once."""

    def __init__(self, specs: tuple[Path, ...], home: Specification) -> None:
        self.specs = specs
        self.home = home
        self.libraries: dict[Path | None, Library] = {None: load_library(specs)}
        self.remarks: dict[Path, dict[str, str]] = {}
        self.values: dict[Path, Mapping[str, Fraction]] = {}
        self.answers: dict[Path, Fields | None] = {}

    def read(self, finding: Finding) -> CheckedEvidence:
        path = Path(finding.where)
        library = self._library(path)
        remark = self._remark(finding)
        if not path.is_file() or path.name == QUESTION or finding.kind == "test":
            specification = self._in_set_of(finding, library)
            meaning, values = _meaning(specification, finding.claim), self._values(finding)
            return CheckedEvidence(finding, specification, meaning, values, remark=remark)
        digest = hashlib.sha256(read_limited(path, LARGEST_INDEX, "no evidence is larger")).hexdigest()
        try:
            said = read_evidence(path)
            specification = library.select(said.set_name, said.options)
        except RoadproofError:
            specification = self._in_set_of(finding, library)
            meaning = _meaning(specification, finding.claim)
            return CheckedEvidence(finding, specification, meaning, digest=digest)
        drive = None if isinstance(said, Certificate) else said
        return CheckedEvidence(
            finding,
            specification,
            _meaning(specification, finding.claim),
            {} if drive is None else drive.values,
            digest,
            () if drive is None else tuple(drive.drive.vehicles),
        )

    def _library(self, path: Path) -> Library:
        """The definitions of the nearest folder of an answer above a file."""
        folder = next((x for x in path.parents if is_question(x)), None)
        if folder not in self.libraries:
            assert folder is not None
            try:
                self.libraries[folder] = read_beside(_said(folder), folder, self.specs)[0]
            except RoadproofError:
                self.libraries[folder] = self.libraries[None]
        return self.libraries[folder]

    def _in_set_of(self, finding: Finding, library: Library) -> Specification:
        """The definitions of the set that a finding names; those of the trace where it names none."""
        options = {name: x for name, x in self.home.options.items() if name in library.options}
        return library.select(finding.set if finding.set in library.sets else self.home.set_name, options)

    def _values(self, finding: Finding) -> Mapping[str, Fraction]:
        """The values that a test was judged with, and those of driver models that were put into it."""
        if finding.kind != "test":
            return {}
        folder = Path(finding.where).parent
        if folder not in self.values:
            self.values[folder] = _parameters(self._answer_in(folder))
        models = default_values(load_library([on_request()["driver"]])) if finding.drivers else {}
        return {**models, **self.values[folder]}

    def _answer_in(self, folder: Path) -> Fields | None:
        """What the answers of a folder show together; None where that cannot be read."""
        if folder not in self.answers:
            try:
                self.answers[folder] = Fields(folder_data(folder, self.specs), str(folder))
            except RoadproofError:
                self.answers[folder] = None
        return self.answers[folder]

    def _remark(self, finding: Finding) -> str:
        if finding.kind != "test":
            return ""
        folder = Path(finding.where).parent
        if folder not in self.remarks:
            self.remarks[folder] = dict(_remarks(self._answer_in(folder)))
        return self.remarks[folder].get(finding.name, "")


def _meaning(specification: Specification, claim: str) -> Meaning | None:
    """None where a claim cannot be read, as of damaged evidence, or is none, as of a test."""
    try:
        return meaning_of(specification, claim) if claim else None
    except RoadproofError:
        return None


def _said(folder: Path) -> Fields:
    """What the question of a folder rests on. Raises ``InputError``."""
    head = Fields(read_json(folder / QUESTION, LARGEST_INDEX), str(folder / QUESTION))
    return Fields(head.mapping("basis"), head.where)


def _parameters(said: Fields | None) -> Mapping[str, Fraction]:
    """The values of parameters that an answer names; none where it cannot be read."""
    try:
        found = None if said is None else Fields(said.mapping("parameters"), said.where)
        return {} if found is None else {name: found.rational(name) for name in found.content}
    except RoadproofError:
        return {}


def _remarks(said: Fields | None) -> Iterator[tuple[str, str]]:
    """What a catalogue says against its tests: that one is not what it claims, or contradicts a proof."""
    if said is None or said.get("schema") != CATALOGUE:
        return
    for field_name in ("faults", "contradictions"):
        for item in said.items(field_name):
            remark: JsonObject = item if isinstance(item, dict) else {}
            tests = remark.get("tests")
            for test in tests if isinstance(tests, list) else ():
                yield str(test), str(remark.get("told", ""))
