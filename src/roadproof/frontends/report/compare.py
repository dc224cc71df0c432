"""Two formulas side by side, in words and as a sheet."""

from collections.abc import Iterator

from roadproof.frontends.report.sheet import Column, Sheet, as_outline
from roadproof.library.scenarios import scenario_number
from roadproof.library.specification import Query, Specification
from roadproof.library.words import words_of
from roadproof.logic.custom_names import freedom_lines
from roadproof.logic.first_instant import first_instant_warnings
from roadproof.logic.formula import conjunction
from roadproof.questions.compare import Comparison, Direction

_SENTENCES = {
    "equivalent": "the two are equivalent",
    "stronger": "the first is stronger: it implies the second, but not the reverse",
    "weaker": "the first is weaker: the second implies it, but not the reverse",
    "incomparable": "the two are incomparable: neither implies the other",
    "unknown": "not decided",
}


def as_text(comparison: Comparison, specification: Specification) -> str:
    """The two formulas, how they relate, and what shows that."""
    sets = comparison.sets
    lines = [
        f"first   {comparison.first.text}  (set {sets[0]})",
        *_called(comparison.first, specification.in_set(sets[0])),
        f"second  {comparison.second.text}  (set {sets[1]})",
        *_called(comparison.second, specification.in_set(sets[1])),
        _SENTENCES[comparison.relation],
    ]
    both = conjunction(comparison.first.formula, comparison.second.formula)
    lines += [f"  {text}" for text in (*freedom_lines(both), *first_instant_warnings(both))]
    return "\n".join([*lines, *as_outline(sheet_of(comparison))])


def _shown(direction: Direction) -> str:
    """A verdict with what shows it, and the reason."""
    shown = str(direction.verdict)
    shown += " for all time, on every road" if direction.certificate else ""
    shown += " by a judged drive" if direction.drive else ""
    return shown + (f"; {direction.reason}" if direction.reason else "")


def sheet_of(comparison: Comparison) -> Sheet[tuple[str, Direction]]:
    """An entry for each direction."""
    return Sheet(
        (
            Column("direction", lambda x: x[0]),
            Column("claim", lambda x: x[1].claim.text, look="code"),
            Column("verdict", lambda x: x[1].verdict, look="verdict"),
            Column("reason", lambda x: x[1].reason),
            Column("direction", lambda x: f"{x[0]}:", "outline"),
            Column("verdict", lambda x: _shown(x[1]), "outline"),
        ),
        [*comparison.directions.items()],
    )


def _called(query: Query, specification: Specification) -> Iterator[str]:
    """Yield the title of a side that is one scenario."""
    number = scenario_number(query)
    if number is not None and (name := words_of(specification, number).name):
        yield f"        {name}"
