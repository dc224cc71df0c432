"""Conditions of triggers, evaluated TICKS times a second.

Distances have no sign. A time to collision needs vehicles that come closer; a time headway needs a vehicle
that drives forwards, and another one that is not behind it, as in esmini.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import field

from roadproof.extensions.exchange.storyboard.box import Box
from roadproof.extensions.exchange.storyboard.control import REMEDY
from roadproof.extensions.exchange.storyboard.distances import distance_between, gaps_on_road, measure_of
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import Positions, State, States
from roadproof.extensions.exchange.storyboard.rules import RULES, texts_compare
from roadproof.runtime.records import dataclass
from roadproof.runtime.xml_reader import Element

TICKS = 100
"""A second is divided into so many steps, at which conditions are evaluated."""
_TYPES = {"Pedestrian": "pedestrian", "MiscObject": "miscellaneous"}
_ENTITY_RULES: Mapping[str, Callable[[int, int], bool]] = {
    "any": lambda found, names: found > 0,
    "all": lambda found, names: found == names,
    "none": lambda found, names: found == 0,
}
_LOOK_AT_ALL = ("RelativeClearanceCondition", "CollisionCondition")
_EDGES = ("none", "rising", "falling", "risingOrFalling")
_CRITERION = "criteria_"
"""Names of conditions that CARLA's scenario_runner takes as criteria of a test, not as conditions."""
_SLOWEST = 1e-3
"""m/s: slower vehicles have no headway."""


