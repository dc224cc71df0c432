"""What the viewer in a browser shows, as one plain document: a drive, and formulas that were judged on it.

The viewer (``viewer``) needs nothing else and no server. Distances, danger and truth are the judge's
and the library's; places between the knots of a motion follow from its pieces, which are in the document.
Floats are for drawing; ``exact`` of a part tells its truth with open and closed ends.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from math import ceil, isfinite, lcm, remainder, tau
from typing import TypeAlias, assert_never

from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.evidence.drive_file import DriveFile, drive_data
from roadproof.extensions.drivers.words import words_of_parts
from roadproof.extensions.exchange.export.subject import span_of
from roadproof.extensions.pages import viewer_document as document
from roadproof.extensions.pages.blame import blame
from roadproof.frontends.report.drive_data import GRAIN, Direction, dangers_of, distances_of, vehicles_of
from roadproof.library.bind import bind, values_with
from roadproof.library.scenario_references import read_query
from roadproof.library.scenarios import SUBJECT, scenario_number
from roadproof.library.specification import Library, Query, Specification
from roadproof.library.uses import places_of
from roadproof.library.words import words_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.rewrite import bounds_of, intervals_of
from roadproof.logic.show import as_syntax, text
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.algebraic import approximate
from roadproof.semantics.exact.exact import Judgement, judge
from roadproof.semantics.exact.robust import robustness
from roadproof.semantics.exact.truth import TruthSet
from roadproof.world.length_error import length_error_of
from roadproof.world.motion import starts_of, state_at
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Road

MOST_PARTS = 2000
FINEST = 20  # margins are sampled at most so many times as often as curves
DIGITS = 6
SPACING, BESIDE = 4.0, 300.0  # m between samples of the line of a road, and of it before and after a drive


@dataclass(frozen=True)
class ShownFormula:
    """A formula to be shown on a drive; ``role``: question, watch, before or after.

    ``specification``: the definitions it is read with; the drive's own where None. ``explain``: a part, by
    its place among the parts, and an instant (s) of which is to be said why it is true or false then.
    """

    role: str
    formula: str
    specification: Specification | None = None
    values: Mapping[str, Fraction] = field(default_factory=dict)
    explain: tuple[int, Fraction] | None = None


def viewer_data(file: DriveFile, library: Library, asked: Sequence[ShownFormula] = ()) -> document.Document:
    """The document for a drive; without ``asked`` the formula of the file is shown.

    A formula that cannot be judged on the drive has an ``error`` in place of parts. Raises ``InputError``
    where the file's set or options are unknown.
    """
    home = library.select(file.set_name, file.options)
    every = asked or (ShownFormula("question", file.formula),)
    formulas = [shown_formula(x, file, x.specification or home) for x in every]
    title = file.formula if file.scenario is None else str(words_of(home, file.scenario))
    return document.Document(title, shown_drive(file, library), drive_data(file, {}), formulas)


# --- the drive ----------------------------------------------------------------------------------


def shown_drive(
    file: DriveFile,
    library: Library,
    directions: Sequence[Direction] = ("along", "across"),
    grain: Fraction = GRAIN,
) -> document.DriveView:
    """Road, vehicles by name (SV first) with their states at the knots, and distances every ``grain`` s."""
    return document.DriveView(
        file.set_name,
        float(file.horizon),
        float(grain),
        file.lanes,
        shown_road(file.road, span_of([*file.drive.vehicles.values()], file.horizon)),
        {name: _shown_motion(file, name) for name in vehicles_of(file)},
        [
            document.DistanceView(direction, x.one, x.other, _short(x.gap), _short(x.needed), x.one_behind)
            for direction in directions
            for x in distances_of(file, library, direction, grain)
        ],
        dangers_of(file, library),
    )


def shown_road(road: Road, span: tuple[Fraction | float, Fraction | float]) -> document.RoadView:
    """Lanelets with their extent (m), and the line of a road with bends around a ``span`` along it."""
    error = length_error_of(road)
    return document.RoadView(
        road.name,
        [
            document.LaneletView(
                x.lane, x.zone, [None if y is None else float(y) for y in x.s], [float(y) for y in x.d]
            )
            for x in road.lanelets
        ],
        None if road.line is None else _shown_line(road.line, float(span[0]), float(span[1])),
        None if error is None else document.LengthErrorView(float(100 * error.share), float(error.metres)),
    )


def _shown_line(line: ReferenceLine, low: float, high: float) -> list[list[float]]:
    """Samples of a line, from the first of them on."""
    begin, end = max(low - BESIDE, float(line.begin)), min(high + BESIDE, float(line.end))
    count = max(ceil((end - begin) / SPACING), 1)
    places = [begin + (end - begin) * k / count for k in range(count + 1)]
    poses, samples = [line.pose(s) for s in places], list[list[float]]()
    turned = poses[0].heading
    for k, (s, here) in enumerate(zip(places, poses, strict=True)):
        turned += remainder(here.heading - poses[max(k - 1, 0)].heading, tau)
        samples.append(
            [round(s, 3), round(here.x - poses[0].x, 3), round(here.y - poses[0].y, 3), round(turned, 5)]
        )
    return samples


def _shown_motion(file: DriveFile, name: str) -> document.VehicleView:
    motion = file.drive.vehicles[name]
    knots = [[float(x) for x in vars(state).values()] for state in starts_of(motion)]
    return document.VehicleView(float(motion.length), float(motion.width), knots)


# --- formulas -----------------------------------------------------------------------------------


def shown_formula(asked: ShownFormula, file: DriveFile, home: Specification) -> document.FormulaView:
    """One formula on the drive: its parts with truth and margins, or why it cannot be judged."""
    view = document.FormulaView(asked.role, asked.formula, home.set_name)
    try:
        query, onto = bound_on(asked, file, home)
        judgement = judge(onto(query.formula), file.drive)
        if asked.explain is not None:
            view = _explained(view, judgement, query, onto, home, *asked.explain)
    except RoadproofError as error:
        return replace(view, error=str(error))
    number = scenario_number(query)
    sentence = "" if number is None else words_of(home, number).sentence
    parts, more, step = shown_parts(judgement, file, home)
    return replace(
        view, text=query.text, sentence=sentence, holds=judgement.holds, parts=parts, more=more, step=step
    )


Onto: TypeAlias = Callable[[Formula], Formula]
"""From a formula to what it is on the road of a drive."""


def bound_on(asked: ShownFormula, file: DriveFile, home: Specification) -> tuple[Query, Onto]:
    """The formula that is asked for, and how parts of it are bound to the road of ``file``.

    Free lanes are those of the file, else the one that SV is in at the start. Raises ``TextError``,
    ``InputError``, ``UsageError``.
    """
    query = read_query(home, asked.formula, "formula")[1]
    absent = [name for name in query.vehicles if name not in file.drive.vehicles]
    if absent:
        raise InputError(
            f"{query.text}: mentions {', '.join(absent)}, but the drive has {', '.join(file.drive.vehicles)}"
        )
    lanes = {name: file.lanes.get(name) or _lane_of(file, SUBJECT) for name in query.lanes}
    values = values_with(home.library, {**file.values, **asked.values})
    return query, lambda formula: bind(formula, file.road, lanes, values)


def _explained(
    view: document.FormulaView,
    judgement: Judgement,
    query: Query,
    onto: Onto,
    home: Specification,
    place: int,
    at: Fraction,
) -> document.FormulaView:
    """With ``because`` and ``said`` of the part at a place. Raises ``UsageError`` where there is none."""
    parts = list(subformulas(judgement.formula))[:MOST_PARTS]
    if not 0 <= place < len(parts):
        raise UsageError(f"part={place}: the formula has parts 0 to {len(parts) - 1}")
    found = blame(judgement, parts[place], at)
    because = {str(k): shown_truth(found[x]) for k, x in enumerate(parts) if x in found}
    said = [x for x in places_of(home, query) if isinstance(x.formula, f.Compare | f.Application)]
    said = [x for x in said if _on_road(x.formula, onto) in found]
    return replace(view, because=because, said=said)


def _on_road(formula: Formula, onto: Onto) -> Formula | None:
    """None for what is said of each lanelet, which has no meaning alone."""
    try:
        return onto(formula)
    except InputError:
        return None


def _lane_of(file: DriveFile, name: str) -> str:
    """The lane that the middle of a vehicle is in at the start."""
    motion = file.drive.vehicles.get(name) or next(iter(file.drive.vehicles.values()))
    state = state_at(motion, Fraction(0))
    middle = state.d - motion.width / 2
    for lanelet in file.road.lanelets:
        if lanelet.d[0] <= middle <= lanelet.d[1]:
            return lanelet.lane
    return file.road.lanes[0]


def shown_parts(
    judgement: Judgement, file: DriveFile, home: Specification
) -> tuple[list[document.PartView], int, float]:
    """Every distinct sub-formula once, the whole first; how many were left out; seconds between margins."""
    every = list(subformulas(judgement.formula))
    shown = every[:MOST_PARTS]
    places = {part: k for k, part in enumerate(shown)}
    step, margins = _margins(judgement.formula, file)
    words = words_of_parts(judgement.formula)
    parts = []
    for part in shown:
        truth, says, called = judgement.truth(part), None, None
        if isinstance(part, f.Application):
            definition = home.definitions.get(part.name.partition("@")[0])
            says, called = "" if definition is None else home.describe(definition), words.get(part)
        parts.append(
            document.PartView(
                _operator(part),
                told(part),
                [places[x] for x in f.children(part) if x in places],
                shown_truth(truth),
                exact=str(truth),
                says=says,
                words=called,
                margins=_short(margins[part]) if part in margins else None,
            )
        )
    return parts, len(every) - len(shown), step


def shown_truth(truth: TruthSet) -> list[document.Span]:
    """When something is true."""
    return [
        document.Span(
            approximate(span.begin.point),
            None if span.end is None else approximate(span.end.point),
            not span.begin.after,
            span.end is not None and span.end.after,
        )
        for span in truth.spans()
    ]


def told(part: Formula) -> str:
    """A part as text, definitions by name with the lanes that they are about."""
    if isinstance(part, f.Application):
        return f"{part.name}({', '.join(part.arguments)})"
    return _with_lanes(part, text(as_syntax(_by_name(part))))


def _by_name(part: Formula) -> Formula:
    """As ``part``, with the lanes of roads as names of the language, since others are written out."""

    def rename(one: Formula) -> Formula:
        if isinstance(one, f.Application):
            return f.Application(one.name, tuple(x.replace("-", "_") for x in one.arguments), one.body)
        return one

    return f.transform(part, rename)


def _with_lanes(part: Formula, written: str) -> str:
    """The text with the names that the road gives its lanes."""
    named = {
        x for one in subformulas(part) if isinstance(one, f.Application) for x in one.arguments if "-" in x
    }
    for name in named:
        written = written.replace(name.replace("-", "_"), name)
    return written


def _operator(part: Formula) -> str:
    match part:
        case f.Application():
            return "name"
        case f.And():
            return "and"
        case f.Or():
            return "or"
        case f.Not():
            return "not"
        case f.Eventually():
            return "F"
        case f.Always():
            return "G"
        case f.Until():
            return "U"
        case f.Compare() | f.Occupies() | f.Some() | f.Every():
            return "compare"
        case f.Truth():
            return "truth"
        case _:
            assert_never(part)


def _margins(formula: Formula, file: DriveFile) -> tuple[float, Mapping[Formula, Iterable[float]]]:
    """Margins of all parts, and seconds between them; none where bounds are too fine to be sampled."""
    bounds = (bound for interval in intervals_of(formula) for bound in bounds_of(interval))
    finer = lcm(*((bound / GRAIN).denominator for bound in bounds if bound is not None))
    if finer > FINEST:
        return 0.0, {}
    step = GRAIN / finer
    found = robustness(formula, file.drive, step, int(file.horizon / step) * step)
    return float(step), found.margins


def _short(values: Iterable[float]) -> list[float | None]:
    """As a document has them: few digits, null where there is no number."""
    return [short_number(x) if isfinite(x) else None for x in values]


def short_number(value: float) -> float:
    """With as many digits as a document has them."""
    return float(f"{value:.{DIGITS}g}")
