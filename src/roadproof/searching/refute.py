"""Drives against claims: a drive on a reference road on which a claim is false."""

from roadproof.effort import Effort
from roadproof.evidence.judged import Judged
from roadproof.logic.formula import is_state
from roadproof.logic.pins import pins
from roadproof.searching.ask import Search, ask, reads_all
from roadproof.searching.question import SearchOptions, Setting
from roadproof.spec.compose import negation
from roadproof.spec.library import Specification
from roadproof.spec.query import Query


def refuting_drive(specification: Specification, claim: Query, effort: Effort) -> Judged | None:
    """A judged drive on which ``claim`` is false at time 0, or None where none was found.

    Looked for on the usual road, with parameters at the values that the claim's premise demands, and at the
    declared ones else; not for a claim about one instant that no engine reads, of which a state says all.
    Raises ``InputError`` and ``UsageError`` for claims that are not about drives, and ``Late``.
    """
    setting = Setting(values=pins(claim.formula))
    search_options = SearchOptions("smooth", effort=effort, explain=False)
    search = Search(specification, negation(claim), setting, search_options)
    if is_state(claim.formula) and not reads_all(search):
        return None
    outcome = ask(search)
    return outcome.drives[0] if outcome.drives else None