@dataclass(frozen=True)
class Situation:
    """What conditions can see: the tick, vehicles and how far they went, and states of storyboard elements.

    ``still``: since when each vehicle stands, in ticks. ``elements``: their states and
    transitions by type and name. ``values``: of parameters and variables, which actions may change.
    ``controlled``: objects that a controller moves, and from when on, in words.
    """

    tick: int
    states: States
    travelled: Mapping[str, float]
    still: Mapping[str, int]
    elements: Mapping[tuple[str, str], frozenset[str]]
    values: Mapping[str, str]
    controlled: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class ConditionReader:
    """Evaluates conditions of a document."""

    document: Document
    boxes: Mapping[str, Box]
    positions: Positions
    off_road: dict[tuple[Element, str], int] = field(default_factory=dict)
    """Since which tick an object is beside the road, as seen by a condition."""

    def triggering(self, condition: Element, now: Situation) -> frozenset[str] | None:
        """The entities for which a Condition holds; None where it does not hold. Raises ``InputError``.

        Edge and delay are left to the trigger. A condition on a value holds for no entity.
        """
        if (condition.get("name") or "").startswith(_CRITERION):
            condition.read_all()
            return None
        kind = self.document.only(condition)
        if kind.tag == "ByValueCondition":
            return frozenset() if self._by_value(self.document.only(kind), now) else None
        if kind.tag != "ByEntityCondition":
            raise self.document.error(kind, "this condition is not supported")
        triggering = self.document.child(kind, "TriggeringEntities")
        rule = self.document.text(triggering, "triggeringEntitiesRule")
        if rule not in _ENTITY_RULES:
            told = f"triggeringEntitiesRule={rule}: one of {', '.join(_ENTITY_RULES)} is needed"
            raise self.document.error(triggering, told)
        names = [self.document.text(x, "entityRef") for x in triggering.findall("EntityRef")]
        node = self.document.only(self.document.child(kind, "EntityCondition"))
        others = [x.get("entityRef", "") for x in node.iter() if x.peek("entityRef")]
        for name in (*names, *others):
            if name not in self.boxes:
                raise self.document.error(triggering, f"there is no ScenarioObject {name}")
        looks = [*now.controlled] if node.tag in _LOOK_AT_ALL else [*names, *others]
        for name in looks:
            if name in now.controlled:
                raise self.document.error(node, f"it looks at {name}, {now.controlled[name]}; {REMEDY}")
        there = all(x in now.states for x in others)
        found = frozenset(x for x in names if there and x in now.states and self._by_entity(node, x, now))
        return found if _ENTITY_RULES[rule](len(found), len(names)) else None

    def _by_value(self, node: Element, now: Situation) -> bool:
        read = self.document
        if node.tag == "SimulationTimeCondition":
            return self._compare(node, now.tick / TICKS)
        if node.tag in ("ParameterCondition", "VariableCondition"):
            return self._compare_value(node, now)
        if node.tag != "StoryboardElementStateCondition":
            raise read.error(node, "this condition is not supported")
        kind, name = (read.text(node, f"storyboardElement{x}") for x in ("Type", "Ref"))
        name = name.replace("::", "/").rsplit("/", 1)[-1]
        if (kind, name) not in now.elements:
            raise read.error(node, f"there is no {kind} {name}")
        return read.text(node, "state") in now.elements[kind, name]

    def _compare_value(self, node: Element, now: Situation) -> bool:
        """A parameter or variable, as a number where both it and the value of the condition are."""
        read = self.document
        name = read.text(node, node.tag.removesuffix("Condition").lower() + "Ref").lstrip("$")
        if name not in now.values:
            raise read.error(node, f"there is no parameter or variable {name}")
        try:
            return texts_compare(read.text(node, "rule"), now.values[name], read.text(node, "value"))
        except ValueError as error:
            raise read.error(node, str(error)) from None

    def _by_entity(self, node: Element, name: str, now: Situation) -> bool:
        read, state = self.document, now.states[name]
        match node.tag:
            case "EndOfRoadCondition":  # a recording ends before
                return False
            case "TraveledDistanceCondition":
                return now.travelled[name] >= read.number(node, "value")
            case "SpeedCondition":
                return self._compare(node, self._on_axis(node, _speeds(state)))
            case "AccelerationCondition":
                return self._compare(node, self._on_axis(node, _accelerations(state)))
            case "RelativeSpeedCondition":
                speeds = [self._on_axis(node, _speeds(x)) for x in (state, self._other(node, now)[1])]
                return self._compare(node, speeds[0] - speeds[1])
            case "RelativeClearanceCondition":
                return self._is_clear(node, name, now)
            case "OffroadCondition":
                return self._is_off_road(node, name, now)
            case "StandStillCondition":
                stands = now.still.get(name)
                return stands is not None and now.tick - stands >= read.number(node, "duration") * TICKS
            case "ReachPositionCondition":
                s, d = self.positions.find(read.child(node, "Position"), now.states)
                return math.hypot(state.s - s, state.d - d) <= read.number(node, "tolerance")
            case "DistanceCondition":
                s, d = self.positions.find(read.child(node, "Position"), now.states)
                return self._compare(node, self._distance(node, name, State(s, d, 0, 0, 0, 0), None, now))
            case "RelativeDistanceCondition":
                other, there = self._other(node, now)
                return self._compare(node, self._distance(node, name, there, other, now))
            case "TimeHeadwayCondition":
                return self._time_headway(node, name, now)
            case "CollisionCondition":
                return any(self._touch(name, x, now) for x in self._hit(node, name, now))
            case "TimeToCollisionCondition":
                return self._time_to_collision(node, name, now)
        raise read.error(node, "this condition is not supported")

    def _hit(self, node: Element, name: str, now: Situation) -> list[str]:
        """The objects that a CollisionCondition is about: the one that it names, or all of a type."""
        kind = node.find("ByType")
        if kind is None:
            return [self._other(self.document.child(node, "EntityRef"), now)[0]]
        wanted = self.document.text(kind, "type")
        return [x for x in now.states if x != name and _TYPES.get(self.boxes[x].kind, "vehicle") == wanted]

    def _touch(self, name: str, other: str, now: Situation) -> bool:
        one, far = ((self.boxes[x], now.states[x]) for x in (name, other))
        return all(x <= 0 for x in gaps_on_road(one, far, free=True))

    def _is_clear(self, node: Element, name: str, now: Situation) -> bool:
        """Whether lanes beside an object exist and no other object is near on them, as in esmini."""
        read, state = self.document, now.states[name]
        way = 1 if state.forward else -1
        opposite, free = read.flag(node, "oppositeLanes"), read.flag(node, "freeSpace")
        back, ahead = (read.number(node, f"distance{x}", 0.0) for x in ("Backward", "Forward"))
        ranges = node.findall("RelativeLaneRange")
        spans = [(read.number(x, "from", -99.0), read.number(x, "to", 99.0)) for x in ranges]
        spans = spans or [(-99.0, 99.0)]
        here, lanes = self.positions.lane_at(node, (state.s, state.d))
        if not any(low <= (k - here) * way <= high for k in range(lanes) for low, high in spans):
            return False
        named = {x.get("entityRef") for x in node.findall("EntityRef")}
        for other, there in now.states.items():
            if other == name or (named and other not in named):
                continue
            if there.forward != state.forward and not opposite:
                continue
            apart, length = (there.s - state.s) * way, 0.0
            if free:
                length = (self.boxes[name].length + self.boxes[other].length) / 2
            beside = (self.positions.lane_at(node, (there.s, there.d))[0] - here) * way
            if -back - length <= apart <= ahead + length and any(x <= beside <= y for x, y in spans):
                return False
        return True

    def _on_axis(self, node: Element, values: tuple[float, float]) -> float:
        """The value along the vehicle, or across it where the ``direction`` says so."""
        direction = node.get("direction", "longitudinal")
        if direction not in ("longitudinal", "lateral"):
            raise self.document.error(node, f"direction={direction}: longitudinal or lateral is needed")
        return values[0] if direction == "longitudinal" else values[1]

    def _is_off_road(self, node: Element, name: str, now: Situation) -> bool:
        """Whether the reference point has been on no lane of the map for a duration."""
        state = now.states[name]
        if not self.positions.is_off_road((state.s, state.d)):
            self.off_road.pop((node, name), None)
            return False
        since = self.off_road.setdefault((node, name), now.tick)
        return now.tick - since >= self.document.number(node, "duration") * TICKS

    def _time_to_collision(self, node: Element, name: str, now: Situation) -> bool:
        target = self.document.only(self.document.child(node, "TimeToCollisionConditionTarget"))
        state = now.states[name]
        if target.tag == "EntityRef":
            other, there = self._other(target, now)
            distance = self._distance(node, name, there, other, now)
        else:
            s, d = self.positions.find(target, now.states)
            there = State(s, d, 0, 0, 0, 0)
            distance = self._distance(node, name, there, None, now)
        closing = (state.v_lon - there.v_lon) * math.copysign(1.0, there.s - state.s)
        return closing > _SLOWEST and self._compare(node, distance / closing)

    def _time_headway(self, node: Element, name: str, now: Situation) -> bool:
        """That to another vehicle, unless that one is behind, or this one stands or drives backwards."""
        state = now.states[name]
        other, there = self._other(node, now)
        speed, way = _speeds(state)[0], 1 if state.forward else -1
        headway = self._distance(node, name, there, other, now) / max(speed, _SLOWEST)
        holds = self._compare(node, headway)
        return holds and speed > _SLOWEST and (there.s - state.s) * way >= 0

    def _distance(self, node: Element, name: str, there: State, other: str | None, now: Situation) -> float:
        """The distance to another object or to a place, as the condition says, at least 0."""
        measure, far = measure_of(self.document, node), None if other is None else self.boxes[other]
        return distance_between(self.positions, measure, (self.boxes[name], now.states[name]), (far, there))

    def _other(self, node: Element, now: Situation) -> tuple[str, State]:
        name = self.document.text(node, "entityRef")
        return name, now.states[name]

    def _compare(self, node: Element, value: float) -> bool:
        rule = self.document.text(node, "rule")
        if rule not in RULES:
            raise self.document.error(node, f"rule={rule}: one of {', '.join(RULES)} is needed")
        return RULES[rule](value, self.document.number(node, "value"))


