"""Conditions of triggers, evaluated TICKS times a second.

Distances have no sign. A time to collision needs vehicles that come closer; a time headway needs a vehicle
that drives forwards, and another one that is not behind it, as in esmini.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import field

from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.control import REMEDY
from roadproof.extensions.exchange.storyboard.distances import distance_between, gaps_on_road, measure_of
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import ObjectState, Positions, States
from roadproof.extensions.exchange.storyboard.rules import RULES, texts_compare
from roadproof.extensions.maps.xml_reader import Element
from roadproof.runtime.records import dataclass

TICKS = 100
"""A second is divided into so many steps, at which conditions are evaluated."""
_TYPES = {"Pedestrian": "pedestrian", "MiscObject": "miscellaneous"}
_ENTITY_RULES: Mapping[str, Callable[[int, int], bool]] = {
    "any": lambda meeting, names: meeting > 0,
    "all": lambda meeting, names: meeting == names,
    "none": lambda meeting, names: meeting == 0,
}
_LOOK_AT_ALL = ("RelativeClearanceCondition", "CollisionCondition")
_EDGES = ("none", "rising", "falling", "risingOrFalling")
_CRITERION = "criteria_"
"""Names of conditions that CARLA's scenario_runner takes as criteria of a test, not as conditions."""
_SLOWEST = 1e-3
"""m/s: slower vehicles have no headway."""


