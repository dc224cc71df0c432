"""The index and the kept answers of ``roadproof catalogue``: what abstract tests imply, exclude and show.

What concrete tests show is told there too, but the tests themselves are the evidence, and are not in the
folder: ``api.judging_again`` judges them again, and derives all other fields.
"""

from collections.abc import Iterator, Sequence

from roadproof.errors import InputError
from roadproof.evidence.answers import coverage
from roadproof.evidence.answers.entry import Common, Entry, one_of, shows_of, shows_of_claim
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.codec import read as read_as
from roadproof.evidence.strict import Fields, rational
from roadproof.library.compose import both, implication, negation
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.scenarios import Scenario, applied, number_in
from roadproof.logic.formula import Compare, Formula
from roadproof.logic.terms import constant_value
from roadproof.world.units import unit_text

SCHEMA = "roadproof/catalogue/1"
_FACT = ("test", "other", "relation", "premise", "conclusion", "formula", "verdict", "reason")
_FACT_MORE = ("certificate", "drive", "also", "term", "sense", "at")
_GAPS = ("asked", "classes_in_all", "targets", "empty", "open", "claims", "classes")
_VERDICTS = {
    "implies": "PROVED",
    "excludes": "PROVED",
    "shows": "WITNESSED",
    "runs": "WITNESSED",
    "empty": "IMPOSSIBLE",
    "reaches": "WITNESSED",
    "open": "UNKNOWN",
}


def read(facts: Sequence[object], background: Background, where: str) -> Iterator[Entry]:
    """What is said of each test. Raises ``InputError``."""
    common = background.home
    for number, content in enumerate(facts, 1):
        line = Fields(content, f"{where}, fact {number}", (*_FACT, *_FACT_MORE))
        verdict, relation, claim = line.text("verdict"), line.text("relation"), line.text("formula")
        test, other = line.text("test"), line.text("other")
        if relation in ("implies", "excludes"):
            shows = shows_of_claim(verdict, line.where)
        else:
            shows = shows_of(verdict, line.where, "impossibility", "drive")
        yield Entry(
            common,
            line.where,
            (test, other, relation, line.text("term"), line.text("sense")),
            verdict,
            f"{test} {relation} {other}".strip(),
            shows,
            claim,
            one_of(line, shows),
            unchecked=_unchecked(relation),
            fault=_fault(line, common, relation, other, claim),
        )


def _bounds(line: Fields, common: Common, conclusion: Formula) -> bool:
    """Whether a formula says that the term of a line is at its value, or beyond, as its sense is."""
    term, value = line.text("term"), rational(line.get("at"), f"{line.where}, at")
    sign = {"least": "<=", "greatest": ">="}.get(line.text("sense"), "=")
    unit = unit_text(read_term(common.specification, term)[1])
    bare = common.formula(f"{term} {sign} 0 {unit}")
    return (
        isinstance(conclusion, Compare)
        and isinstance(bare, Compare)
        and (conclusion.left, conclusion.op) == (bare.left, bare.op)
        and constant_value(conclusion.right) == value
    )


def _unchecked(relation: str) -> tuple[str, ...]:
    return ("that no drive goes farther",) if relation == "reaches" else ()


def _fault(line: Fields, common: Common, relation: str, other: str, claim: str) -> str:
    """Where a fact is not about its premise and conclusion, or these not about the scenario that it names."""
    verdict = line.text("verdict")
    if _VERDICTS.get(relation) != verdict:
        return f"{line.where}: relation={relation!r} goes with {_VERDICTS.get(relation)}, not with {verdict}"
    if relation not in ("reaches", "open") and (line.text("term") or line.text("sense") or line.has("at")):
        return f"{line.where}: relation={relation!r} goes with no term, no sense and no value"
    premise = read_claim(common.specification, line.text("premise"))
    if not line.has("conclusion"):
        expected = premise
    else:
        conclusion = read_claim(common.specification, line.text("conclusion"))
        name, _, set_name = other.partition("@")
        number = number_in(name)
        if number is not None:
            named = applied(common.specification, Scenario(number, set_name or common.set_name))
            about, said = ("premise", premise) if relation == "reaches" else ("conclusion", conclusion)
            if named.formula != said.formula:
                return f"{line.where}: its {about} is not {other}"
        if relation == "reaches" and not _bounds(line, common, conclusion.formula):
            return f"{line.where}: its conclusion is not that its term is at its value or beyond"
        match relation:
            case "implies":
                expected = implication(premise, conclusion)
            case "excludes":
                expected = implication(premise, negation(conclusion))
            case _:
                expected = both(premise, conclusion)
    if common.formula(claim) != expected.formula:
        return f"{line.where}: its formula is not that {relation} of premise and conclusion: {claim[:120]}"
    return ""


def read_gaps(claims: Sequence[object], classes: Sequence[object], background: Background) -> Iterator[Entry]:
    """What is said of classes of gaps, as an index of ``coverage`` says it. Raises ``InputError``."""
    numbers = read_as(tuple[int, ...], background.said.items("scenarios"), "scenarios")
    entries = coverage.Entries(background.home, numbers)
    yield from entries.of_claims([read_as(coverage.Claim, x, background.where) for x in claims])
    yield from entries.of_classes([read_as(coverage.KeptClass, x, background.where) for x in classes])


def _read_index(data: Fields, background: Background) -> Iterator[Entry]:
    yield from read(data.items("facts"), background, data.where)
    gaps = Fields(data.mapping("gaps"), f"{data.where}, gaps", _GAPS)
    yield from read_gaps(gaps.items("claims"), gaps.items("classes"), background)


def _read_record(record: Fields, background: Background) -> Iterator[Entry]:
    yield from read(record.items("facts"), background, record.where)
    if record.has("gaps"):
        said = Fields(record.mapping("gaps"), f"{record.where}, gaps", ("claim", "group", "classes"))
        if said.has("group") and record.text("name") != f"gaps-{coverage.name_of_group(said)}":
            raise InputError(f"{said.where}: group='{said.text('group')[:60]}' does not go with its name")
        claims = [said.get("claim")] if said.has("claim") else []
        yield from read_gaps(claims, said.items("classes") if said.has("classes") else [], background)


def _lines(record: Fields) -> Iterator[object]:
    """The facts of a kept answer, and what it says of gaps."""
    yield from record.items("facts")
    said = record.mapping("gaps") if record.has("gaps") else {}
    yield from (said["claim"],) if "claim" in said else said.get("classes", ())


def _record_faults(record: Fields, background: Background) -> Iterator[str]:
    """As of a kept answer of ``coverage``."""
    if record.has("gaps"):
        yield from coverage.record_faults(Fields(record.mapping("gaps"), record.where), background)


READER = Reader(
    schema=SCHEMA,
    said=("set", "options", "parameters", "scenarios", "specs"),
    index=(
        *(
            "view",
            "request",
            "seconds",
            "facts",
            "tests",
            "targets",
            "not_tested",
            "faults",
            "doubts",
            "alike",
        ),
        *("contradictions", "notes", "gaps", "figures", "decisions", "ranges"),
    ),
    read_index=_read_index,
    record=("name", "facts", "gaps"),
    read_record=_read_record,
    unchecked=("seconds", "facts[].reason"),
    unchecked_kept=(
        *("said.scenarios", *(f"facts[].{x}" for x in ("test", "other", "reason", "also"))),
        *(f"gaps.{x}" for x in coverage.UNCHECKED_KEPT),
    ),
    file_name=lambda record: record.text("name"),
    lines=_lines,
    record_faults=_record_faults,
)
