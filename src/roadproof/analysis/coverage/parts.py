"""The parts that a scenario is made of, and the scenario with one of them left out.

Of a disturbance (eq. disturbFormat: initialCondition and behaviourSV and behaviourPOV) every component is
a part, and every condition that a component joins by ``and``, also behind F and before U. Leaving a
part out means putting true in its place, so that what is left holds wherever the scenario does.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from roadproof.library.elaborate import elaborate
from roadproof.library.scenarios import Scenario, applied, is_disturbance
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, is_state, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Claim

Rebuild = Callable[[Formula], Formula]


@dataclass(frozen=True)
class Part:
    """One part of a scenario with two vehicles.

    ``component``: the definition that the template names, such as ``behaviourPOV_4``, and in words
    ``description``. ``condition``: which of its conditions, as text; the whole component where it is
    empty. ``without``: the scenario without the part, about SV, POV and L. ``finest``: whether it has no
    parts itself.
    """

    scenario: int
    component: str
    description: str
    condition: str
    without: Query
    finest: bool

    @property
    def key(self) -> str:
        """A name for the part that no other part of the set has."""
        return f"{self.component}: {self.condition}" if self.condition else self.component


def parts_of(specification: Specification, number: int) -> tuple[Part, ...]:
    """The components of a scenario that are not just true, each followed by its conditions.

    A component with one condition only is a part, its condition is no second one.
    """
    whole = applied(specification, Scenario(number, specification.set_name)).formula
    found: list[Part] = []
    for component, rebuild in _components(whole, number):
        if _body(component) == f.TRUE:
            continue
        description = specification.describe(specification.definitions[component.name])
        leaves = list(_conditions(component.body, rebuild, "", None))
        if len(leaves) > 1:
            leaves.insert(0, ("", rebuild))
        else:
            leaves = [("", rebuild)]
        for shown, put in leaves:
            without = elaborate(specification, Claim((), as_syntax(put(f.TRUE))))
            finest = bool(shown) or len(leaves) == 1
            found.append(Part(number, component.name, description, shown, without, finest))
    return tuple(found)


def _components(whole: Formula, number: int) -> Iterator[tuple[f.Application, Rebuild]]:
    """The conjuncts of the disturbance, each with what puts another formula in its place."""

    def walk(current: Formula, rebuild: Rebuild, inside: bool) -> Iterator[tuple[f.Application, Rebuild]]:
        match current:
            case f.Application(name, _, body) if not inside:
                yield from walk(body, rebuild, is_disturbance(name, number))
            case f.Application():
                yield current, rebuild
            case f.And(parts):
                for place, part in enumerate(parts):
                    yield from walk(part, _inside(current, place, rebuild), inside)
            case _:
                return

    yield from walk(whole, lambda new: new, False)


def _conditions(
    current: Formula, rebuild: Rebuild, where: str, until: f.Until | None
) -> Iterator[tuple[str, Rebuild]]:
    """The conditions below ``current``; ``where`` is the definition around it, ``until`` the U before it."""
    below: list[tuple[str, Rebuild]] = []
    match current:
        case f.And(parts):
            for place, part in enumerate(parts):
                below += _conditions(part, _inside(current, place, rebuild), where, until)
        case f.Application(name, _, body) if not _is_simple(current):
            below += _conditions(body, rebuild, name, until)
        case f.Eventually(_, body) | f.Always(_, body):
            below += _conditions(body, _inside(current, 0, rebuild), where, until)
        case f.Until(left, _, _):
            below += _conditions(left, _inside(current, 0, rebuild), where, current)
        case _:
            pass
    if len(below) > 1:
        yield from below
    else:
        shown = current if until is None else f.Until(current, until.interval, until.right)
        yield text(as_syntax(shown)) + (f" in {where}" if where else ""), rebuild


def _inside(around: Formula, place: int, rebuild: Rebuild) -> Rebuild:
    """Put a formula in the place of one child of ``around``, where true goes away in a conjunction."""
    parts = f.children(around)

    def put(new: Formula) -> Formula:
        changed = (*parts[:place], new, *parts[place + 1 :])
        return rebuild(
            f.conjunction(*changed) if isinstance(around, f.And) else f.with_children(around, changed)
        )

    return put


def _is_simple(formula: f.Application) -> bool:
    """Whether a definition speaks of one instant, and there of lanes only or of numbers only."""
    below = list(subformulas(formula))
    lanes = any(isinstance(x, f.Occupies) for x in below)
    numbers = any(isinstance(x, f.Compare) for x in below)
    return is_state(formula) and not (lanes and numbers)


def _body(formula: Formula) -> Formula:
    while isinstance(formula, f.Application):
        formula = formula.body
    return formula
