"""Builds the document of the drive viewer: a drive, and formulas judged on it, as plain data.

The viewer (``viewer``) needs nothing else and no server. Distances, danger and truth come from the judge and
the library; places between the knots of a motion follow from its pieces, which are in the document. Floats
are for drawing; ``exact`` of a part states its truth with open and closed ends.
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
from roadproof.extensions.pages.drive_data import GRAIN, Direction, dangers_of, distances_of, vehicles_of
from roadproof.extensions.pages.places import places_of
from roadproof.extensions.traffic.evaluate.robust import robustness
from roadproof.library.bind import bind, values_with
from roadproof.library.scenario_references import read_query
from roadproof.library.scenarios import SUBJECT, scenario_number
from roadproof.library.specification import Library, Query, Specification
from roadproof.library.words import words_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import bounds_of, intervals_of
from roadproof.logic.show import text
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import Judgement, judge
from roadproof.semantics.exact.truth import TruthSet
from roadproof.world.length_error import length_error_of
from roadproof.world.motion import piece_starts, state_at
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Road

MOST_PARTS = 2000
FINEST = 20  # margins are sampled at most so many times as often as curves
DIGITS = 6
SPACING, BESIDE = 4.0, 300.0  # m between samples of the line of a road, and of it before and after a drive


@dataclass(frozen=True)
class ShownFormula:
    """A formula to show on a drive; ``role``: question, watch, before or after.

    ``specification``: its definitions, those of the drive where None. ``explain``: a part, by its index among
    the parts, and an instant (s) at which its value is to be explained.
    """

    role: str
    formula: str
    specification: Specification | None = None
    values: Mapping[str, Fraction] = field(default_factory=dict)
    explain: tuple[int, Fraction] | None = None


def viewer_data(
    file: DriveFile, library: Library, shown_formulas: Sequence[ShownFormula] = ()
) -> document.ViewerDocument:
    """Return the document for a drive; without ``shown_formulas`` it shows the formula of the file.

    A formula that cannot be judged on the drive has an ``error`` instead of parts. Raises ``InputError``
    where the file's set or options are unknown.
    """
    home = library.select(file.set_name, file.options)
    every = shown_formulas or (ShownFormula("question", file.formula),)
    formulas = [formula_view(x, file, x.specification or home) for x in every]
    title = _title_of(shown_formulas[0], home) if shown_formulas else _scenario_title(file, home)
    return document.ViewerDocument(title, drive_view(file, library), drive_data(file, {}), formulas)


# --- the drive ----------------------------------------------------------------------------------


def drive_view(
    file: DriveFile,
    library: Library,
    directions: Sequence[Direction] = ("along", "across"),
    grain: Fraction = GRAIN,
) -> document.DriveView:
    """Return road, vehicles by name (SV first) with their states at the knots, and distances every ``grain``
    s.
    """
    return document.DriveView(
        file.set_name,
        float(file.horizon),
        float(grain),
        file.lanes,
        road_view(file.road, span_of([*file.drive.vehicles.values()], file.horizon)),
        {name: _vehicle_view(file, name) for name in vehicles_of(file)},
        [
            document.DistanceView(
                direction, x.one, x.other, _short_numbers(x.gap), _short_numbers(x.needed), x.one_behind
            )
            for direction in directions
            for x in distances_of(file, library, direction, grain)
        ],
        dangers_of(file, library),
    )


def road_view(road: Road, span: tuple[Fraction | float, Fraction | float]) -> document.ViewerRoad:
    """Return lanelets with their extent (m), and the line of a road with bends around a ``span`` along it."""
    error = length_error_of(road)
    return document.ViewerRoad(
        road.name,
        [
            document.LaneletView(
                x.lane, x.zone, [None if y is None else float(y) for y in x.s], [float(y) for y in x.d]
            )
            for x in road.lanelets
        ],
        None if road.line is None else _line_samples(road.line, float(span[0]), float(span[1])),
        None if error is None else document.LengthErrorView(float(100 * error.share), float(error.metres)),
    )


def _line_samples(line: ReferenceLine, low: float, high: float) -> list[list[float]]:
    """Return samples (s, x, y, heading) of a reference line, with x and y relative to the first sample."""
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


def _vehicle_view(file: DriveFile, name: str) -> document.VehicleView:
    motion = file.drive.vehicles[name]
    knots = [[float(x) for x in vars(state).values()] for state in piece_starts(motion)]
    return document.VehicleView(float(motion.length), float(motion.width), knots)


def _scenario_title(file: DriveFile, home: Specification) -> str:
    """Return the scenario of a drive in words, or its formula."""
    return file.formula if file.scenario is None else str(words_of(home, file.scenario))


def _title_of(shown: ShownFormula, home: Specification) -> str:
    """Return the scenario that a shown formula is in words, or the formula."""
    where = shown.specification or home
    try:
        query = read_query(where, shown.formula, "formula")[1]
    except RoadproofError:
        return shown.formula
    number = scenario_number(query)
    return query.text if number is None else str(words_of(where, number))


# --- formulas -----------------------------------------------------------------------------------


def formula_view(shown: ShownFormula, file: DriveFile, home: Specification) -> document.FormulaView:
    """Return a formula on the drive: its parts with truth and margins, or why it cannot be judged."""
    view = document.FormulaView(shown.role, shown.formula, home.set_name)
    try:
        query, bind_part = bound_on(shown, file, home)
        judgement = judge(bind_part(query.formula), file.drive)
        if shown.explain is not None:
            view = _with_explanation(view, judgement, query, bind_part, home, *shown.explain)
    except RoadproofError as error:
        return replace(view, error=str(error))
    number = scenario_number(query)
    sentence = "" if number is None else words_of(home, number).sentence
    parts, more, step = part_views(judgement, file, home)
    return replace(
        view, text=query.text, sentence=sentence, holds=judgement.holds, parts=parts, more=more, step=step
    )


PartBinder: TypeAlias = Callable[[Formula], Formula]
"""A function that binds a formula to the road of a drive."""


def bound_on(shown: ShownFormula, file: DriveFile, home: Specification) -> tuple[Query, PartBinder]:
    """Return the query of a formula, and a function that binds its parts to the road of ``file``.

    Free lanes are those of the file, else the one that SV is in at the start. Raises ``TextError``,
    ``InputError``, ``UsageError``.
    """
    query = read_query(home, shown.formula, "formula")[1]
    absent = [name for name in query.vehicles if name not in file.drive.vehicles]
    if absent:
        raise InputError(
            f"{query.text}: mentions {', '.join(absent)}, but the drive has {', '.join(file.drive.vehicles)}"
        )
    lanes = {name: file.lanes.get(name) or _lane_of(file, SUBJECT) for name in query.lanes}
    values = values_with(home.library, {**file.values, **shown.values})
    return query, lambda formula: bind(formula, file.road, lanes, values)


def _with_explanation(
    view: document.FormulaView,
    judgement: Judgement,
    query: Query,
    bind_part: PartBinder,
    home: Specification,
    place: int,
    at: Fraction,
) -> document.FormulaView:
    """Return the view with ``because`` and ``said`` for a part. Raises ``UsageError`` for an index without
    part.
    """
    parts = list(subformulas(judgement.formula))[:MOST_PARTS]
    if not 0 <= place < len(parts):
        raise UsageError(f"part={place}: the formula has parts 0 to {len(parts) - 1}")
    explained = blame(judgement, parts[place], at)
    because = {str(k): truth_spans(explained[x]) for k, x in enumerate(parts) if x in explained}
    places = [x for x in places_of(home, query) if isinstance(x.formula, f.Compare | f.Application)]
    places = [x for x in places if _on_road(x.formula, bind_part) in explained]
    return replace(view, because=because, said=places)


def _on_road(formula: Formula, bind_part: PartBinder) -> Formula | None:
    """Return a formula bound to the road; None for one about each lanelet, which has no meaning alone."""
    try:
        return bind_part(formula)
    except InputError:
        return None


def _lane_of(file: DriveFile, name: str) -> str:
    """Return the lane that the middle of a vehicle is in at the start."""
    motion = file.drive.vehicles.get(name) or next(iter(file.drive.vehicles.values()))
    state = state_at(motion, Fraction(0))
    middle = state.d - motion.width / 2
    for lanelet in file.road.lanelets:
        if lanelet.d[0] <= middle <= lanelet.d[1]:
            return lanelet.lane
    return file.road.lanes[0]


def part_views(
    judgement: Judgement, file: DriveFile, home: Specification
) -> tuple[list[document.PartView], int, float]:
    """Return every distinct sub-formula once, the whole first; the number left out; seconds
    between margins.
    """
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
                part_text(part),
                [places[x] for x in f.children(part) if x in places],
                truth_spans(truth),
                exact=str(truth),
                says=says,
                words=called,
                margins=_short_numbers(margins[part]) if part in margins else None,
            )
        )
    return parts, len(every) - len(shown), step


def truth_spans(truth: TruthSet) -> list[document.TruthSpan]:
    """Return the spans in which something is true."""
    return [
        document.TruthSpan(
            as_float(span.begin.point),
            None if span.end is None else as_float(span.end.point),
            not span.begin.after,
            span.end is not None and span.end.after,
        )
        for span in truth.spans()
    ]


def part_text(part: Formula) -> str:
    """Return a part as text; definitions are named with the lanes that they are about."""
    if isinstance(part, f.Application):
        return f"{part.name}({', '.join(part.arguments)})"
    return _with_lanes(part, text(as_syntax(_by_name(part))))


def _by_name(part: Formula) -> Formula:
    """Return ``part`` with lane names that are valid in the language, so that it can be written as text."""

    def rename(one: Formula) -> Formula:
        if isinstance(one, f.Application):
            return f.Application(one.name, tuple(x.replace("-", "_") for x in one.arguments), one.body)
        return one

    return f.transform(part, rename)


def _with_lanes(part: Formula, written: str) -> str:
    """Return the text with the road's own names of lanes."""
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
        case f.Since():
            return "S"
        case f.Compare() | f.Occupies() | f.Some() | f.Every():
            return "compare"
        case f.Truth():
            return "truth"
        case _:
            assert_never(part)


def _margins(formula: Formula, file: DriveFile) -> tuple[float, Mapping[Formula, Iterable[float]]]:
    """Return the seconds between margins, and the margins of all parts; none where bounds are too fine to
    sample.
    """
    bounds = (bound for interval in intervals_of(formula) for bound in bounds_of(interval))
    finer = lcm(*((bound / GRAIN).denominator for bound in bounds if bound is not None))
    if finer > FINEST:
        return 0.0, {}
    step = GRAIN / finer
    robust = robustness(formula, file.drive, step, int(file.horizon / step) * step)
    return float(step), robust.margins


def _short_numbers(values: Iterable[float]) -> list[float | None]:
    """Return numbers with few digits; None for infinities and NaN."""
    return [short_number(x) if isfinite(x) else None for x in values]


def short_number(value: float) -> float:
    """Return a number with ``DIGITS`` significant digits."""
    return float(f"{value:.{DIGITS}g}")
