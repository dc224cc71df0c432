"""What a worker does for a page: each job is a question of the front door, asked with the page's words."""

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from roadproof.frontends.studio import asking, dropping, naming, showing

Ask: TypeAlias = Mapping[str, Any]
Say: TypeAlias = Callable[[str], None]
Job: TypeAlias = Callable[[Ask, Say], dict[str, Any]]

# Jobs that take a moment, and those that may take long and can be stopped.
LIVE: Mapping[str, Job] = {
    "names": naming.names,
    "explain": naming.definition,
    "read": naming.read,
    "show": showing.show,
    "page": showing.page,
}
LONG: Mapping[str, Job] = {
    "find": asking.find,
    "prove": asking.prove,
    "compare": asking.compare,
    "drop": dropping.drop,
    "pair": dropping.pair,
}


def answer(kind: str, ask: Ask, say: Say) -> dict[str, Any]:
    """The answer to one job. Raises ``RoadproofError``."""
    return {**LIVE, **LONG}[kind](ask, say)


def warm_up(long: bool) -> None:
    """Read a formula, for ``long`` jobs find a drive: so the first of a user is as quick as the next."""
    naming.read({**_FIRST, "formulas": {"formula": "1"}}, None)
    if long:
        asking.find({**_FIRST, "objective": "smooth"}, lambda stage: None)


_FIRST: Ask = {
    "draft": {"base": "base", "text": "", "before": None, "options": {}, "params": {}},
    "set": "edit",
    "formula": "v_lon(SV) > 1 m/s",
    "negated": False,
    "count": 1,
}
