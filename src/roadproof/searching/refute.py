"""Drives against claims: a drive on a reference road on which a claim is false."""

from roadproof.effort import Effort
from roadproof.evidence.judged import Judged
from roadproof.searching.ask import Search, ask
from roadproof.searching.question import SearchOptions
from roadproof.spec.compose import negation
from roadproof.spec.library import Specification
from roadproof.spec.query import Query


def refuting_drive(specification: Specification, claim: Query, effort: Effort) -> Judged | None:
    """A judged drive on which ``claim`` is false at time 0, or None where none was found.

    Looked for on the usual road at declared parameter values. Raises ``InputError`` and
    ``UsageError`` for claims that are not about drives, and ``Late``.
    """
    search_options = SearchOptions("smooth", effort=effort, explain=False)
    outcome = ask(Search(specification, negation(claim), search_options=search_options))
    return outcome.drives[0] if outcome.drives else None
