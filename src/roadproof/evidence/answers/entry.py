"""One line of an index or a journal: what it says, and of which evidence it says so.

An index is a part of the evidence. Each entry is compared with the file that it names: claim, verdict, set,
options, values of parameters. What an entry says beside its claim (numbers of scenarios, names of properties)
is compared with the claim, on trees; ``fault`` says where that fails.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence import certificate
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.drive_file import SCHEMAS_READ, DriveFile, read_drive
from roadproof.evidence.strict import Fields, rational, read_json, text
from roadproof.evidence.subject import Subject
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import under_limits
from roadproof.library.scenarios import Scenario, applied, name_of
from roadproof.library.specification import Library, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass

# What the evidence of an entry is to show of its claim: a proof of it, a proof that it never holds, a drive
# on which it holds, a drive (or a trace) on which it does not; nothing, where the verdict promises nothing.
Shows: TypeAlias = Literal["proof", "impossibility", "drive", "counterexample", "nothing"]

PROOFS = ("PROVED", "VACUOUS")
DOUBTS = ("UNKNOWN", "NONE-WITHIN", "PROVED-BOUNDED", "CROSSCHECK-FAILED")


@dataclass(frozen=True)
class Common:
    """What an index says once for all its entries; ``values`` None where it does not say them."""

    where: str
    library: Library
    set_name: str
    options: Mapping[str, str]
    values: Mapping[str, Fraction] | None

    @cached_property
    def specification(self) -> Specification:
        return self.library.select(self.set_name, self.options)

    def formula(self, claim: str) -> Formula:
        """What a claim means here. Raises ``InputError``."""
        return read_claim(self.specification, claim).formula


@dataclass(frozen=True)
class Entry:
    """``key`` is what only one entry of an index may have; ``file`` is a name inside the index's folder.

    ``claim`` None: what the file says, where ``fault_of`` finds no fault in it. ``trace`` is a counterexample
    inside the index. ``fault_of_drive``: what else a drive has to be, beside what its formula
    says, finds its fault or nothing. ``assuming``: what the claim is said under. ``expected`` returns the
    formulas of which the evidence has to show one, made of what the entry is about, on trees; None where
    ``fault_of`` decides by itself.
    """

    common: Common
    where: str
    key: tuple[object, ...]
    verdict: str
    label: str
    shows: Shows
    claim: str | None
    file: str | None = None
    trace: object = None
    values: Mapping[str, Fraction] | None = None
    unchecked: tuple[str, ...] = ()
    fault: str = ""
    fault_of: Callable[[str], str] | None = None
    fault_of_drive: Callable[[DriveFile], str] | None = None
    assuming: tuple[str, ...] = ()
    subject: Subject = Subject()
    expected: Callable[[], Sequence[Formula] | None] = field(kw_only=True)


def common_of(data: Fields, library: Library, set_name: str, where: str = "") -> Common:
    """The common part of an index or of a journal's first line. Raises ``InputError``."""
    options = data.named_texts("options") if "options" in data.content else {}
    values = None
    if "parameters" in data.content:
        given = data.mapping("parameters")
        place = f"{data.where}, parameters"
        values = values_with(library, {n: rational(v, f"{place}.{n}") for n, v in given.items()})
    options = dict(library.select(set_name, options).options)
    return Common(where or data.where, library, set_name, options, values)


def fault_of_number(common: Common, where: str, number: int | None, formula: str) -> str:
    """Why a formula is not the scenario of a number, or nothing; None is the number of none."""
    if number is None:
        return ""
    known = name_of(number) in common.specification.definitions
    told = Scenario(number, common.set_name)
    if known and applied(common.specification, told).formula == common.formula(formula):
        return ""
    return f"{where} is called scenario {number}, but its formula is another: {formula[:120]}"


def evidence_name(where: str, field: str, value: object) -> str | None:
    """The file that a field names, inside the folder of the index. Raises ``InputError``."""
    if value is None:
        return None
    name = text(value, f"{where}, {field}")
    if "\\" in name or any(part in ("", ".", "..") for part in name.split("/")):
        raise InputError(f"{where}: {field}='{name[:80]}' is no file in the folder of the index")
    return name


def file_of(where: str, shows: Shows, proof: object, drive: object) -> str | None:
    """The file of an answer that may name a proof or a drive. Raises ``InputError`` for both."""
    of_drive = shows in ("drive", "counterexample")
    if (proof if of_drive else drive) is not None:
        field, other = ("drive", "certificate") if of_drive else ("certificate", "drive")
        raise InputError(f"{where}: a {other} is named, where there may be a {field} only")
    return evidence_name(where, "drive", drive) if of_drive else evidence_name(where, "certificate", proof)


