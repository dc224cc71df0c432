"""Joins findings of ``roadproof check`` with the formula, definitions and values that each is about."""

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from roadproof.errors import RoadproofError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.files import read_evidence
from roadproof.evidence.finding import Finding
from roadproof.evidence.specifications import load_specs_beside
from roadproof.evidence.strict import LARGEST_INDEX, Fields, JsonObject, read_json
from roadproof.extensions.assurance.answers.trace import LinkedEvidence
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.extensions.catalogue.catalogue_data import SCHEMA as CATALOGUE
from roadproof.extensions.drivers.models import specifications
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.motion import split_claim
from roadproof.library.specification import Library, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.questions.checking import is_question
from roadproof.questions.question import QUESTION
from roadproof.runtime.files import read_limited


@dataclass(frozen=True)
class Meaning:
    """The meaning of a claim: its formula with all definitions expanded, and its assumptions as text."""

    formula: Formula
    assuming: tuple[str, ...] = ()

    @property
    def opposite(self) -> "Meaning":
        """The negation, for a claim without assumptions."""
        return Meaning(f.negation(self.formula), self.assuming)


@dataclass(frozen=True)
class CheckedEvidence:
    """A finding, and the formula that it is about.

    ``meaning``: None where the claim cannot be read. ``values``: parameter values that the evidence names.
    ``digest``: the SHA-256 of its file, empty without one. ``vehicles``: the vehicles of a drive. ``remark``:
    an objection of the catalogue to a test.
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
        """Return whether the evidence is a drive or a test, in which each parameter has one value."""
        return self.finding.kind in ("drive", "test")

    @property
    def as_linked(self) -> LinkedEvidence:
        """The finding as answers state it."""
        finding = self.finding
        return LinkedEvidence(
            where=finding.where,
            label=finding.label,
            verdict=finding.verdict,
            claim=" ".join(finding.claim.split()),
            outcome=finding.outcome,
            reason=finding.reason,
        )


def meaning_of(specification: Specification, claim: str, source: str = "claim") -> Meaning:
    """Return the meaning of a claim under the definitions of a specification. Raises ``InputError``."""
    assuming, rest = split_claim(claim, source)
    return Meaning(without_names(read_claim(specification, rest, source).formula), assuming)


def read_findings(
    findings: Iterable[Finding], specs: Sequence[Path], home: Specification
) -> list[CheckedEvidence]:
    """Return each finding with the formula, definitions and values that it is about.

    ``specs``: files that all evidence was made with; ``home``: the set and options for evidence that names
    none.
    """
    reader = _Reader(tuple(specs), home)
    return [reader.read(x) for x in findings]


class _Reader:
    """Reads files of evidence and indices; reads the definitions of each folder once."""

    def __init__(self, specs: tuple[Path, ...], home: Specification) -> None:
        self.specs = specs
        self.home = home
        self.libraries: dict[Path | None, Library] = {None: load_library(specs)}
        self.remarks: dict[Path, dict[str, str]] = {}
        self.values: dict[Path, Mapping[str, Fraction]] = {}
        self.answers: dict[Path, Fields | None] = {}

    def read(self, finding: Finding) -> CheckedEvidence:
        """Return a finding with its meaning, values and digest."""
        path = Path(finding.where)
        library = self._library(path)
        remark = self._remark(finding)
        if not path.is_file() or path.name == QUESTION or finding.kind == "test":
            specification = self._in_set_of(finding, library)
            meaning, values = _meaning_or_none(specification, finding.claim), self._values(finding)
            return CheckedEvidence(finding, specification, meaning, values, remark=remark)
        digest = hashlib.sha256(read_limited(path, LARGEST_INDEX, "no evidence is larger")).hexdigest()
        try:
            evidence = read_evidence(path)
            specification = library.select(evidence.set_name, evidence.options)
        except RoadproofError:
            specification = self._in_set_of(finding, library)
            meaning = _meaning_or_none(specification, finding.claim)
            return CheckedEvidence(finding, specification, meaning, digest=digest)
        drive = None if isinstance(evidence, Certificate) else evidence
        return CheckedEvidence(
            finding,
            specification,
            _meaning_or_none(specification, finding.claim),
            {} if drive is None else drive.values,
            digest,
            () if drive is None else tuple(drive.drive.vehicles),
        )

    def _library(self, path: Path) -> Library:
        """Return the definitions for a file: those of the nearest folder of an answer above it."""
        folder = next((x for x in path.parents if is_question(x)), None)
        if folder not in self.libraries:
            assert folder is not None
            try:
                self.libraries[folder] = load_specs_beside(_basis_of(folder), folder, self.specs)[0]
            except RoadproofError:
                self.libraries[folder] = self.libraries[None]
        return self.libraries[folder]

    def _in_set_of(self, finding: Finding, library: Library) -> Specification:
        """Return the definitions of the set that a finding names, or else of the trace's set."""
        options = {name: x for name, x in self.home.options.items() if name in library.options}
        return library.select(finding.set if finding.set in library.sets else self.home.set_name, options)

    def _values(self, finding: Finding) -> Mapping[str, Fraction]:
        """Return the parameter values that a test was judged with, including those of driver models it was
        tried with.
        """
        if finding.kind != "test":
            return {}
        folder = Path(finding.where).parent
        if folder not in self.values:
            self.values[folder] = _parameters(self._answer_in(folder))
        models = default_values(load_library(map(Path, specifications()))) if finding.drivers else {}
        return {**models, **self.values[folder]}

    def _answer_in(self, folder: Path) -> Fields | None:
        """Return the combined answers of a folder, None where they cannot be read."""
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


def _meaning_or_none(specification: Specification, claim: str) -> Meaning | None:
    """Return the meaning of a claim; None for one that is empty or cannot be read, as in damaged evidence."""
    try:
        return meaning_of(specification, claim) if claim else None
    except RoadproofError:
        return None


def _basis_of(folder: Path) -> Fields:
    """Return the basis of a folder's question: definitions and settings. Raises ``InputError``."""
    head = Fields(read_json(folder / QUESTION, LARGEST_INDEX), str(folder / QUESTION))
    return Fields(head.mapping("basis"), head.where)


def _parameters(answer: Fields | None) -> Mapping[str, Fraction]:
    """Return the parameter values that an answer names; none where it cannot be read."""
    try:
        parameters = None if answer is None else Fields(answer.mapping("parameters"), answer.where)
        return {} if parameters is None else {name: parameters.rational(name) for name in parameters.content}
    except RoadproofError:
        return {}


def _remarks(answer: Fields | None) -> Iterator[tuple[str, str]]:
    """Yield (test, objection) for each test that is mislabelled or contradicts a proof, according to a
    catalogue.
    """
    if answer is None or answer.get("schema") != CATALOGUE:
        return
    for field_name in ("faults", "contradictions"):
        for item in answer.items(field_name):
            remark: JsonObject = item if isinstance(item, dict) else {}
            tests = remark.get("tests")
            for test in tests if isinstance(tests, list) else ():
                yield str(test), str(remark.get("told", ""))
