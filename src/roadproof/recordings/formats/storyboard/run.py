"""Runs a storyboard: motions of all vehicles, TICKS times a second, until it ends.

It ends when its StopTrigger fires, when a vehicle comes to the end of the road, REST s after the last story
is complete where there is no StopTrigger, or after LONGEST s. Vehicles keep speed and d unless an action
moves them; an action ends another one that moves the same vehicle in the same direction. Transitions of
storyboard elements are seen by conditions one tick later.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from roadproof.recordings.formats.storyboard.actions import ActionReader, Actor, Axis, Scene, TrajectoryReader
from roadproof.recordings.formats.storyboard.box import Box
from roadproof.recordings.formats.storyboard.conditions import TICKS, ConditionReader, Situation, Trigger
from roadproof.recordings.formats.storyboard.controllers import Arrive, KeepDistance
from roadproof.recordings.formats.storyboard.courses import Course, Point, Steady
from roadproof.recordings.formats.storyboard.document import Document
from roadproof.recordings.formats.storyboard.elements import StoryElement, read_element, starts
from roadproof.recordings.formats.storyboard.positions import State, positions_on
from roadproof.runtime.xml_reader import Element
from roadproof.world.road import Road

LONGEST, REST = 120, 5
_STANDS = 1e-6
"""m/s"""
_ANYWHERE = Point(0.0, 0.0)


@dataclass(frozen=True)
class Play:
    """States of the vehicles' reference points at each tick from 0 on, and why it ended."""

    states: tuple[Mapping[str, State], ...]
    ending: str


def run_storyboard(
    document: Document, boxes: Mapping[str, Box], road: Road, trajectory: TrajectoryReader
) -> Play:
    """The motions that a storyboard describes. Raises ``InputError`` for what is not supported."""
    return _Runner(document, boxes, road, trajectory).run()


