"""Explains a NONE-WITHIN: parts of a question that conflict, none of which can be left out, and a remedy."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from typing import TypeAlias

from roadproof.engines.encode.build import encode_formula, road_constraints
from roadproof.engines.encode.problem import (
    All,
    Circuit,
    ColumnInequality,
    LimitKind,
    Problem,
    Row,
    Status,
    all_of,
)
from roadproof.engines.modifier import find_modifier
from roadproof.engines.search.question import SearchProblem, pose
from roadproof.engines.search.search import find_witness
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.engines.solve.bounds import TooNonlinearError
from roadproof.engines.solve.milp import column_box, solve_mixed
from roadproof.engines.solve.smt import Session
from roadproof.errors import UsageError
from roadproof.extensions.encoding.naming import Naming, QuestionPart
from roadproof.extensions.encoding.posed import OUTER_PIECES, PosedSearch, posed_searches
from roadproof.extensions.encoding.row_table import CONDITIONS, DefinitionPlace, RowDescriber
from roadproof.extensions.encoding.smt_file import smt_file
from roadproof.logic.formula import And, Application, Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.runtime.budget import Effort
from roadproof.runtime.progress import report_stage
from roadproof.runtime.records import dataclass
from roadproof.world.vehicle import LIMITS

Piece: TypeAlias = Row | Circuit[ColumnInequality]
EACH, EXACT, TRY = 5.0, 20.0, 3.0
"""Units of work for one relaxation, for the exact problem, and for one search with a wider limit."""
FACTORS = (Fraction(5, 4), Fraction(3, 2), Fraction(2), Fraction(4))
"""What limits are multiplied by, one after the other."""
FIRST: Sequence[LimitKind] = (
    LimitKind.LATERAL_SHARE,
    LimitKind.ROAD,
    LimitKind.CLEARANCE,
    LimitKind.REACH,
    LimitKind.ACCELERATION,
)
"""The limits that are left out first, so that those in a conflict are needed."""


@dataclass(frozen=True)
class PartConflict:
    """Parts of a question that have no drive together, under one assignment of ``lanes``.

    ``parts``: each in words. With ``irreducible`` a drive may exist without any one of them.
    """

    lanes: Mapping[str, str]
    parts: tuple[str, ...]
    irreducible: bool


@dataclass(frozen=True)
class NoneWithinExplanation:
    """The conflicts of a question for drives, and the widening of a limit with which there is a drive.

    ``remedy``: an option of the command line or a change of a vehicle model, empty where none helps.
    """

    conflicts: tuple[PartConflict, ...]
    remedy: str = ""
    tried: tuple[str, ...] = field(default=())

    def __str__(self) -> str:
        lines = []
        for x in self.conflicts:
            where = ", ".join(f"{name}={lane}" for name, lane in x.lanes.items())
            needed = "; none can be left out" if x.irreducible else ""
            lines.append(
                f"in conflict{' for ' * bool(where)}{where}, with ranges of places and speeds{needed}:"
            )
            lines += [f"  {part}" for part in x.parts]
        if self.remedy:
            lines.append(f"a drive exists with {self.remedy}")
        elif self.tried:
            lines.append(f"no drive was found with one limit up to {FACTORS[-1]} times as wide")
        return "\n".join(lines)


def explain_none(search: Search) -> NoneWithinExplanation:
    """Return why there is no drive within the limits of a search.

    Raises ``UsageError`` where its relaxation has a solution and the exact problem is not shown to have none.
    """
    posed = posed_searches(search, "outer")
    conflicts = tuple(_conflict(x) for x in posed)
    remedy, tried = _remedy(search, {y for x in posed for y in x.question.vehicles})
    return NoneWithinExplanation(conflicts, remedy, tried)


def _conflict(posed: PosedSearch) -> PartConflict:
    groups = _groups(posed)
    try:
        if _relaxed(posed, groups.values()) == "infeasible":
            return _irreducible(posed, groups)
    except TooNonlinearError:
        pass
    naming = Naming(posed)
    return PartConflict(posed.lanes, tuple(_words(naming, x) for x in _exact_core(naming)), False)


Group: TypeAlias = tuple[tuple[Piece, ...], str]
"""Pieces of a problem, and what they ask for in words."""


def _groups(posed: PosedSearch) -> dict[str, Group]:
    """Return the pieces of a problem by their name: limits first, then the conjuncts of the formula."""
    naming, question = Naming(posed), posed.question
    around = road_constraints(question.road, question.vehicles, posed.layout, posed.assumptions)
    limits: list[tuple[QuestionPart, Piece]] = [
        (naming.part(x.origin), x) for x in posed.problem.rows if x.origin
    ]
    for condition in around:
        conjuncts = condition.parts if isinstance(condition, All) else (condition,)
        parts = naming.parts(condition)
        limits += [(parts[id(x)], x) for x in conjuncts]
    groups: dict[str, Group] = {}
    for part, piece in sorted(limits, key=lambda x: _order(x[0])):
        former, _ = groups.get(part.name, ((), ""))
        groups[part.name] = (*former, piece), _words(naming, part)
    for conjunct, inside in _conjuncts(posed.formula, None):
        circuit = encode_formula(conjunct, question.vehicles, posed.layout, posed.assumptions)
        words = _conjunct_words(naming, conjunct, inside)
        groups[words] = (circuit,), words
    return groups


def _conjuncts(formula: Formula, inside: Application | None) -> Iterator[tuple[Formula, Application | None]]:
    """Yield the conjuncts of a formula, also in definitions, each with the innermost definition around it."""
    match formula:
        case And(parts):
            for part in parts:
                yield from _conjuncts(part, inside)
        case Application(_, _, body):
            yield from _conjuncts(body, formula)
        case _:  # open: whatever else is one conjunct
            yield formula, inside


def _order(part: QuestionPart) -> int:
    """Return the place in which a limit is left out; those in ``FIRST`` come first."""
    return FIRST.index(part.limit) if part.limit in FIRST else len(FIRST)


def _irreducible(posed: PosedSearch, groups: Mapping[str, Group]) -> PartConflict:
    """Return what remains when each part is left out without which the relaxation stays infeasible.

    It is irreducible where the relaxation without each part that remains has a solution.
    """
    left = dict(groups)
    decided = True
    for name in groups:
        report_stage("explain", f"is there a conflict without {name}")
        fewer = {k: x for k, x in left.items() if k != name}
        match _relaxed(posed, fewer.values()):
            case "infeasible":
                left = fewer
            case "found":
                pass
            case "unknown":
                decided = False
    return PartConflict(posed.lanes, tuple(words for _, words in left.values()), decided)


def _relaxed(posed: PosedSearch, groups: Iterable[Group]) -> Status:
    """Return whether the relaxation of some pieces of a problem has a solution."""
    pieces = [piece for some, _ in groups for piece in some]
    rows = tuple(x for x in pieces if isinstance(x, Row))
    circuit = all_of(x for x in pieces if not isinstance(x, Row))
    problem = Problem(posed.problem.columns, rows, circuit)
    meter = Effort(EACH).meter()
    return solve_mixed(problem, column_box(problem), "outer", OUTER_PIECES, meter=meter).status


def _exact_core(naming: Naming) -> list[QuestionPart]:
    """Return the parts in an unsat core of the exact problem. Raises ``UsageError`` where none is found."""
    file = smt_file(naming)
    session = Session()
    session.tell(file.text.removesuffix("(check-sat)\n"))
    if session.check(meter=Effort(EXACT).meter()) != "unsat":
        raise UsageError(
            f"{naming.posed.query.text[:80]}: no solver shows that there is no drive, so nothing is explained"
        )
    core = {*session.core()}
    parts = {part.name: part for name, part in file.assertions if name in core}
    return [*parts.values()]


def _words(naming: Naming, part: QuestionPart) -> str:
    """Return a part in words, with the place of its definition."""
    if part.limit is not None:
        return f"{part.limit} of {' and '.join(part.vehicles)}: {CONDITIONS[part.limit]}"
    return f"{part.name}{_at(RowDescriber(naming.posed).place(part))}"


def _conjunct_words(naming: Naming, conjunct: Formula, inside: Application | None) -> str:
    """Return a conjunct of the formula as text, with the definition that has it."""
    written = text(as_syntax(conjunct))
    if inside is None:
        return written
    return f"{inside.name}{_at(RowDescriber(naming.posed).places.get(inside.name))}: {written}"


def _at(place: DefinitionPlace | None) -> str:
    return "" if place is None else f" ({place.file}, line {place.line})"


def _remedy(search: Search, vehicles: set[str]) -> tuple[str, tuple[str, ...]]:
    """Return the option with the least change under which a drive is found, and all that were tried.

    Nothing is tried where a modifier of the question may object to drives.
    """
    tried: list[str] = []
    if find_modifier(search.specification.options) is not None:
        return "", ()
    for factor in FACTORS:
        for option, setting in _wider(search, sorted(vehicles), factor):
            report_stage("explain", f"is there a drive with {option}")
            tried.append(option)
            if _has_drive(replace(search, setting=setting)):
                return option, tuple(tried)
    return "", tuple(tried)


def _wider(search: Search, vehicles: Sequence[str], factor: Fraction) -> Iterator[tuple[str, Setting]]:
    """Yield options that make one limit wider by a factor, with the setting that they give."""
    place = search.setting
    question = pose(search.specification.library, search.query, place)
    grid = question.grid
    steps = -(-grid.steps * factor // 1)
    yield f"--horizon {steps * grid.dt}", replace(place, horizon=steps * grid.dt, dt=grid.dt)
    if len(vehicles) > 1:
        yield f"--reach {place.reach * factor}", replace(place, reach=place.reach * factor)
    if not place.collisions and len(vehicles) > 1 and factor == FACTORS[0]:
        yield "--allow-collisions", replace(place, collisions=True)
    yield from _wider_vehicles(place, question, vehicles, factor)


def _wider_vehicles(
    place: Setting, question: SearchProblem, vehicles: Sequence[str], factor: Fraction
) -> Iterator[tuple[str, Setting]]:
    for name in vehicles:
        for signal in LIMITS:
            low, high = getattr(question.vehicles[name], signal)
            for end, value in (("min", low), ("max", high)):
                wider = value / factor if end == "min" and value > 0 else value * factor
                if wider != value:
                    limits = {**place.limits, name: {**place.limits.get(name, {}), f"{signal}.{end}": wider}}
                    yield (
                        f"a model of {name} with {signal}.{end}={float(wider):g}",
                        replace(place, limits=limits),
                    )


def _has_drive(search: Search) -> bool:
    try:
        question = pose(search.specification.library, search.query, search.setting)
    except UsageError:  # a limit that no search takes, such as a horizon of too many steps
        return False
    options = SearchOptions("any", effort=Effort(TRY), refinements=0, explain=False)
    return find_witness(question, options).witness is not None
