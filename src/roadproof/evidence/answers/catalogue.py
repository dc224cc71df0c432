"""The index and the kept answers of ``roadproof catalogue``: what abstract tests imply, exclude and show.

What concrete tests show is told there too, but the tests themselves are the evidence, and are not in the
folder: the question has to be asked again to know it.
"""

from collections.abc import Iterator, Sequence

from roadproof.evidence.answers.entry import Common, Entry, one_of, shows_of, shows_of_claim
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields
from roadproof.spec.compose import both, implication, negation
from roadproof.spec.elaborate import read_claim
from roadproof.spec.scenarios import Scenario, applied, number_in

SCHEMA = "roadproof/catalogue/1"
_FACT = ("test", "other", "relation", "premise", "conclusion", "formula", "verdict", "reason")
_FACT_MORE = ("certificate", "drive", "also")
_VERDICTS = {
    "implies": "PROVED",
    "excludes": "PROVED",
    "shows": "WITNESSED",
    "runs": "WITNESSED",
    "empty": "IMPOSSIBLE",
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
            (test, other, relation),
            verdict,
            f"{test} {relation} {other}".strip(),
            shows,
            claim,
            one_of(line, shows),
            unchecked=("that the premise is the formula of the test",),
            fault=_fault(line, common, relation, other, claim),
        )


def _fault(line: Fields, common: Common, relation: str, other: str, claim: str) -> str:
    """Where a fact is not about its premise and conclusion, or these not about the scenario that it names."""
    verdict = line.text("verdict")
    if _VERDICTS.get(relation) != verdict:
        return f"{line.where}: relation={relation!r} goes with {_VERDICTS.get(relation)}, not with {verdict}"
    premise = read_claim(common.specification, line.text("premise"))
    if not line.has("conclusion"):
        expected = premise
    else:
        conclusion = read_claim(common.specification, line.text("conclusion"))
        number = number_in(other)
        if number is not None:
            named = applied(common.specification, Scenario(number, common.set_name))
            if named.formula != conclusion.formula:
                return f"{line.where}: its conclusion is not {other}"
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


READER = Reader(
    schema=SCHEMA,
    said=("set", "options", "parameters", "scenarios", "specs"),
    index=(
        *("view", "seconds", "facts", "tests", "targets", "not_tested", "faults", "doubts", "alike"),
        *("contradictions", "notes"),
    ),
    read_index=lambda data, background: read(data.items("facts"), background, data.where),
    record=("name", "facts"),
    read_record=lambda record, background: read(record.items("facts"), background, record.where),
)
