"""What a worker does for a page: each job is a question of the front door, asked with the page's words."""

from collections.abc import Callable, Mapping
from typing import TypeAlias

from roadproof.extensions.pages.studio import asking, dropping, gallery, naming, showing
from roadproof.extensions.pages.studio.drafting import Draft
from roadproof.extensions.pages.studio.requests import Answer, Ask, read_ask

Job: TypeAlias = Callable[[Ask], Answer]

# Jobs that take a moment, and those that may take long and can be stopped.
LIVE: Mapping[str, Job] = {
    "names": naming.names,
    "explain": naming.definition,
    "read": naming.read,
    "show": showing.show,
    "page": showing.page,
    "gallery": gallery.cards,
}
LONG: Mapping[str, Job] = {
    "find": asking.find,
    "prove": asking.prove,
    "compare": asking.compare,
    "drop": dropping.drop,
    "pair": dropping.pair,
}


def answer(kind: str, ask: object) -> Answer:
    """The answer to one job. Raises ``RoadproofError``."""
    return {**LIVE, **LONG}[kind](read_ask(ask))


def warm_up(long: bool) -> None:
    """Read a formula, for ``long`` jobs find a drive: so the first of a user is as quick as the next."""
    first = Ask(Draft(), formula="v_lon(SV) > 1 m/s", formulas={"formula": "1"})
    naming.read(first)
    if long:
        asking.find(first)