@dataclass(frozen=True)
class Situation:
    """The inputs of conditions: the tick, vehicles and how far they went, and states of storyboard elements.

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
    boxes: Mapping[str, ObjectBox]
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
            problem = f"triggeringEntitiesRule={rule}: one of {', '.join(_ENTITY_RULES)} is needed"
            raise self.document.error(triggering, problem)
        names = [self.document.text(x, "entityRef") for x in triggering.findall("EntityRef")]
        node = self.document.only(self.document.child(kind, "EntityCondition"))
        others = [x.get("entityRef", "") for x in node.iter() if x.peek("entityRef")]
        for name in (*names, *others):
            if name not in self.boxes:
                raise self.document.error(triggering, f"there is no ScenarioObject {name}")
        observed = [*now.controlled] if node.tag in _LOOK_AT_ALL else [*names, *others]
        for name in observed:
            if name in now.controlled:
                raise self.document.error(node, f"it looks at {name}, {now.controlled[name]}; {REMEDY}")
        there = all(x in now.states for x in others)
        entities = frozenset(x for x in names if there and x in now.states and self._by_entity(node, x, now))
        return entities if _ENTITY_RULES[rule](len(entities), len(names)) else None

    def _by_value(self, node: Element, now: Situation) -> bool:
        document = self.document
        if node.tag == "SimulationTimeCondition":
            return self._compare(node, now.tick / TICKS)
        if node.tag in ("ParameterCondition", "VariableCondition"):
            return self._compare_value(node, now)
        if node.tag != "StoryboardElementStateCondition":
            raise document.error(node, "this condition is not supported")
        kind, name = (document.text(node, f"storyboardElement{x}") for x in ("Type", "Ref"))
        name = name.replace("::", "/").rsplit("/", 1)[-1]
        if (kind, name) not in now.elements:
            raise document.error(node, f"there is no {kind} {name}")
        return document.text(node, "state") in now.elements[kind, name]

    def _compare_value(self, node: Element, now: Situation) -> bool:
        """A parameter or variable, as a number where both it and the value of the condition are."""
        document = self.document
        name = document.text(node, node.tag.removesuffix("Condition").lower() + "Ref").lstrip("$")
        if name not in now.values:
            raise document.error(node, f"there is no parameter or variable {name}")
        try:
            return texts_compare(document.text(node, "rule"), now.values[name], document.text(node, "value"))
        except ValueError as error:
            raise document.error(node, str(error)) from None

    def _by_entity(self, node: Element, name: str, now: Situation) -> bool:
        document, state = self.document, now.states[name]
        match node.tag:
            case "EndOfRoadCondition":  # a recording ends before
                return False
            case "TraveledDistanceCondition":
                return now.travelled[name] >= document.number(node, "value")
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
                return stands is not None and now.tick - stands >= document.number(node, "duration") * TICKS
            case "ReachPositionCondition":
                s, d = self.positions.find(document.child(node, "Position"), now.states)
                return math.hypot(state.s - s, state.d - d) <= document.number(node, "tolerance")
            case "DistanceCondition":
                s, d = self.positions.find(document.child(node, "Position"), now.states)
                return self._compare(
                    node, self._distance(node, name, ObjectState(s, d, 0, 0, 0, 0), None, now)
                )
            case "RelativeDistanceCondition":
                other, there = self._other(node, now)
                return self._compare(node, self._distance(node, name, there, other, now))
            case "TimeHeadwayCondition":
                return self._time_headway(node, name, now)
            case "CollisionCondition":
                return any(self._touch(name, x, now) for x in self._collision_partners(node, name, now))
            case "TimeToCollisionCondition":
                return self._time_to_collision(node, name, now)
        raise document.error(node, "this condition is not supported")

    def _collision_partners(self, node: Element, name: str, now: Situation) -> list[str]:
        """The objects that a CollisionCondition is about: the one that it names, or all of a type."""
        kind = node.find("ByType")
        if kind is None:
            return [self._other(self.document.child(node, "EntityRef"), now)[0]]
        target_type = self.document.text(kind, "type")
        return [
            x for x in now.states if x != name and _TYPES.get(self.boxes[x].kind, "vehicle") == target_type
        ]

    def _touch(self, name: str, other: str, now: Situation) -> bool:
        one, far = ((self.boxes[x], now.states[x]) for x in (name, other))
        return all(x <= 0 for x in gaps_on_road(one, far, free=True))

    def _is_clear(self, node: Element, name: str, now: Situation) -> bool:
        """Return whether lanes beside an object exist and no other object is near on them, as in esmini."""
        document, state = self.document, now.states[name]
        way = 1 if state.forward else -1
        opposite, free = document.flag(node, "oppositeLanes"), document.flag(node, "freeSpace")
        back, ahead = (document.number(node, f"distance{x}", 0.0) for x in ("Backward", "Forward"))
        ranges = node.findall("RelativeLaneRange")
        spans = [(document.number(x, "from", -99.0), document.number(x, "to", 99.0)) for x in ranges]
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
        """Return whether the reference point has been on no lane of the map for a duration."""
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
            there = ObjectState(s, d, 0, 0, 0, 0)
            distance = self._distance(node, name, there, None, now)
        closing = (state.v_lon - there.v_lon) * math.copysign(1.0, there.s - state.s)
        return closing > _SLOWEST and self._compare(node, distance / closing)

    def _time_headway(self, node: Element, name: str, now: Situation) -> bool:
        """Decide a headway to a vehicle ahead; false if that one is behind, or this one does not drive
        forwards.
        """
        state = now.states[name]
        other, there = self._other(node, now)
        speed, way = _speeds(state)[0], 1 if state.forward else -1
        headway = self._distance(node, name, there, other, now) / max(speed, _SLOWEST)
        holds = self._compare(node, headway)
        return holds and speed > _SLOWEST and (there.s - state.s) * way >= 0

    def _distance(
        self, node: Element, name: str, there: ObjectState, other: str | None, now: Situation
    ) -> float:
        """The distance to another object or to a place, as the condition says, at least 0."""
        measure, far = measure_of(self.document, node), None if other is None else self.boxes[other]
        return distance_between(self.positions, measure, (self.boxes[name], now.states[name]), (far, there))

    def _other(self, node: Element, now: Situation) -> tuple[str, ObjectState]:
        name = self.document.text(node, "entityRef")
        return name, now.states[name]

    def _compare(self, node: Element, value: float) -> bool:
        rule = self.document.text(node, "rule")
        if rule not in RULES:
            raise self.document.error(node, f"rule={rule}: one of {', '.join(RULES)} is needed")
        return RULES[rule](value, self.document.number(node, "value"))


def _speeds(state: ObjectState) -> tuple[float, float]:
    """Return the speeds of a vehicle to its front and to its left (m/s)."""
    return (state.v_lon, state.v_lat) if state.forward else (-state.v_lon, -state.v_lat)


def _accelerations(state: ObjectState) -> tuple[float, float]:
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
        """Return whether the trigger fires; call it at every tick, as edges and delays need the past."""
        truths = [[self._now(x, now) for x in group] for group in self._groups]
        firing = [[x for x in group if x is not None] for group in truths]
        whole = [x for x, group in zip(firing, truths, strict=True) if group and len(x) == len(group)]
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
