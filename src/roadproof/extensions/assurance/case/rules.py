"""Checks the rules of GSN for well-formed arguments; each error message names the line and the rule.

SupportedBy leads from goals to goals, strategies and solutions, and from strategies to goals. InContextOf
leads from goals and strategies to contexts, assumptions and justifications.
"""

from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from roadproof.errors import InputError
from roadproof.extensions.assurance.case.case import CaseElement, ElementKind
from roadproof.library.specification import unknown_name

SUPPORTS: Mapping[ElementKind, tuple[ElementKind, ...]] = {  # partial: GSN lets the others support nothing
    ElementKind.GOAL: (ElementKind.GOAL, ElementKind.STRATEGY, ElementKind.SOLUTION),
    ElementKind.STRATEGY: (ElementKind.GOAL,),
}
MOST, DEEPEST = 1000, 60
"""The largest number of elements of a case, and of elements below each other."""
CONTEXTS = (ElementKind.CONTEXT, ElementKind.ASSUMPTION, ElementKind.JUSTIFICATION)


def top_goal(elements: Mapping[str, CaseElement], where: str) -> str:
    """Return the id of the only top goal. Raises ``InputError`` for a case that is not well-formed."""
    for element in elements.values():
        for fault in _faults(element, elements):
            raise _error(where, element, fault)
    if cycle := _cycle(elements):
        raise _error(where, elements[cycle[0]], f"an argument must not support itself: {' -> '.join(cycle)}")
    if len(elements) > MOST:
        raise InputError(f"{where}: {len(elements)} elements (limit {MOST}): divide the case")
    if deep := next((x for x, depth in _depths(elements).items() if depth > DEEPEST), None):
        raise _error(where, elements[deep], f"more than {DEEPEST} elements below each other: divide the case")
    used = {x for e in elements.values() for x in (*e.supported_by, *e.in_context_of)}
    tops = [x for x in elements.values() if x.id not in used]
    goals = [x for x in tops if x.kind is ElementKind.GOAL]
    for element in tops:
        if element.kind is not ElementKind.GOAL:
            raise _error(where, element, f"no goal or strategy uses {element.kind} {element.id}")
    if len(goals) > 1:
        message = f"a case has one top goal, but {' and '.join(x.id for x in goals)} support nothing"
        raise _error(where, goals[1], message)
    return goals[0].id


def _error(where: str, element: CaseElement, message: str) -> InputError:
    return InputError(f"{where}, line {element.line}: {message}" if element.line else f"{where}: {message}")


def _faults(element: CaseElement, elements: Mapping[str, CaseElement]) -> Iterator[str]:
    """Yield the rules that an element breaks by itself."""
    named = f"{element.kind} {element.id}"
    for other in (*element.supported_by, *element.in_context_of):
        if other not in elements:
            yield f"{named}: {unknown_name('element', other, elements)}"
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


def _cycle(elements: Mapping[str, CaseElement]) -> tuple[str, ...]:
    """Return a cycle of supporting elements, with its first element repeated at the end; empty where there is
    none.
    """
    try:
        TopologicalSorter({x.id: x.supported_by for x in elements.values()}).prepare()
    except CycleError as error:
        return tuple(reversed(error.args[1]))
    return ()


def _depths(elements: Mapping[str, CaseElement]) -> dict[str, int]:
    """Return the length of the longest chain of support below each element, the element included."""
    depths: dict[str, int] = {}
    for name in TopologicalSorter({x.id: x.supported_by for x in elements.values()}).static_order():
        depths[name] = 1 + max((depths[x] for x in elements[name].supported_by), default=0)
    return depths
