"""Formulas about one instant that no engine reads: a proof that at given values there is no drive."""

from roadproof.analysis.explore.search import Stage, values_of
from roadproof.engines.prove.prover import prove
from roadproof.engines.search.ask import Search
from roadproof.evidence.certificate import Certificate
from roadproof.library.compose import negation
from roadproof.library.motion import Assumption, value_texts
from roadproof.library.specification import Query
from roadproof.logic.fragment import is_cubic_state
from roadproof.logic.rewrite import parameters_of

NEVER = "proved for all states, with the parameters at their values here"


def stages_for(search: Search, stages: tuple[Stage, ...]) -> tuple[Stage, ...]:
    """``stages`` without the last word of an engine, for formulas that have a proof in place of it."""
    hard = is_cubic_state(search.query.formula)
    return tuple(x for x in stages if x != "none") if hard else stages


def never(search: Search, query: Query, units: float) -> Certificate | None:
    """A proof that ``query`` holds in no state with the parameters at the values of ``search``.

    Wherever, however fast and how near vehicles are: it needs no limits. None where none is found with
    ``units`` of work, and for formulas of other kinds. Raises ``BudgetExceeded``.
    """
    if not is_cubic_state(query.formula):
        return None
    values = values_of(search)
    there = {name: values[name] for name in parameters_of(query.formula)}
    said = value_texts(search.specification, there)
    effort = search.search_options.effort.of(units)
    return prove(search.specification, negation(query), effort, assumed=Assumption(said)).certificate