def read_evidence(path: Path) -> Certificate | DriveFile:
    """A certificate or a drive file. Raises ``InputError``."""
    content = read_json(path)
    if Fields(content, str(path)).text("schema") in SCHEMAS_READ:
        return read_drive(content, str(path))
    return certificate.read_certificate_data(content, str(path))


def mismatch(entry: Entry, said: Certificate | DriveFile) -> str:
    """Where an entry says otherwise than the file that it names, or nothing."""
    proved = isinstance(said, Certificate)
    if proved != (entry.shows in ("proof", "impossibility")):
        return f"{entry.where} says {entry.verdict}, but its file is a {'certificate' if proved else 'drive'}"
    common = entry.common
    if said.set_name != common.set_name:
        return f"{entry.where} is about set {common.set_name}, but its file about set {said.set_name}"
    try:
        options = common.library.select(said.set_name, said.options).options
        if options != common.options:
            name = next(n for n in options if options[n] != common.options[n])
            return f"{entry.where} has {name}={common.options[name]}, but its file {name}={options[name]}"
        if isinstance(said, DriveFile):
            difference = _other_values(entry, said)
            if not difference and entry.fault_of_drive is not None and (found := entry.fault_of_drive(said)):
                difference = f"{entry.where}: {found}"
            if difference:
                return difference
        elif said.assumed.said != entry.assuming:
            there, here = (", ".join(x) or "nothing" for x in (said.assumed.said, entry.assuming))
            return f"{entry.where} assumes {here}, but its file {there}"
        return _other_claim(entry, said) or _unexpected(entry, said)
    except RoadproofError as error:
        return f"{entry.where}: {error}"


def _other_values(entry: Entry, said: DriveFile) -> str:
    """The first parameter that the drive was judged with at another value than the entry says."""
    wanted = entry.values if entry.values is not None else entry.common.values
    if wanted is None:
        return ""
    known = values_with(entry.common.library, said.values)
    for name, value in values_with(entry.common.library, wanted).items():
        if known[name] != value:
            return f"{entry.where} has {name}={value}, but its file {name}={known[name]}"
    return ""


def _unexpected(entry: Entry, said: Certificate | DriveFile) -> str:
    """Why the evidence shows none of the formulas that it has to show, or nothing."""
    written = said.claim if isinstance(said, Certificate) else said.formula
    wanted = entry.expected()
    shown = entry.common.formula(written)
    if wanted is None or any(is_same(shown, x) for x in wanted):
        return ""
    return f"{entry.where} is about {entry.label}, but its file is not: {' '.join(written.split())[:120]}"


def is_same(one: Formula, other: Formula) -> bool:
    """Whether two formulas are equal, the order in a conjunction aside."""
    if isinstance(one, f.And) and isinstance(other, f.And):
        return set(one.parts) == set(other.parts)
    return one == other


def _other_claim(entry: Entry, said: Certificate | DriveFile) -> str:
    written = said.claim if isinstance(said, Certificate) else said.formula
    if entry.claim is None:
        fault = entry.fault_of(written) if entry.fault_of else "it does not say what its file is to show"
        return f"{entry.where}: {fault}" if fault else ""
    if written.strip() == entry.claim.strip() and entry.shows in ("proof", "drive"):
        return ""
    wanted = entry.common.formula(entry.claim)
    if entry.shows == "counterexample" and entry.assuming:
        specification = entry.common.specification
        claim = read_claim(specification, entry.claim)
        wanted = under_limits(specification, claim, entry.assuming).formula
    if entry.shows in ("impossibility", "counterexample"):
        wanted = f.negation(wanted)
    if entry.common.formula(written) == wanted:
        return ""
    short = " ".join(written.split())[:120]
    return f"{entry.where} says {entry.verdict}: {' '.join(entry.claim.split())[:120]}, but its file: {short}"


def shows_of(verdict: str, where: str, proof: Shows = "proof", drive: Shows = "counterexample") -> Shows:
    """What a verdict asks of its evidence. Raises ``InputError`` for a word that is no verdict."""
    if verdict in PROOFS:
        return "proof"
    if verdict == "IMPOSSIBLE":
        return proof
    if verdict in ("REFUTED", "WITNESSED"):
        return drive
    if verdict in DOUBTS:
        return "nothing"
    raise InputError(f"{where}: there is no verdict '{verdict[:40]}'")


def shows_of_claim(verdict: str, where: str) -> Shows:
    """As ``shows_of``, for claims of which only proofs are kept: that one is refuted is without evidence."""
    return "nothing" if verdict == "REFUTED" else shows_of(verdict, where)


def stray_evidence(entry: Entry) -> str:
    """Why the entry's evidence is not of the kind that its verdict asks for, or nothing."""
    if entry.shows == "nothing":
        return f"{entry.where}: {entry.verdict} needs no evidence, but {entry.file} is named" * bool(
            entry.file
        )
    if entry.file is None and entry.trace is None:
        return f"{entry.where}: {entry.verdict} without evidence"
    return ""