class _Runner:
    def __init__(
        self, document: Document, boxes: Mapping[str, Box], road: Road, trajectory: TrajectoryReader
    ) -> None:
        self.document, self.boxes = document, boxes
        positions = positions_on(document, road)
        self.actions = ActionReader(document, boxes, positions, trajectory)
        conditions = ConditionReader(document, boxes, positions)
        board = document.child(document.root, "Storyboard")
        self.stories = [read_element(x, conditions) for x in board.findall("Story")]
        stop = board.find("StopTrigger")
        self.stop = Trigger(Element("StopTrigger") if stop is None else stop, conditions)
        self.init = board.find("Init/Actions")
        ends = [x.s[1] for x in road.lanelets]
        self.end = max((float(x) for x in ends if x is not None), default=float("inf"))
        self.actors: dict[str, Actor] = {}
        self.owners: dict[tuple[str, Axis], StoryElement] = {}
        self.travelled: dict[str, float] = {}
        self.still: dict[str, int] = {}
        self.tick = 0

    def run(self) -> Play:
        self._place()
        found: list[Mapping[str, State]] = []
        complete: int | None = None
        for tick in range(LONGEST * TICKS + 1):
            self.tick = tick
            states = self._states()
            self._count(found[-1] if found else states, states)
            ahead = [x for x, state in states.items() if state.s + self.boxes[x].centre[0] > self.end]
            if ahead:
                return Play(tuple(found), f"{ahead[0]} comes to the end of the road")
            found.append(states)
            now = self._situation(states)
            if self.stop.fires(now):
                return Play(tuple(found), "its StopTrigger fires")
            self._steer(states)
            for story in self.stories:
                self._advance(story, now)
            found[-1] = self._states()  # steps of speed
            if complete is None and all(x.state == "complete" for x in self.stories):
                complete = tick
            if complete is not None and not self.stop.can_fire and tick >= complete + REST * TICKS:
                return Play(tuple(found), f"all is complete for {REST} s")
        return Play(tuple(found), f"it does not end by itself within {LONGEST} s")

    def _states(self) -> dict[str, State]:
        time = self.tick / TICKS
        return {name: _state(actor, time) for name, actor in self.actors.items()}

    def _steer(self, states: Mapping[str, State]) -> None:
        """Let vehicles react to others."""
        for name, actor in self.actors.items():
            course = actor.courses["along"]
            if isinstance(course, KeepDistance | Arrive) and not course.ended(0.0, _ANYWHERE):
                steered = course.next(self.tick / TICKS, states)
                self.actors[name] = Actor(name, {**actor.courses, "along": steered})

    def _count(self, before: Mapping[str, State], states: Mapping[str, State]) -> None:
        """Add up distances and times at rest."""
        for name, state in states.items():
            self.travelled[name] = self.travelled.get(name, 0.0) + abs(state.s - before[name].s)
            if abs(state.v_lon) > _STANDS:
                self.still.pop(name, None)
            else:
                self.still.setdefault(name, self.tick)

    def _situation(self, states: Mapping[str, State]) -> Situation:
        elements: dict[tuple[str, str], frozenset[str]] = {}
        for x in (y for story in self.stories for y in story.walk()):
            elements[x.key] = elements.get(x.key, frozenset()) | x.seen(self.tick)
        return Situation(self.tick, states, self.travelled, self.still, elements)

    def _place(self) -> None:
        """Put the vehicles where Init says, and begin its actions."""
        actions = (
            []
            if self.init is None
            else [
                (self.document.text(private, "entityRef"), x)
                for private in self.init.findall("Private")
                for x in private.findall("PrivateAction")
            ]
        )
        known = {x.get("name") for x in self.document.root.iter("ScenarioObject")}
        for name, action in actions:
            if name not in known:
                raise self.document.error(action, f"there is no ScenarioObject {name}")
        actions = [x for x in actions if x[0] in self.boxes]
        teleports = [x for x in actions if x[1].find("TeleportAction") is not None]
        self._begin_all(teleports)
        for name in self.boxes:
            if name not in self.actors:
                entities = self.document.child(self.document.root, "Entities")
                raise self.document.error(entities, f"{name} has no TeleportAction in Init")
        self._begin_all([x for x in actions if x not in teleports])

    def _begin_all(self, actions: list[tuple[str, Element]]) -> None:
        """Begin actions of Init, those that refer to another vehicle after that one has its place."""
        while actions:
            late = [x for x in actions if not self._begins(*x)]
            if len(late) == len(actions):
                raise self.document.error(late[0][1], "it refers to a vehicle that is not placed")
            actions = late

    def _begins(self, name: str, action: Element) -> bool:
        actor = self.actors.get(name) or Actor(name, {})
        try:
            courses = self.actions.courses(action, actor, Scene(0.0, self._states()))
        except KeyError:
            return False
        if courses or name in self.actors:
            self.actors[name] = Actor(name, {**actor.courses, **courses})
        return True

    def _advance(self, element: StoryElement, now: Situation) -> None:
        """Start, go on with or end an element and those below it."""
        if element.stop.fires(now) and element.state != "complete":
            self._finish(element, "stopTransition")
        if element.node.tag == "Event" and element.state == "running":
            for action in element.children:
                if action.state == "running" and self._done(action):
                    action.finish("endTransition", self.tick)
        if element.state == "standby" and element.node.tag != "Event" and starts(element, now):
            element.change("running", "startTransition", self.tick)
        if element.state != "running":
            return
        if element.node.tag == "Maneuver":
            self._start_events(element, now)
        for child in element.children if element.node.tag != "Event" else ():
            self._advance(child, now)
        if all(x.state == "complete" for x in element.children):
            element.finish("endTransition", self.tick)

    def _start_events(self, maneuver: StoryElement, now: Situation) -> None:
        """Start the events of a maneuver whose triggers fire, by their priorities."""
        for event in maneuver.children:
            if event.state != "standby" or event.left < 1 or not starts(event, now):
                continue
            others = [x for x in maneuver.children if x is not event and x.state == "running"]
            priority = event.node.get("priority", "parallel")
            if priority == "skip" and others:
                event.changes.setdefault(self.tick, set()).add("skipTransition")
                continue
            if priority not in ("overwrite", "override", "skip", "parallel"):
                rule = "one of override, overwrite, skip, parallel is needed"
                raise self.document.error(event.node, f"priority={priority}: {rule}")
            for other in others if priority in ("overwrite", "override") else ():
                self._finish(other, "stopTransition")
            event.change("running", "startTransition", self.tick)
            for action in event.children:
                self._begin(action)

    def _begin(self, action: StoryElement) -> None:
        """Begin an action of an event for all its actors."""
        action.change("running", "startTransition", self.tick)
        kind = self.document.only(action.node)
        if kind.tag == "GlobalAction" and kind.find("EnvironmentAction") is not None:
            return
        if kind.tag not in ("PrivateAction", "UserDefinedAction"):
            raise self.document.error(kind, "this action is not supported")
        if kind.find("TeleportAction") is not None:
            raise self.document.error(kind, "TeleportAction is supported in Init only")
        for name in action.actors if kind.tag == "PrivateAction" else ():
            actor = self.actors[name]
            try:
                courses = self.actions.courses(kind, actor, Scene(self.tick / TICKS, self._states()))
            except KeyError as error:
                raise self.document.error(kind, f"there is no ScenarioObject {error}") from None
            self.actors[name] = Actor(name, {**actor.courses, **courses})
            for axis in courses:
                self.owners[name, axis] = action

    def _courses(self, action: StoryElement) -> Iterator[tuple[str, Axis, Course]]:
        """The courses of an action that no other one has ended."""
        for (name, axis), owner in self.owners.items():
            if owner is action:
                yield name, axis, self.actors[name].courses[axis]

    def _done(self, action: StoryElement) -> bool:
        time = self.tick / TICKS
        return all(x.ended(time, _along(self.actors[name], time)) for name, _, x in self._courses(action))

    def _finish(self, element: StoryElement, how: str) -> None:
        """End an element; vehicles that its actions move keep their speed, and their d."""
        states = self._states()
        for action in (x for x in element.walk() if x.node.tag == "Action" and x.state == "running"):
            for name, axis, _ in [*self._courses(action)]:
                x, time = states[name], self.tick / TICKS
                rest: Course = Steady(time, x.s, x.v_lon) if axis == "along" else Steady(time, x.d)
                self.actors[name] = Actor(name, {**self.actors[name].courses, axis: rest})
        element.finish(how, self.tick)


def _along(actor: Actor, time: float) -> Point:
    return actor.courses["along"].at(time, _ANYWHERE)


def _state(actor: Actor, time: float) -> State:
    along = _along(actor, time)
    across = actor.courses["across"].at(time, along)
    return State(
        *(along.place, across.place, along.speed, across.speed, along.acceleration, across.acceleration)
    )
