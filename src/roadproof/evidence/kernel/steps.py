"""Steps of a proof as the search makes them, and the same numbered as Tableau.v numbers them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.evidence.kernel.linear import GOAL, Witness
from roadproof.evidence.kernel.tableau import Argument, Node
from roadproof.evidence.times import Moment


@dataclass(frozen=True)
class Step:
    """A rule of the tableau, with facts and constraints by their numbers in the search.

    ``new``: a moment that it names; ``added``: numbers of facts and of constraints that each child has.
    """

    rule: str
    arguments: tuple["int | str | Moment | Witness", ...]
    children: tuple["Step", ...] = ()
    added: tuple[tuple[tuple[int, ...], tuple[int, ...]], ...] = ()
    new: str = ""


def numbered(step: Step, root: int, bounds: Sequence[int], parameters: Sequence[str]) -> Iterator[Node]:
    """The nodes of a tableau: facts, constraints and moments are numbered as a branch comes to have them.

    ``root`` is the fact that it begins with; ``bounds``: the constraints on parameters, in their order.
    """
    # Tableau.v counts from the end of a list, and has bounds in their order.
    constraints = {number: place for place, number in enumerate(reversed(bounds))}
    times = {name: place for place, name in enumerate(parameters, 1)}
    yield from _nodes(step, {root: 0}, 1, constraints, len(constraints), times, len(times) + 1)


def _nodes(
    step: Step,
    facts: Mapping[int, int],
    facts_count: int,
    constraints: Mapping[int, int],
    constraints_count: int,
    times: Mapping[str, int],
    next_time: int,
) -> Iterator[Node]:
    known = dict(times)
    for argument in step.arguments:
        if isinstance(argument, Moment):
            for name, _ in argument.parts:
                if name not in known:  # a moment whose origin was not needed: any time will do
                    known[name] = next_time
                    next_time += 1
    arguments: list[Argument] = []
    for place, argument in enumerate(step.arguments):
        if isinstance(argument, Moment):
            arguments.append(_row(argument, known))
        elif isinstance(argument, tuple):
            arguments.append(
                tuple((constraints_count if i == GOAL else constraints[i], q) for i, q in argument)
            )
        elif isinstance(argument, int) and not (step.rule == "Fact" and place == 0):
            arguments.append(facts[argument])
        else:
            arguments.append(argument)
    inside = dict(known)
    if step.new:
        arguments.append(next_time)
        inside[step.new] = next_time
    yield Node(step.rule, tuple(arguments))
    for place, (child, (new_facts, new_constraints)) in enumerate(
        zip(step.children, step.added, strict=True)
    ):
        names_it = bool(step.new) and (step.rule == "New" or place == 1)
        yield from _nodes(
            child,
            {**facts, **{number: facts_count + k for k, number in enumerate(new_facts)}},
            facts_count + len(new_facts),
            {
                **constraints,
                **{number: constraints_count + k for k, number in enumerate(new_constraints)},
            },
            constraints_count + len(new_constraints),
            inside if names_it else known,
            next_time + names_it,
        )


def _row(moment: Moment, times: Mapping[str, int]) -> tuple[Fraction, ...]:
    if not moment.parts and not moment.constant:
        return ()
    row = [moment.constant] + [Fraction(0)] * max((times[name] for name, _ in moment.parts), default=0)
    for name, factor in moment.parts:
        row[times[name]] = factor
    return tuple(row)
