"""The rules of GSN for a well-formed argument; each mistake names the line of its element and the rule.

SupportedBy leads from goals to goals, strategies and solutions, and from strategies to goals. InContextOf
leads from goals and strategies to contexts, assumptions and justifications.
"""

from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from roadproof.errors import InputError
from roadproof.extensions.assurance.case.case import Element, Kind
from roadproof.library.specification import unknown

SUPPORTS: Mapping[Kind, tuple[Kind, ...]] = {
    Kind.GOAL: (Kind.GOAL, Kind.STRATEGY, Kind.SOLUTION),
    Kind.STRATEGY: (Kind.GOAL,),
}
MOST, DEEPEST = 1000, 60
"""Elements of a case, and elements one below the other."""
CONTEXTS = (Kind.CONTEXT, Kind.ASSUMPTION, Kind.JUSTIFICATION)


def top_goal(elements: Mapping[str, Element], where: str) -> str:
    """The id of the one top goal. Raises ``InputError`` where the case is not well-formed."""
    for element in elements.values():
        for fault in _faults(element, elements):
            raise _error(where, element, fault)
    if circle := _circle(elements):
        raise _error(
            where, elements[circle[0]], f"an argument must not support itself: {' -> '.join(circle)}"
        )
    if len(elements) > MOST:
        raise InputError(f"{where}: {len(elements)} elements (limit {MOST}): divide the case")
    if deep := next((x for x, depth in _depths(elements).items() if depth > DEEPEST), None):
        raise _error(where, elements[deep], f"more than {DEEPEST} elements below each other: divide the case")
    used = {x for e in elements.values() for x in (*e.supported_by, *e.in_context_of)}
    tops = [x for x in elements.values() if x.id not in used]
    goals = [x for x in tops if x.kind is Kind.GOAL]
    for element in tops:
        if element.kind is not Kind.GOAL:
            raise _error(where, element, f"no goal or strategy uses {element.kind} {element.id}")
    if len(goals) > 1:
        told = f"a case has one top goal, but {' and '.join(x.id for x in goals)} support nothing"
        raise _error(where, goals[1], told)
    return goals[0].id


def _error(where: str, element: Element, told: str) -> InputError:
    return InputError(f"{where}, line {element.line}: {told}" if element.line else f"{where}: {told}")


def _faults(element: Element, elements: Mapping[str, Element]) -> Iterator[str]:
    """The rules that an element breaks on its own."""
    named = f"{element.kind} {element.id}"
    for other in (*element.supported_by, *element.in_context_of):
        if other not in elements:
            yield f"{named}: {unknown('element', other, elements)}"
            return
    allowed = SUPPORTS.get(element.kind, ())
    for other in element.supported_by:
        if (kind := elements[other].kind) not in allowed:
            yield f"{named} is supported by {kind} {other}; allowed: {', '.join(allowed) or 'nothing'}"
    for other in element.in_context_of:
        if (kind := elements[other].kind) not in CONTEXTS:
            yield f"{named} is in the context of {kind} {other}; allowed: {', '.join(CONTEXTS)}"
    if element.kind in SUPPORTS and not element.supported_by and not element.undeveloped:
        yield f"{named} has no support: add supported-by, or undeveloped = true"
    if element.undeveloped and element.supported_by:
        yield f"{named} has support and is marked undeveloped: remove undeveloped or supported-by"


def _circle(elements: Mapping[str, Element]) -> tuple[str, ...]:
    """Elements each of which supports the one before, the first of them again at the end; or nothing."""
    try:
        TopologicalSorter({x.id: x.supported_by for x in elements.values()}).prepare()
    except CycleError as error:
        return tuple(reversed(error.args[1]))
    return ()


def _depths(elements: Mapping[str, Element]) -> dict[str, int]:
    """How many elements are one below the other from each element on."""
    found: dict[str, int] = {}
    for name in TopologicalSorter({x.id: x.supported_by for x in elements.values()}).static_order():
        found[name] = 1 + max((found[x] for x in elements[name].supported_by), default=0)
    return found
