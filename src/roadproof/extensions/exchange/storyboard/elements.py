"""Stories, acts, maneuver groups, maneuvers and events of a storyboard, with their states."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from roadproof.extensions.exchange.storyboard.conditions import ConditionReader, Situation, Trigger
from roadproof.extensions.maps.xml_reader import Element

KINDS = {
    "Story": "story",
    "Act": "act",
    "ManeuverGroup": "maneuverGroup",
    "Maneuver": "maneuver",
    "Event": "event",
    "Action": "action",
}
_BELOW = {
    "Story": "Act",
    "Act": "ManeuverGroup",
    "ManeuverGroup": "Maneuver",
    "Maneuver": "Event",
    "Event": "Action",
}


@dataclass
class StoryElement:
    """An element in one of the states standby, running and complete.

    ``actors``: the vehicles that its actions move; ``selects``: those that trigger its events act, too.
    ``left``: how often it may still start. ``changes``: the transitions at a tick.
    """

    node: Element
    actors: tuple[str, ...]
    selects: bool
    start: Trigger
    stop: Trigger
    children: "list[StoryElement]"
    left: int
    state: str = "standby"
    changes: dict[int, set[str]] = field(default_factory=dict)

    @property
    def key(self) -> tuple[str, str]:
        return KINDS[self.node.tag], self.node.get("name", "")

    def change(self, state: str, how: str, tick: int) -> None:
        """Be in another state, by a transition."""
        self.state = state
        self.changes.setdefault(tick, set()).add(how)

    def finish(self, how: str, tick: int) -> None:
        """End it with all that runs below."""
        if self.state == "complete":
            return
        if self.state == "running" or how == "stopTransition":
            self.left -= 1
        again = how != "stopTransition" and self.node.tag == "Event" and self.left > 0
        self.change("standby" if again else "complete", how, tick)
        for child in self.children:
            if again:
                child.state = "standby"
            else:
                child.finish(how, tick)

    def visible_states(self, tick: int) -> frozenset[str]:
        """Its state, and the transitions of the tick before."""
        return frozenset({f"{self.state}State", *self.changes.get(tick - 1, ())})

    @property
    def has_started(self) -> bool:
        """Return whether it has ever run."""
        return any("startTransition" in x for x in self.changes.values())

    def walk(self) -> "Iterator[StoryElement]":
        yield self
        for child in self.children:
            yield from child.walk()


def read_element(
    node: Element, reader: ConditionReader, actors: tuple[str, ...] = (), selects: bool = False
) -> StoryElement:
    """An element with those below it."""
    document = reader.document
    if node.tag == "ManeuverGroup":
        selects = document.flag(document.child(node, "Actors"), "selectTriggeringEntities")
        if document.number(node, "maximumExecutionCount", 1.0) != 1:
            problem = f"maximumExecutionCount={node.get('maximumExecutionCount')}: 1 is supported"
            raise document.error(node, problem)
        actors = tuple(document.text(x, "entityRef") for x in node.findall("Actors/EntityRef"))
        for name in actors:
            if name not in reader.boxes:
                raise document.error(node, f"there is no ScenarioObject {name}")
    below = _BELOW.get(node.tag)
    return StoryElement(
        node,
        actors,
        selects,
        Trigger(_trigger(node, "StartTrigger"), reader),
        Trigger(_trigger(node, "StopTrigger"), reader),
        [read_element(x, reader, actors, selects) for x in node.findall(below)] if below else [],
        round(document.number(node, "maximumExecutionCount", 1.0)) if node.tag == "Event" else 1,
    )


def _trigger(node: Element, tag: str) -> Element:
    trigger = node.find(tag)
    return Element(tag) if trigger is None else trigger


def starts_now(element: StoryElement, now: Situation) -> bool:
    """Return whether an element without a start trigger, or one whose trigger fires, starts now."""
    return element.start.fires(now) if element.start.can_fire else True
