"""Answers to a question for drives from the solution of another solver."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roadproof.engines.search.claim_search import search_for_claim
from roadproof.engines.setting import Search
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim
from roadproof.extensions.encoding.judging import columns_of, judged
from roadproof.extensions.encoding.kinds import DRIVES, Drives
from roadproof.extensions.encoding.naming import Naming
from roadproof.extensions.encoding.posed import PosedSearch, posed_searches
from roadproof.extensions.encoding.solutions import Solution, read_solution
from roadproof.questions.question import Question
from roadproof.questions.witness import WitnessQuestion
from roadproof.runtime.budget import Work


def answers_from(question: Question[Any], path: Path) -> Mapping[str, ClaimAnswer]:
    """Return the answer to the one claim of a question for drives: the judged drive of a solution.

    The solution may be one for any lanes and any ``drives`` of ``compile``. Raises ``InputError`` for a
    solution of none of these, with the row that it breaks, ``UsageError`` for several claims.
    """
    if not isinstance(question, WitnessQuestion):
        raise UsageError("solution: it is of a question for drives")
    names = [x for name in question.named for x in question.claim_names(name)]
    if len(names) != 1:
        raise UsageError(f"solution={path}: it is one drive, and {len(names)} are asked for; ask for one")
    claim = question.claim(names[0])
    solution = read_solution(path)
    refusals: list[InputError] = []
    for naming in _candidates(claim, solution):
        try:
            drive = judged(naming.posed, columns_of(naming, solution), str(path))
        except InputError as refusal:
            refusals.append(refusal)
        else:
            return {names[0]: ClaimAnswer(claim, drive)}
    more = len(refusals) - 1
    others = f". It breaks the problems for other lanes or drives ({more}), too" if more else ""
    raise InputError(f"{refusals[0]}{others}")


def _candidates(claim: Claim, solution: Solution) -> list[Naming]:
    """Return the problems of a claim that have all columns of a solution; the first one where none has."""
    search = search_for_claim(claim, Work())
    posed = (x for drives in DRIVES for x in _posed(search, drives))
    namings = [Naming(x) for x in posed]
    if not namings:
        raise UsageError(f"{claim.query.text[:80]}: no engine encodes it, so it has no solution")
    return [x for x in namings if _has_columns(x, solution)] or namings[:1]


def _has_columns(naming: Naming, solution: Solution) -> bool:
    """Return whether a problem has all columns of a solution; without choices it may be of any degree."""
    choices = {*solution.values} - {*naming.unknowns}
    try:
        return not choices or choices <= {*naming.columns}
    except UsageError:  # no row bounds it
        return False


def _posed(search: Search, drives: Drives) -> tuple[PosedSearch, ...]:
    try:
        return posed_searches(search, drives)
    except UsageError:  # no row bounds it
        return ()
