"""Explanations of a NONE-WITHIN: for answers, and from Python."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Unpack

from roadproof.engines.search.claim_search import drive_mode, search_for_claim
from roadproof.engines.setting import Search, SearchOptions
from roadproof.errors import UsageError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim
from roadproof.extensions.encoding.conflict import NoneWithinExplanation, explain_none
from roadproof.extensions.encoding.keywords import ConflictKeywords
from roadproof.extensions.encoding.settings import Conflict
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.settings import setting
from roadproof.frontends.settings.option import takes
from roadproof.runtime.budget import Work
from roadproof.verdict import Verdict


def explanations(answers: Iterable[ClaimAnswer]) -> list[str]:
    """Return an explanation for each NONE-WITHIN among answers, or why there is none.

    Answers about the same drives, such as one with trees, have one explanation.
    """
    none = [x.claim for x in answers if x.verdict is Verdict.NONE_WITHIN]
    claims = {replace(x, mode=replace(drive_mode(x), trees=False)).digest(): x for x in none}
    return [_explanation(x) for x in claims.values()]


def _explanation(claim: Claim) -> str:
    try:
        return str(explain_none(search_for_claim(claim, Work())))
    except UsageError as error:
        return f"not explained: {error}"


@takes(Conflict)
def conflict(
    what: What, using: Definitions | None = None, **options: Unpack[ConflictKeywords]
) -> NoneWithinExplanation:
    """Return which definitions and limits conflict where a scenario or formula has no drive.

    The parts of a conflict are irreducible: left out one by one, each of them leaves a relaxation with a
    solution. Then limits are widened one by one, until a drive is found. Raises ``UsageError`` where no
    solver shows that there is no drive, ``TextError``, ``InputError``.

    >>> print(conflict("v_lon(SV) > 25 m/s and G v_lon(SV) < 20 m/s"))
    in conflict, with ranges of places and speeds; none can be left out:
      v_lon(SV) > 25 m/s
      G v_lon(SV) < 20 m/s
    no drive was found with one limit up to 4 times as wide
    """
    settings, home = Conflict.of(options), definitions_of(using)
    number, query = home.numbered(what)
    place = replace(setting(home, settings), natural=False)
    return explain_none(Search(home.specification, query, place, SearchOptions(), scenario=number))
