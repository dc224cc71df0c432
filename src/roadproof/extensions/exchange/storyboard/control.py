"""Vehicles that controllers move: from then on, the file does not say where they are.

A controller moves a vehicle from when it is activated along or across the road, by ActivateControllerAction
or by AssignControllerAction. One that is assigned counts as activated unless the action says false of both.
OverrideControllerValueAction with an active pedal or wheel does the same.
"""

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.controllers import ReactiveCourse, SynchronizedArrival
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.maps.xml_reader import Element

REMEDY = "take the controller out of the file to read the vehicle as the storyboard moves it"
_ACTIONS = ("ControllerAction", "ActivateControllerAction")
_DOMAINS = ("Lateral", "Longitudinal")


class Control:
    """The vehicles that a controller moves; ``controlled``: from when on, by name, in words."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.controlled: dict[str, str] = {}

    def takes(self, name: str, action: Element, time: float) -> bool:
        """Return whether an action is about controllers, of which one may move a vehicle from ``time`` (s)
        on.
        """
        node = next((x for x in action if x.tag in _ACTIONS), None)
        if node is None:
            return False
        node.note()
        for kind in [node] if node.tag == _ACTIONS[1] else [*node]:
            kind.note()
            if self._moves(kind):
                self.controlled.setdefault(name, f"which a controller moves from {time:g} s on ({kind.tag})")
                kind.read_all()
        return True

    def _moves(self, node: Element) -> bool:
        document = self.document
        match node.tag:
            case "ActivateControllerAction":
                return any(document.flag(node, x.lower()) for x in _DOMAINS)
            case "AssignControllerAction":
                moves = any(document.flag(node, f"activate{x}", True) for x in _DOMAINS)
                for controller in node if not moves else ():
                    controller.read_all()  # it is never activated
                return moves
            case "OverrideControllerValueAction":
                moves = any(document.flag(x, "active") for x in node)
                for pedal in node if not moves else ():
                    pedal.read_all()  # it is not active
                return moves
        raise document.error(node, "this action is not supported")

    def check_course(self, name: str, course: ReactiveCourse) -> None:
        """Raise ``InputError`` where a vehicle reacts to one that a controller moves."""
        other = course.other if isinstance(course, SynchronizedArrival) else course.goal.other
        if other in self.controlled:
            problem = f"{name} reacts to {other}, {self.controlled[other]}"
            raise InputError(f"{self.document.path}: {problem}; {REMEDY}")

    def check_action(self, action: Element) -> None:
        """Raise ``InputError`` where an action refers to a vehicle that a controller moves."""
        for node in action.iter():
            for name in (node.peek("entityRef"), node.peek("masterEntityRef")):
                if name in self.controlled:
                    raise self.document.error(node, f"it refers to {name}, {self.controlled[name]}; {REMEDY}")
