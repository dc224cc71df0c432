"""Names for columns, rows and choices of a problem, by what they encode.

``POV.s@3`` is a signal at a step, ``motion.POV@3`` a row that moves POV, ``cutIn@3.2`` a comparison of the
definition cutIn, and ``choice.cutIn@3.2`` a part of a disjunction in it. The number after the point tells
names apart that are equal otherwise.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import TypeVar

from roadproof.engines.encode.problem import AnyOf, Circuit, ColumnInequality, Leaf, LimitKind, Origin, nodes
from roadproof.engines.solve.big_m import RowSource
from roadproof.engines.solve.bounds import Bound
from roadproof.extensions.encoding.posed import PosedSearch
from roadproof.logic.formula import NEGATED, Application, Compare, Formula, children
from roadproof.runtime.records import dataclass

T = TypeVar("T", ColumnInequality, Bound)
WHOLE = "formula"
"""The name of what is in no definition."""
DECIDED = "constant"
"""The name of a condition that the bounds of columns decide."""


@dataclass(frozen=True)
class QuestionPart:
    """A part of a question: definitions from the outermost inward, or a kind of limit, and a step.

    ``origin``: the comparison or limit itself, where the part is one row.
    """

    path: tuple[Application | LimitKind, ...]
    step: int
    vehicles: tuple[str, ...] = ()
    origin: Origin | None = None

    @property
    def name(self) -> str:
        """The name of the part, without its step."""
        match self.path[-1] if self.path else None:
            case Application(name):
                return name
            case LimitKind() as limit:
                return ".".join((limit.replace(" ", "_"), *self.vehicles))
            case None:
                return WHOLE

    @property
    def limit(self) -> LimitKind | None:
        """The kind of limit that the part is; None for a part of the formula."""
        last = self.path[-1] if self.path else None
        return last if isinstance(last, LimitKind) else None

    @property
    def definition(self) -> Application | None:
        """The innermost definition around the part; None where there is none."""
        last = self.path[-1] if self.path else None
        return last if isinstance(last, Application) else None


class Naming:
    """Names of the parts of a posed search."""

    def __init__(self, posed: PosedSearch) -> None:
        self.posed = posed

    @cached_property
    def paths(self) -> Mapping[Compare, tuple[Application, ...]]:
        """The definitions around each comparison and its negation, where it occurs first."""
        return comparison_paths(self.posed.formula)

    def part(self, origin: Origin) -> QuestionPart:
        """Return the part of the question that a row encodes."""
        if isinstance(origin.part, LimitKind):
            return QuestionPart((origin.part,), origin.step, origin.vehicles, origin)
        path = self.paths.get(origin.part, ()) if isinstance(origin.part, Compare) else ()
        return QuestionPart(path, origin.step, (), origin)

    def parts(self, circuit: Circuit[T]) -> dict[int, QuestionPart]:
        """Return the part that each node of a circuit encodes, by the identity of the node."""
        known: dict[int, QuestionPart] = {}
        for node in nodes(circuit):
            if isinstance(node, Leaf):
                origin = node.content.origin
                known[id(node)] = QuestionPart((), 0) if origin is None else self.part(origin)
            else:
                known[id(node)] = common([known[id(x)] for x in node.parts])
        return known

    @cached_property
    def unknowns(self) -> tuple[str, ...]:
        """The names of the unknowns of the problem, in the order of its columns."""
        return tuple(str(x.of) for x in self.posed.problem.columns)

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """The names of all columns of the program, unknowns first."""
        program = self.posed.program
        choices = [program.choices[x] for x in program.program.binaries]
        parts = self._bound_parts
        return (*self.unknowns, *numbered(f"choice.{named(parts[id(x)])}" for x in choices))

    @cached_property
    def rows(self) -> tuple[tuple[str, QuestionPart], ...]:
        """The name and the part of each row of the program."""
        parts = [self._row_part(x) for x in self.posed.program.sources]
        stems = (
            f"choose.{named(part)}" if isinstance(source, AnyOf) else named(part)
            for part, source in zip(parts, self.posed.program.sources, strict=True)
        )
        return tuple(zip(numbered(stems), parts, strict=True))

    def _row_part(self, source: RowSource) -> QuestionPart:
        match source:
            case Origin():
                return self.part(source)
            case AnyOf():
                return self._bound_parts[id(source)]
            case None:
                return QuestionPart((), 0)

    @cached_property
    def _bound_parts(self) -> dict[int, QuestionPart]:
        program = self.posed.program
        known: dict[int, QuestionPart] = {}
        disjunctions = [x for x in program.sources if isinstance(x, AnyOf)]
        for node in (*program.choices.values(), *disjunctions):
            if id(node) not in known:
                known |= self.parts(node)
        return known


def common(parts: Sequence[QuestionPart]) -> QuestionPart:
    """Return the part that contains all of some parts, at the earliest of their steps."""
    if not parts:
        return QuestionPart((), 0)
    path = parts[0].path
    for other in parts[1:]:
        same = (one == two for one, two in zip(path, other.path, strict=False))
        path = path[: next((k for k, x in enumerate(same) if not x), min(len(path), len(other.path)))]
    vehicles = parts[0].vehicles if all(x.vehicles == parts[0].vehicles for x in parts) else ()
    return QuestionPart(path, min(x.step for x in parts), vehicles)


def named(part: QuestionPart) -> str:
    """Return the name of a part with its step."""
    return f"{part.name}@{part.step}"


def numbered(stems: Iterable[str]) -> tuple[str, ...]:
    """Return the stems, each with a number after a point where it occurs more than once."""
    listed = tuple(stems)
    several = {name for name, count in Counter(listed).items() if count > 1}
    counts: Counter[str] = Counter()
    names = []
    for name in listed:
        counts[name] += 1
        names.append(f"{name}.{counts[name]}" if name in several else name)
    return tuple(names)


def comparison_paths(formula: Formula) -> dict[Compare, tuple[Application, ...]]:
    """Return the definitions around each comparison of a bound formula, from the outermost inward.

    A comparison that occurs several times has the path of its first occurrence, and its negation the same.
    """
    paths: dict[Compare, tuple[Application, ...]] = {}
    seen: set[int] = set()
    waiting: list[tuple[Formula, tuple[Application, ...]]] = [(formula, ())]
    while waiting:
        part, path = waiting.pop()
        if isinstance(part, Compare):
            paths.setdefault(part, path)
            paths.setdefault(Compare(part.left, NEGATED[part.op], part.right), path)
        elif id(part) not in seen:
            seen.add(id(part))
            inside = (*path, part) if isinstance(part, Application) else path
            waiting.extend((x, inside) for x in reversed(children(part)))
    return paths
