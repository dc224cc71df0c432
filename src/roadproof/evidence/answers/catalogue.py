"""How ``check`` reads the index and the kept answers of ``roadproof catalogue``: facts about abstract tests.

Concrete tests are their own evidence, and are not in the folder: ``api.judging_again`` judges them again,
and derives all other fields.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

from roadproof.errors import InputError
from roadproof.evidence.answers import coverage
from roadproof.evidence.answers.catalogue_index import VERDICTS, Index, KeptFact, Preamble, Record
from roadproof.evidence.answers.entry import Common, Entry, file_of, shows_of, shows_of_claim
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields, rational
from roadproof.evidence.subject import subject_of_fact
from roadproof.library.compose import both, implication, negation
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.scenarios import Scenario, applied, number_in
from roadproof.library.specification import Query
from roadproof.logic.formula import Compare, Formula
from roadproof.logic.terms import constant_value
from roadproof.world.units import unit_text


def _facts(facts: Sequence[KeptFact], background: Background, where: str) -> Iterator[Entry]:
    """The entries of what is said of each test. Raises ``InputError``."""
    common = background.home
    for number, fact in enumerate(facts, 1):
        place = f"{where}, fact {number}"
        if fact.relation in ("implies", "excludes"):
            shows = shows_of_claim(fact.verdict, place)
        else:
            shows = shows_of(fact.verdict, place, "impossibility", "drive")
        yield Entry(
            common,
            place,
            (fact.test, fact.other, fact.relation, fact.term, fact.sense),
            fact.verdict,
            f"{fact.test} {fact.relation} {fact.other}".strip(),
            shows,
            fact.formula,
            file_of(place, shows, fact.certificate, fact.drive),
            unchecked=("that no drive goes farther",) if fact.relation == "reaches" else (),
            fault=_fault(fact, place, common),
            subject=subject_of_fact(fact.test, fact.relation),
            expected=partial(_expected, fact, common),
        )


def _expected(fact: KeptFact, common: Common) -> list[Formula]:
    found = _query(fact, common)
    return [(negation(found) if fact.relation == "empty" else found).formula]


def _query(fact: KeptFact, common: Common) -> Query:
    """What a fact says of its premise and conclusion. Raises ``InputError``."""
    premise = read_claim(common.specification, fact.premise)
    if fact.conclusion is None:
        return premise
    conclusion = read_claim(common.specification, fact.conclusion)
    match fact.relation:
        case "implies":
            return implication(premise, conclusion)
        case "excludes":
            return implication(premise, negation(conclusion))
        case _:
            return both(premise, conclusion)


def _fault(fact: KeptFact, where: str, common: Common) -> str:
    """Where a fact is not about its premise and conclusion, or these not about the scenario that it names."""
    if VERDICTS[fact.relation] != fact.verdict:
        wanted = VERDICTS[fact.relation]
        return f"{where}: relation={fact.relation!r} goes with {wanted}, not with {fact.verdict}"
    if fact.relation not in ("reaches", "open") and (fact.term or fact.sense or fact.at is not None):
        return f"{where}: relation={fact.relation!r} goes with no term, no sense and no value"
    if fact.conclusion is not None:
        conclusion = read_claim(common.specification, fact.conclusion)
        name, _, set_name = fact.other.partition("@")
        number = number_in(name)
        if number is not None:
            named = applied(common.specification, Scenario(number, set_name or common.set_name))
            premise = read_claim(common.specification, fact.premise)
            about, said = ("premise", premise) if fact.relation == "reaches" else ("conclusion", conclusion)
            if named.formula != said.formula:
                return f"{where}: its {about} is not {fact.other}"
        if fact.relation == "reaches" and not _bounds(fact, where, common, conclusion.formula):
            return f"{where}: its conclusion is not that its term is at its value or beyond"
    if common.formula(fact.formula) != _query(fact, common).formula:
        short = fact.formula[:120]
        return f"{where}: its formula is not that {fact.relation} of premise and conclusion: {short}"
    return ""


def _bounds(fact: KeptFact, where: str, common: Common, conclusion: Formula) -> bool:
    """Whether a formula says that the term of a fact is at its value, or beyond, as its sense is."""
    value = rational(fact.at, f"{where}, at")
    sign = {"least": "<=", "greatest": ">="}.get(fact.sense, "=")
    unit = unit_text(read_term(common.specification, fact.term)[1])
    bare = common.formula(f"{fact.term} {sign} 0 {unit}")
    return (
        isinstance(conclusion, Compare)
        and isinstance(bare, Compare)
        and (conclusion.left, conclusion.op) == (bare.left, bare.op)
        and constant_value(conclusion.right) == value
    )


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    """Facts, and what is said of classes of gaps, as an index of ``coverage`` says it."""
    yield from _facts(answer.facts, background, background.where)
    if answer.gaps is None:
        return
    claims = answer.gaps.claims if isinstance(answer, Index) else [answer.gaps.claim]
    if isinstance(answer, Record):
        group = answer.gaps.group
        if group is not None and answer.name != f"gaps-{coverage.stem_of(group)}":
            raise InputError(f"{background.where}, gaps: group='{group[:60]}' does not go with its name")
    entries = coverage.Entries(background.home, background.once(Preamble).scenarios)
    yield from entries.of_claims([x for x in claims if x is not None])
    yield from entries.of_classes(answer.gaps.classes)


def _lines(record: Fields) -> Iterator[object]:
    """The facts of a kept answer, and what it says of gaps."""
    yield from record.items("facts")
    said = Fields(record.mapping("gaps") if record.has("gaps") else {}, record.where)
    if "claim" in said.content:
        yield said.get("claim")
    elif "classes" in said.content:
        yield from said.items("classes")


def _record_faults(kept: Record, background: Background) -> Iterator[str]:
    """As of a kept answer of ``coverage``."""
    if kept.gaps is not None:
        yield from coverage.record_faults(kept.gaps, background)


READER = replace(
    Reader.of(
        Index, Preamble, Record, _entries, file_name=lambda kept: kept.name, record_faults=_record_faults
    ),
    unchecked=("seconds", "facts[].reason"),
    unchecked_kept=(
        *("said.scenarios", *(f"facts[].{x}" for x in ("test", "other", "reason", "also"))),
        *(f"gaps.{x}" for x in coverage.UNCHECKED_KEPT),
    ),
    lines=_lines,
)
