"""The index and the journal of ``roadproof coverage``: classes of gaps, and claims that there are none."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from roadproof.errors import InputError
from roadproof.evidence.answers.entry import PROOFS, Common, Entry, evidence_name, shows_of, shows_of_claim
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.strict import Fields
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.spec.compose import both, either, eventually, implication
from roadproof.spec.library import Specification
from roadproof.spec.scenarios import (
    PAIR,
    SUBJECT,
    Scenario,
    applied,
    asked_between,
    danger,
    in_lane,
    in_some_zone,
    numbers_of,
    safe,
    sector,
    vehicles_of,
)

SCHEMA = "roadproof/coverage/1"
_CLASS = ("scenario", "component", "description", "condition", "verdict", "gaps", "claim", "certificate")
_CLASS_MORE = ("reason", "none_for", "in_traffic", "trace")
_GAP = ("number", "road", "formula", "first", "caught_by", "classes", "drive", "elsewhere")
_OF_CLASS = ("scenario", "component", "condition", "description", "reason", "none_for")
UNCHECKED_KEPT = (
    *("claim.reason", *(f"classes[].{x}" for x in _OF_CLASS)),
    *(f"classes[].gaps[].{x}" for x in ("first", "caught_by", "classes")),
)
_NEED = ("definition", "extends", "verdict", "road", "formula", "drive")


def read_classes(common: Common, records: Sequence[object]) -> Iterator[Entry]:
    """The classes of an index, or of a line of a journal, which holds their gaps inside."""
    for number, content in enumerate(records, 1):
        line = Fields(content, f"{common.where}, class {number}", (*_CLASS, *_CLASS_MORE))
        verdict, gaps = line.text("verdict"), line.items("gaps")
        shows = shows_of(verdict, line.where, "proof", "drive")
        words = [line.text(x) for x in ("component", "condition") if line.text(x)] or ["no single condition"]
        # A class is witnessed by its gaps, which are entries of their own.
        fault = f"{line.where}: {verdict} with {len(gaps)} gaps" if bool(gaps) != (shows == "drive") else ""
        if shows == "drive" and (line.text("claim") or line.has("certificate")):
            fault = f"{line.where}: {verdict} with a claim or a certificate that there is no gap"
        if shows != "drive" or fault:
            yield Entry(
                common,
                line.where,
                ("class", line.content.get("scenario"), *words),
                verdict,
                f"class {', '.join(words)}",
                "nothing" if shows == "drive" else shows,
                line.text("claim"),
                evidence_name(line, "certificate"),
                unchecked=("that the claim says that the class is empty",) if shows == "proof" else (),
                fault=fault,
            )
        inside = [gap for gap in gaps if isinstance(gap, dict)]
        yield from read_gaps(common, inside, line.where)


def read_gaps(common: Common, records: Sequence[object], where: str) -> Iterator[Entry]:
    """Gaps: drives that the set misses."""
    unchecked = ("which wider set catches it", "to which classes it belongs")
    for number, content in enumerate(records, 1):
        line = Fields(content, f"{where}, gap {number}", _GAP)
        placed = Fields(line.mapping("elsewhere"), f"{line.where}, elsewhere")
        files: list[tuple[str | None, str | None, str]] = [
            (line.text("formula"), evidence_name(line, "drive"), line.text("road"))
        ]
        files += [(None, evidence_name(placed, road), road) for road in placed.content]
        for claim, file, road in files:
            told = unchecked if claim else (*unchecked, "that its formula is that of the gap elsewhere")
            yield Entry(
                common, line.where, ("gap", file), "WITNESSED", f"gap on {road}", "drive", claim, file,
                unchecked=told, fault_of=_not_compared, fault_of_drive=partial(_on_other_road, road),
            )  # fmt: skip


def _on_other_road(road: str, file: DriveFile) -> str:
    """Why a drive is not on a road, or nothing."""
    return "" if file.road.name == road else f"its road is {road[:40]}, but that of its file {file.road.name}"


def _not_compared(formula: str) -> str:
    """Of gaps elsewhere, whose formulas the index does not say; the entry lists that as not checked."""
    return ""


def read_record(record: Fields, background: Background) -> Iterator[Entry]:
    """An answer that was kept: to a claim, on a definition, or on the classes of a component."""
    common = background.at(background.said.text("set"))
    if record.has("claim"):
        yield from read_claims(common, [record.get("claim")])
    elif record.has("need"):
        yield from read_needs(common, [record.get("need")])
    else:
        yield from read_classes(common, record.items("classes"))


def name_of_group(record: Fields) -> str | None:
    """Under which name the answer on the classes of a component is kept; None of another answer."""
    return record.text("group").replace(" ", "-") if record.has("group") else None


def read_claims(common: Common, records: Sequence[object]) -> Iterator[Entry]:
    """The claims that together say that there is no gap."""
    for number, content in enumerate(records, 1):
        where = f"{common.where}, claim {number}"
        line = Fields(content, where, ("claim", "verdict", "certificate", "reason"))
        verdict, claim = line.text("verdict"), line.text("claim")
        shows = shows_of_claim(verdict, where)
        file = evidence_name(line, "certificate")
        yield Entry(
            common,
            where,
            ("claim", claim),
            verdict,
            common.set_name,
            shows,
            claim,
            file,
            None,
            None,
            unchecked_of(verdict),
        )


def read_needs(common: Common, records: Sequence[object]) -> Iterator[Entry]:
    """The definitions that are needed for there to be no gap."""
    for number, content in enumerate(records, 1):
        line = Fields(content, f"{common.where}, need {number}", _NEED)
        verdict, name = line.text("verdict"), line.text("definition")
        drive = verdict == "WITNESSED"
        yield Entry(
            common,
            line.where,
            ("need", name),
            verdict,
            f"{name} of {common.set_name}",
            "drive" if drive else "nothing",
            line.text("formula") if drive else name,
            evidence_name(line, "drive"),
            unchecked=("that the formula is the set without the definition",) if drive else (),
        )


def read_index(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index. Raises ``InputError``."""
    common = background.at(data.text("set"))
    yield from read_claims(common, data.items("claims"))
    yield from read_needs(common, data.items("needs"))
    yield from _numbered(data)
    yield from read_classes(common, data.items("classes"))
    yield from read_gaps(common, data.items("gaps"), data.where)