def _speeds(state: State) -> tuple[float, float]:
    """Along and across a vehicle, to its front and its left."""
    return (state.v_lon, state.v_lat) if state.forward else (-state.v_lon, -state.v_lat)


def _accelerations(state: State) -> tuple[float, float]:
    return (state.a_lon, state.a_lat) if state.forward else (-state.a_lon, -state.a_lat)


class Trigger:
    """A trigger with what its conditions were: one group of which all conditions hold fires it.

    ``entities``: those for which the conditions of the group that fired last hold.
    """

    def __init__(self, node: Element, reader: ConditionReader) -> None:
        self._reader = reader
        self._groups = [x.findall("Condition") for x in node.findall("ConditionGroup")]
        self._was: dict[Element, frozenset[str] | None] = {}
        self._fired: dict[Element, dict[int, frozenset[str]]] = {}
        self.entities: frozenset[str] = frozenset()

    @property
    def can_fire(self) -> bool:
        return bool(self._groups)

    def fires(self, now: Situation) -> bool:
        """Whether it fires now; to be asked at every tick, as edges and delays need what was before."""
        found = [[self._now(x, now) for x in group] for group in self._groups]
        firing = [[x for x in group if x is not None] for group in found]
        whole = [x for x, group in zip(firing, found, strict=True) if group and len(x) == len(group)]
        if whole:
            self.entities = frozenset().union(*(x for group in whole for x in group))
        return bool(whole)

    def _now(self, condition: Element, now: Situation) -> frozenset[str] | None:
        """The entities for which a condition fires, with its edge and delay; None where it does not."""
        document = self._reader.document
        edge = condition.get("conditionEdge", "none")
        if edge not in _EDGES:
            raise document.error(condition, f"conditionEdge={edge}: one of {', '.join(_EDGES)} is needed")
        holds = self._reader.triggering(condition, now)
        was = self._was.get(condition, holds)
        self._was[condition] = holds
        rises, falls = holds is not None and was is None, was is not None and holds is None
        fired = {
            "none": holds,
            "rising": holds if rises else None,
            "falling": was if falls else None,
            "risingOrFalling": holds if rises else was if falls else None,
        }[edge]
        delay = round(document.number(condition, "delay", 0.0) * TICKS)
        known = self._fired.setdefault(condition, {})
        if fired is not None:
            known[now.tick] = fired
        return known.get(now.tick - delay) if delay else fired
