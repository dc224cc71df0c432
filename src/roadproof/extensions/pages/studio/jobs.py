"""The jobs of the studio's workers, by name; each takes a question of the page and returns a JSON answer."""

from collections.abc import Callable, Mapping
from typing import TypeAlias

from roadproof.extensions.pages.studio import asking, dropping, gallery, naming, showing
from roadproof.extensions.pages.studio.drafting import Draft
from roadproof.extensions.pages.studio.requests import Answer, StudioQuestion, read_question

Job: TypeAlias = Callable[[StudioQuestion], Answer]

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


def answer(kind: str, question: object) -> Answer:
    """Return the answer to one job. Raises ``RoadproofError``."""
    return {**LIVE, **LONG}[kind](read_question(question))


def warm_up(long: bool) -> None:
    """Read a formula, and for ``long`` jobs find a drive, so that the first job is as quick as later ones."""
    first = StudioQuestion(Draft(), formula="v_lon(SV) > 1 m/s", formulas={"formula": "1"})
    naming.read(first)
    if long:
        asking.find(first)