def _numbered(data: Fields) -> Iterator[Entry]:
    """Nothing; raises ``InputError`` where classes name gaps that are not there."""
    count = len(data.items("gaps"))
    told = [n for content in data.items("classes") for n in Fields(content, data.where).items("gaps")]
    if told != list(range(1, count + 1)):
        raise InputError(f"{data.where}: its classes name the gaps {str(told)[:60]}, but it has 1 to {count}")
    yield from ()


def faults(data: Fields, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """What the verdict on the set says beyond what its entries show."""
    common = background.at(data.text("set"))
    verdict = data.text("verdict")
    lines = [Fields(x, data.where) for x in data.items("claims")]
    if [common.formula(x.text("claim")) for x in lines] != _claims(common.specification):
        yield "its claims are not those that together say that there is no gap"
    if verdict == "COVERED":
        if not all(x.text("verdict") in PROOFS for x in lines):
            yield "COVERED, but its claims are not all proved"
    elif verdict == "GAPS":
        if not data.items("gaps"):
            yield "GAPS, but it has none"
    elif verdict not in ("UNKNOWN", "CROSSCHECK-FAILED"):
        yield f"there is no verdict '{verdict[:40]}' on a set"


def _claims(specification: Specification) -> list[Formula]:
    """Where SV is in L, one of the scenarios of its sector holds; and vehicles in zones are in a sector."""
    sectors: dict[Formula, list[int]] = {}
    for number in numbers_of(specification):
        if len(vehicles_of(specification, Scenario(number, specification.set_name))) == 2:
            meaning = without_names(sector(specification, number, PAIR).formula)
            sectors.setdefault(meaning, []).append(number)
    claims: list[Formula] = []
    for numbers in sectors.values():
        later = eventually(danger(specification, *PAIR))
        starts = (safe(specification, *PAIR), later, *asked_between(specification, *PAIR))
        premise = both(sector(specification, numbers[0], PAIR), in_lane(specification, SUBJECT), *starts)
        some = [
            applied(specification, Scenario(number, specification.set_name), roles)
            for roles in (PAIR, PAIR[::-1])
            for number in numbers
        ]
        claims.append(implication(premise, either(*some)).formula)
    somewhere = both(*(in_some_zone(specification, vehicle) for vehicle in PAIR))
    some_sector = either(*(sector(specification, numbers[0], PAIR) for numbers in sectors.values()))
    return [*claims, implication(somewhere, some_sector).formula]


def record_faults(record: Fields, background: Background) -> Iterator[str]:
    """Where the claim of a kept answer is none of those that together say that there is no gap."""
    if record.has("claim"):
        claim = Fields(record.mapping("claim"), record.where).text("claim")
        common = background.at(background.said.text("set"))
        if common.formula(claim) not in _claims(common.specification):
            yield f"{record.where}: coverage does not rest on this claim: {claim[:120]}"


READER = Reader(
    SCHEMA,
    ("set", "wider", "options", "parameters", "specs"),
    ("view", "verdict", "claims", "classes", "gaps", "needs", "traffic", "seconds"),
    read_index,
    ("group", "classes", "claim", "need"),
    read_record,
    faults,
    unchecked=(
        *("seconds", "wider", "traffic", "claims[].reason"),
        *(f"classes[].{x}" for x in (*_OF_CLASS, "in_traffic", "trace")),
        *(f"gaps[].{x}" for x in ("number", "first", "caught_by", "classes")),
    ),
    unchecked_kept=("said.wider", *UNCHECKED_KEPT),
    file_name=name_of_group,
    record_faults=record_faults,
)
