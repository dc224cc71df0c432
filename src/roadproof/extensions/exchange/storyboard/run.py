"""Runs a storyboard: motions of all vehicles, TICKS times a second, until it ends.

It ends when its StopTrigger fires, when a vehicle comes to the end of the road, REST s after the last story
is complete where there is no StopTrigger, or after LONGEST s. Vehicles keep speed and d unless an action
moves them; an action ends another one that moves the same vehicle in the same direction. Transitions of
storyboard elements are seen by conditions one tick later. An object without place takes no part, and
conditions on it do not hold.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from roadproof.extensions.exchange.storyboard.actions import (
    ActionReader,
    ActionScene,
    Actor,
    in_opposite_direction,
)
from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.conditions import TICKS, ConditionReader, Situation, Trigger
from roadproof.extensions.exchange.storyboard.control import Control
from roadproof.extensions.exchange.storyboard.controllers import AXES, Axis, ReactiveCourse
from roadproof.extensions.exchange.storyboard.courses import AxisCourse, ConstantSpeed, PathCourse
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.elements import StoryElement, read_element, starts_now
from roadproof.extensions.exchange.storyboard.global_actions import act_globally, initial_values
from roadproof.extensions.exchange.storyboard.play import ANYWHERE, Play, place_along, state_of
from roadproof.extensions.exchange.storyboard.positions import ObjectState, positions_on
from roadproof.extensions.maps.xml_reader import Element
from roadproof.world.road import Road

LONGEST, REST = 120, 5
_STANDS = 1e-6
"""m/s"""
_FOLLOW = "RoutingAction/FollowTrajectoryAction"


def run_storyboard(document: Document, boxes: Mapping[str, ObjectBox], road: Road) -> Play:
    """The motions that a storyboard describes. Raises ``InputError`` for what is not supported."""
    runner = _Runner(document, boxes, road)
    play = runner.run()
    return replace(play, controlled=runner.control.controlled, idle=tuple(runner.leave_idle()))


class _Runner:
    def __init__(self, document: Document, boxes: Mapping[str, ObjectBox], road: Road) -> None:
        self.document, self.boxes = document, boxes
        positions = positions_on(document, road)
        self.actions = ActionReader(document, boxes, positions)
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
        self.values = initial_values(document)
        self.control = Control(document)
        self.history: dict[str, list[tuple[int, Actor]]] = {}
        self.act: StoryElement | None = None
        self.tick = 0

    def run(self) -> Play:
        self._place()
        history: list[Mapping[str, ObjectState]] = []
        complete: int | None = None
        for tick in range(LONGEST * TICKS + 1):
            self.tick = tick
            states = self._states()
            self._count(history[-1] if history else states, states)
            if ahead := [x for x, state in states.items() if self._is_beyond(x, state)]:
                return Play(
                    tuple(history), f"{ahead[0]} comes to the end of the road", self.history, at_end=True
                )
            history.append(states)
            now = self._situation(states)
            if self.stop.fires(now):
                return Play(tuple(history), "its StopTrigger fires", self.history)
            self._steer(states)
            for story in self.stories:
                self._advance(story, now)
            history[-1] = self._states()  # steps of speed
            self._remember()
            if complete is None and all(x.state == "complete" for x in self.stories):
                complete = tick
            if complete is not None and not self.stop.can_fire and tick >= complete + REST * TICKS:
                return Play(tuple(history), f"all is complete for {REST} s", self.history)
        return Play(tuple(history), f"it does not end by itself within {LONGEST} s", self.history)

    def leave_idle(self) -> Iterator[str]:
        """Pass over elements that never started, which have no effect, and return the names of events."""
        for element in (y for story in self.stories for y in story.walk()):
            if not element.has_started:
                element.node.read_all()
                if element.node.tag == "Event":
                    yield element.key[1]

    def _remember(self) -> None:
        for name, actor in self.actors.items():
            known = self.history.setdefault(name, [])
            if not known or known[-1][1] is not actor:
                known.append((self.tick, actor))

    def _is_beyond(self, name: str, state: ObjectState) -> bool:
        """Return whether a vehicle that is recorded comes to the end of the road."""
        box = self.boxes[name]
        return box.recorded and state.forward and state.s + box.centre[0] > self.end

    def _states(self) -> dict[str, ObjectState]:
        time = self.tick / TICKS
        return {name: state_of(actor, time) for name, actor in self.actors.items()}

    def _steer(self, states: Mapping[str, ObjectState]) -> None:
        """Update the vehicles that react to others."""
        for name, actor in self.actors.items():
            seen = states if actor.forward else in_opposite_direction(states)
            for axis in AXES:
                course = actor.course(axis)
                if isinstance(course, ReactiveCourse) and not course.ended(0.0, ANYWHERE):
                    self.control.check_course(name, course)
                    self._set(name, {axis: course.next(self.tick / TICKS, seen)})

    def _set(self, name: str, courses: Mapping[Axis, AxisCourse]) -> None:
        self.actors[name] = self.actors[name].with_courses(courses)

    def _count(self, before: Mapping[str, ObjectState], states: Mapping[str, ObjectState]) -> None:
        """Add up distances and times at rest."""
        for name, state in states.items():
            gone = abs(state.s - before[name].s) if name in before else 0.0
            self.travelled[name] = self.travelled.get(name, 0.0) + gone
            if abs(state.v_lon) > _STANDS:
                self.still.pop(name, None)
            else:
                self.still.setdefault(name, self.tick)

    def _situation(self, states: Mapping[str, ObjectState]) -> Situation:
        elements: dict[tuple[str, str], frozenset[str]] = {}
        for x in (y for story in self.stories for y in story.walk()):
            elements[x.key] = elements.get(x.key, frozenset()) | x.visible_states(self.tick)
        return Situation(
            self.tick, states, self.travelled, self.still, elements, self.values, self.control.controlled
        )

    def _place(self) -> None:
        """Place the vehicles as Init says, and begin its actions."""
        actions = (
            []
            if self.init is None
            else [
                (self.document.text(private, "entityRef"), x)
                for private in self.init.findall("Private")
                for x in private.findall("PrivateAction")
            ]
        )
        for name, action in actions:
            if name not in self.boxes:
                raise self.document.error(action, f"there is no ScenarioObject {name}")
        placing = {name for name, action in actions if _placing_element(action) is not None}
        for first in (True, False):
            self._begin_all(
                [x for x in actions if x[0] in placing and (_placing_element(x[1]) is not None) == first]
            )
        for action in () if self.init is None else self.init.findall("GlobalAction"):
            self._act_globally(action)
        self._hand_over()

    def _hand_over(self) -> None:
        """Release the vehicles that controllers move from now on."""
        for name in self.control.controlled:
            self.actors.pop(name, None)

    def _begin_all(self, actions: list[tuple[str, Element]]) -> None:
        """Begin actions of Init, those that refer to another vehicle after that one has its place."""
        while actions:
            late = [x for x in actions if not self._try_begin(*x)]
            if len(late) == len(actions):
                raise self.document.error(late[0][1], "it refers to a vehicle that is not placed")
            actions = late

    def _try_begin(self, name: str, action: Element) -> bool:
        try:
            self._act(name, action)
        except KeyError:
            return False
        return True

    def _act(self, name: str, action: Element) -> tuple[Axis, ...]:
        """Begin a PrivateAction; return the axes along which it moves the vehicle. Raises ``KeyError``."""
        time, states = self.tick / TICKS, self._states()
        if self.control.takes(name, action, time):
            return ()
        teleport = action.find("TeleportAction")
        if teleport is not None:
            self._put(name, self.document.child(teleport, "Position"))
            return ()
        if name not in self.actors:
            follow = self.document.child(action, _FOLLOW)
            self.actors[name] = self.actions.place_actor(follow, name, ActionScene(time, states))
            states = self._states()
        actor = self.actors[name]
        reader, seen = (
            (self.actions, states)
            if actor.forward
            else (self.actions.in_opposite_direction(), in_opposite_direction(states))
        )
        courses = reader.courses(action, actor, ActionScene(time, seen))
        self._set(name, courses)
        stays = isinstance(actor.across, PathCourse) and action.find(_FOLLOW) is None
        return tuple(
            x for x in courses if not (stays and isinstance(courses[x], PathCourse) and x == "across")
        )

    def _put(self, name: str, position: Element) -> None:
        """Move a vehicle to a position."""
        self.actors[name] = self.actions.place_actor(
            position, name, ActionScene(self.tick / TICKS, self._states())
        )

    def _act_globally(self, action: Element) -> None:
        """Begin a GlobalAction. Raises ``InputError`` for what is not supported."""
        node = self.document.only(action)
        if node.tag == "EntityAction":
            name = self.document.text(node, "entityRef")
            if name not in self.boxes:
                raise self.document.error(node, f"there is no ScenarioObject {name}")
            kind = self.document.only(node)
            if kind.tag == "AddEntityAction":
                self._put(name, self.document.child(kind, "Position"))
            else:
                self.actors.pop(name, None)
        else:
            act_globally(self.document, node, self.values)

    def _advance(self, element: StoryElement, now: Situation) -> None:
        """Start, go on with or end an element and those below it."""
        self.act = element if element.node.tag == "Act" else self.act
        if element.stop.fires(now) and element.state != "complete":
            self._finish(element, "stopTransition")
        if element.node.tag == "Event" and element.state == "running":
            for action in element.children:
                if action.state == "running" and self._done(action):
                    action.finish("endTransition", self.tick)
        if element.state == "standby" and element.node.tag != "Event" and starts_now(element, now):
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
            if event.state != "standby" or event.left < 1 or not starts_now(event, now):
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
            selected = self._selected(event) if event.selects else ()
            for action in event.children:
                self._begin(action, selected)

    def _selected(self, event: StoryElement) -> tuple[str, ...]:
        """The entities that trigger an event, or its act where the event has no trigger on entities."""
        entities = event.start.entities or (self.act.start.entities if self.act else frozenset())
        if not entities:
            rule = "selectTriggeringEntities=true needs a StartTrigger with a ByEntityCondition"
            raise self.document.error(event.node, rule)
        return tuple(sorted(entities))

    def _begin(self, action: StoryElement, selected: tuple[str, ...]) -> None:
        """Begin an action of an event for all its actors, and for the entities that were selected."""
        action.change("running", "startTransition", self.tick)
        kind = self.document.only(action.node)
        if kind.tag == "GlobalAction":
            self._act_globally(kind)
            return
        if kind.tag != "PrivateAction":
            raise self.document.error(kind, "this action is not supported")
        actors = tuple(dict.fromkeys((*action.actors, *selected)))
        if not actors:
            raise self.document.error(kind, "no entity is an actor; name one in Actors")
        self.control.check_action(kind)
        for name in actors:
            if name in self.control.controlled or (
                name not in self.actors and _placing_element(kind) is None
            ):
                continue
            try:
                axes = self._act(name, kind)
            except KeyError as error:
                raise self.document.error(kind, f"there is no {error} on the road") from None
            for axis in axes:
                self.owners[name, axis] = action
        self._hand_over()

    def _courses(self, action: StoryElement) -> Iterator[tuple[str, Axis, AxisCourse]]:
        """The courses of an action that no other one has ended."""
        for (name, axis), owner in self.owners.items():
            if owner is action and name in self.actors:
                yield name, axis, self.actors[name].course(axis)

    def _done(self, action: StoryElement) -> bool:
        time = self.tick / TICKS
        return all(
            x.ended(time, place_along(self.actors[name], time)) for name, _, x in self._courses(action)
        )

    def _finish(self, element: StoryElement, how: str) -> None:
        """End an element; vehicles that its actions move keep their speed, and their d."""
        states = self._states()
        for action in (x for x in element.walk() if x.node.tag == "Action" and x.state == "running"):
            for name, axis, _ in [*self._courses(action)]:
                x = states[name] if self.actors[name].forward else states[name].in_opposite_direction()
                time = self.tick / TICKS
                self._set(
                    name,
                    {
                        axis: ConstantSpeed(time, x.s, x.v_lon)
                        if axis == "along"
                        else ConstantSpeed(time, x.d)
                    },
                )
        element.finish(how, self.tick)


def _placing_element(action: Element) -> Element | None:
    """The element of a PrivateAction that puts a vehicle without place on the road."""
    place = action.find("TeleportAction")
    return action.find(_FOLLOW) if place is None else place
