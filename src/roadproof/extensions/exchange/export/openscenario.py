"""A drive in OpenSCENARIO XML 1.2, on its road in OpenDRIVE: every vehicle follows a polyline in time.

A vehicle's reference point is its rear axle, and its box is turned as it moves. Times are absolute
(``domainAbsoluteRelative``), so a player is where the drive is at every instant.

Vertices of a drive so dense that straight lines between them stay within a bound of it.

The box's centre c has c'' = a, and a line between two of its points, h seconds apart, is nowhere further from
it than |a|·h²/8 with the greatest |a| between them, which is that at one of them, since a is linear there.
The vertices are of the rear axle, r = c - l·e(θ) with the heading θ of the motion, v = |c'|,
n = v_lon·a_lat - v_lat·a_lon and n' = -v_lat·j with the jerk j along: θ' = n/v² and
|θ''| ≤ |n'|/v² + 2·|n|·|a|/v³, so |r''| ≤ |a| + l·(|θ''| + θ'²). The heading between vertices is interpolated
too, which moves the centre by l·|θ''|·h²/8 at most. All together: h²/8·(|a| + l·(2·|θ''| + θ'²)), for the
axle and for the centre, each with the greatest value between the vertices or more. A heading is nowhere
greater than at a vertex by more than |θ''|·h²/8, and not at all where n keeps its sign, as without jerk.

On a road with a reference line the bound is a fifth more than the distances at seven instants between two
vertices, as they may be greater between, where the line is one of straight lines.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.extensions.exchange.export import opendrive
from roadproof.extensions.exchange.export.points import OVERHANG, axle_to_centre, heading, rear_axle_in_plane
from roadproof.extensions.exchange.export.subject import WRITTEN, ExportSubject, monotone_starts
from roadproof.extensions.exchange.export.user_map import map_path
from roadproof.extensions.maps.selection import STRETCH
from roadproof.extensions.maps.xml_writer import Element, document, element
from roadproof.frontends.report.numbers import decimal
from roadproof.frontends.report.samples import kind_of
from roadproof.world.drive import Motion
from roadproof.world.motion import State, advance
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Road
from roadproof.world.signals import Kind

WITHIN = 0.0099
"""Metres: a centimetre, with room for the rounding of floats, which ``ROUNDING`` is above."""
ROUNDING = 1e-6
_SHORTEST = Fraction(1, 1024)
_SAME = 1e-9
_INSTANTS = 8
BETWEEN = 1.2


@dataclass(frozen=True)
class TimedPolyline:
    """States and headings (rad) at the vertices, and how far (m) lines between them are from the drive.

    ``turned``: no heading of the drive is greater, to either side. ``accelerations``: along the road (m/s²)
    among which are the least and the greatest.
    """

    vertices: tuple[State, ...]
    headings: tuple[float, ...]
    bound: float
    turned: float
    accelerations: tuple[Fraction, ...]


def polyline_of(
    motion: Motion, horizon: Fraction, within: float = WITHIN, line: ReferenceLine | None = None
) -> TimedPolyline:
    """Vertices from time 0 to ``horizon``, at every change of acceleration and as many between as needed.

    There is one where the speed along is least or greatest, so that it is nowhere below 0 if it is so at none
    of them. Raises ``InputError`` for a vehicle that does not drive forwards, or turns where it all but
    stands: its heading has no bound.
    """
    starts = [x for x in monotone_starts(motion) if x.time < horizon]
    ends = [x.time for x in starts[1:]] + [horizon]
    parts = [
        part
        for start, end in zip(starts, ends, strict=True)
        for part in _segments(start, end - start.time, motion, within, line)
    ]
    vertices = (*(x.begin for x in parts), parts[-1].end)
    headings = _headings(vertices)
    swings = [x.swing for x in parts]
    return TimedPolyline(
        vertices,
        tuple(headings),
        max(x.bound for x in parts),
        max(abs(x) + y for k, x in enumerate(headings) for y in swings[max(0, k - 1) : k + 1]),
        tuple(pull for x in parts for pull in (x.begin.a_lon, x.end.a_lon)),
    )


def _headings(vertices: Sequence[State]) -> list[float]:
    """Return headings; at rest the one before, or after where there is none before. Raises ``InputError``."""
    for state in vertices:
        if state.v_lon < 0 or (state.v_lon == 0 and state.v_lat != 0):
            raise InputError(
                f"at {float(state.time):g} s a vehicle has v_lon={float(state.v_lon):g} m/s: other tools "
                "want vehicles that drive forwards; end the drive before"
            )
    directions = [heading(x) for x in vertices]
    first = next((x for x in directions if x is not None), 0.0)
    headings: list[float] = []
    for state, turned, following in zip(vertices, directions, [*directions[1:], None], strict=True):
        headings.append(turned if turned is not None else headings[-1] if headings else first)
        if turned is None and following is not None and abs(following - headings[-1]) > _SAME:
            raise _turn_error(state)
    return headings


def _turn_error(state: State) -> InputError:
    return InputError(
        f"a vehicle turns where it all but stands, at {float(state.time):g} s: it has no heading there; "
        "end the drive before"
    )


@dataclass(frozen=True)
class _PolylineSegment:
    """A segment between two vertices. ``bound``: the largest error (m); ``swing``: how much greater than at
    both a heading (rad) may be between them.
    """

    begin: State
    duration: Fraction
    bound: float
    swing: float

    @property
    def end(self) -> State:
        return advance(self.begin, self.duration)


def _segments(
    state: State, duration: Fraction, motion: Motion, within: float, line: ReferenceLine | None
) -> Iterator[_PolylineSegment]:
    """Parts of a stretch in which the speed along grows or falls, halved until the bound is small enough."""
    part = _segment(state, duration, motion.length)
    if line is not None and part.bound <= within:
        part = replace(part, bound=max(part.bound, BETWEEN * _largest_gap(part, motion, line)))
    if part.bound <= within:
        yield part
        return
    if duration <= _SHORTEST:
        raise _turn_error(state)
    yield from _segments(state, duration / 2, motion, within, line)
    yield from _segments(advance(state, duration / 2), duration / 2, motion, within, line)


def _largest_gap(part: _PolylineSegment, motion: Motion, line: ReferenceLine) -> float:
    """Return the largest distance (m) of rear axle and centre from straight lines, at seven instants."""
    ends = part.begin, part.end
    first, last = (rear_axle_in_plane(x, motion, heading(x) or 0.0, line) for x in ends)
    turn = math.remainder(last[2] - first[2], math.tau)
    ahead = float(axle_to_centre(motion.length))
    furthest = 0.0
    for k in range(1, _INSTANTS):
        state = advance(part.begin, part.duration * k / _INSTANTS)
        x, y, turned = rear_axle_in_plane(state, motion, heading(state) or 0.0, line)
        share = k / _INSTANTS
        x1, y1 = first[0] + share * (last[0] - first[0]), first[1] + share * (last[1] - first[1])
        swung = abs(math.remainder(turned - first[2] - share * turn, math.tau))
        furthest = max(furthest, math.hypot(x - x1, y - y1) + ahead * swung)
    return furthest


def _segment(state: State, duration: Fraction, length: Fraction) -> _PolylineSegment:
    """The part of ``duration`` seconds from ``state`` on; its bound is infinite where there is no heading."""
    end = advance(state, duration)
    pull = max(math.hypot(x.a_lon, x.a_lat) for x in (state, end))
    swerving = float(abs(state.j_lon) * max(abs(state.v_lat), abs(end.v_lat)))
    turning = abs(float(state.v_lon * state.a_lat - state.v_lat * state.a_lon)) + float(duration) * swerving
    rate = bend = 0.0
    if turning or swerving:
        slowest = _slowest(state, end)
        if slowest <= 0:
            return _PolylineSegment(state, duration, math.inf, math.inf)
        rate = turning / slowest**2
        bend = 2 * turning * pull / slowest**3 + swerving / slowest**2
    eighth = float(duration) ** 2 / 8
    bound = eighth * (pull + float(axle_to_centre(length)) * (2 * bend + rate**2))
    return _PolylineSegment(state, duration, bound, eighth * bend if swerving else 0.0)


def _slowest(state: State, end: State) -> float:
    """The least speed (m/s) from ``state`` to ``end``, or less where there is jerk."""
    if state.j_lon != 0:
        return float(min(state.v_lon, end.v_lon))
    square = state.a_lon**2 + state.a_lat**2
    along = state.v_lon * state.a_lon + state.v_lat * state.a_lat
    time = min(max(-along / square, Fraction(0)), end.time - state.time)
    there = advance(state, time)
    return math.hypot(there.v_lon, there.v_lat)


HEIGHT = Fraction(3, 2)
WHEEL = Fraction(3, 5)
"""Metres: the height of the box and the diameter of the wheels, which our vehicles do not have."""

# Kinds that OpenSCENARIO calls otherwise; a van is read back as what is none of the other kinds.
_CATEGORIES: Mapping[Kind, str] = {"motorcycle": "motorbike", "other": "van"}


def files(subject: ExportSubject) -> dict[str, bytes]:
    """NAME.xosc, and NAME.xodr, which it names. Raises ``InputError``."""
    return {f"{subject.name}.xosc": scenario_file(subject), **opendrive.files(subject)}


def scenario_file(subject: ExportSubject) -> bytes:
    """The drive; its heading says how far from it straight lines between vertices are."""
    horizon, road = subject.file.horizon, subject.file.road
    lines = {
        name: polyline_of(motion, horizon, WITHIN, road.line) for name, motion in subject.vehicles.items()
    }
    header = element(
        "FileHeader",
        revMajor="1",
        revMinor="2",
        date=f"{WRITTEN}T00:00:00",
        description=_file_description(subject, lines),
        author="roadproof",
    )
    network = element("RoadNetwork", element("LogicFile", filepath=opendrive.file_name(subject)))
    entities = [
        element("ScenarioObject", _vehicle(motion, lines[name]), name=name)
        for name, motion in subject.vehicles.items()
    ]
    story = element("Story", _act(subject, lines), name="drive")
    actions = [_init(name, motion, lines[name], road.line) for name, motion in subject.vehicles.items()]
    board = element(
        "Storyboard",
        element("Init", element("Actions", *actions)),
        story,
        element("StopTrigger", _time_condition(horizon, "end")),
    )
    declared = element("ParameterDeclarations", *_stretch(road))
    root = element("OpenSCENARIO", header, declared, element("CatalogLocations"))
    root.extend([network, element("Entities", *entities), board])
    return document(root)


def _stretch(road: Road) -> Iterator[Element]:
    """The stretch of the map, which a player does not need and a reader of s and d does."""
    _, _, chosen = (road.map or "").partition("#")
    if chosen and map_path(road, opendrive.ENDING) is not None:
        yield element("ParameterDeclaration", name=STRETCH, parameterType="string", value=chosen)


def _file_description(subject: ExportSubject, lines: dict[str, TimedPolyline]) -> str:
    bound = math.ceil(max(x.bound + ROUNDING for x in lines.values()) * 10_000) / 10_000
    turned = max(_corner_offset(subject.vehicles[name], line) for name, line in lines.items())
    return (
        f"{subject.formula_note}; straight lines between vertices are within {bound:.4f} m of the drive; "
        f"boxes are turned as they move, their corners up to {turned:.3f} m from those of the boxes "
        "that were judged, which are aligned with the road"
    )


def _corner_offset(motion: Motion, line: TimedPolyline) -> float:
    """Return how far a corner of the turned box is from that of the aligned one at most."""
    return 2 * math.sin(line.turned / 2) * math.hypot(motion.length, motion.width) / 2


def _vehicle(motion: Motion, line: TimedPolyline) -> Element:
    box = element(
        "BoundingBox",
        element("Center", x=decimal(axle_to_centre(motion.length)), y="0", z=decimal(HEIGHT / 2)),
        element(
            "Dimensions", width=decimal(motion.width), length=decimal(motion.length), height=decimal(HEIGHT)
        ),
    )
    accelerations = [float(x) for x in line.accelerations]
    performance = element(
        "Performance",
        maxSpeed=decimal(max(x.v_lon for x in line.vertices) + 10),
        maxAcceleration=decimal(max(10.0, *accelerations)),
        maxDeceleration=decimal(max(10.0, *(-x for x in accelerations))),
    )
    wheelbase = motion.length * (1 - 2 * OVERHANG)
    axles = element("Axles", _axle("FrontAxle", motion, wheelbase), _axle("RearAxle", motion, Fraction(0)))
    kind = kind_of(motion)
    category = _CATEGORIES.get(kind, kind)
    return element(
        "Vehicle", box, performance, axles, element("Properties"), name="box", vehicleCategory=category
    )


def _axle(tag: str, motion: Motion, place: Fraction) -> Element:
    return element(
        tag,
        maxSteering="0.5" if place else "0",
        wheelDiameter=decimal(WHEEL),
        trackWidth=decimal(motion.width),
        positionX=decimal(place),
        positionZ=decimal(WHEEL / 2),
    )


def _init(name: str, motion: Motion, line: TimedPolyline, road: ReferenceLine | None) -> Element:
    first = line.vertices[0]
    begin = _position(first, line.headings[0], motion, road)
    place = element("PrivateAction", element("TeleportAction", begin))
    step = element("SpeedActionDynamics", dynamicsShape="step", value="0", dynamicsDimension="time")
    speed = decimal(math.hypot(first.v_lon, first.v_lat))
    target = element("SpeedActionTarget", element("AbsoluteTargetSpeed", value=speed))
    moving = element("LongitudinalAction", element("SpeedAction", step, target))
    return element("Private", place, element("PrivateAction", moving), entityRef=name)


def _position(state: State, turned: float, motion: Motion, road: ReferenceLine | None) -> Element:
    x, y, heading = rear_axle_in_plane(state, motion, turned, road)
    return element("Position", element("WorldPosition", x=decimal(x), y=decimal(y), h=decimal(heading)))


def _act(subject: ExportSubject, lines: dict[str, TimedPolyline]) -> Element:
    road = subject.file.road.line
    groups = [_group(name, motion, lines[name], road) for name, motion in subject.vehicles.items()]
    start = element("StartTrigger", _time_condition(Fraction(0), "begin"))
    return element("Act", *groups, start, name="all")


def _group(name: str, motion: Motion, line: TimedPolyline, road: ReferenceLine | None) -> Element:
    actors = element("Actors", element("EntityRef", entityRef=name), selectTriggeringEntities="false")
    follow = _follow(name, motion, line, road)
    action = element("Action", element("PrivateAction", follow), name=f"{name} follows")
    start = element("StartTrigger", _time_condition(Fraction(0), f"{name} begins"))
    event = element("Event", action, start, name=f"{name} drives", priority="override")
    manoeuvre = element("Maneuver", event, name=f"{name} moves")
    return element("ManeuverGroup", actors, manoeuvre, name=f"{name} acts", maximumExecutionCount="1")


def _follow(name: str, motion: Motion, line: TimedPolyline, road: ReferenceLine | None) -> Element:
    vertices = [
        element("Vertex", _position(state, turned, motion, road), time=decimal(state.time))
        for state, turned in zip(line.vertices, line.headings, strict=True)
    ]
    shape = element("Shape", element("Polyline", *vertices))
    way = element("Trajectory", shape, name=f"way of {name}", closed="false")
    timing = element("Timing", domainAbsoluteRelative="absolute", scale="1", offset="0")
    mode = element("TrajectoryFollowingMode", followingMode="position")
    reference = element("TrajectoryRef", way)
    follow = element("FollowTrajectoryAction", reference, element("TimeReference", timing), mode)
    return element("RoutingAction", follow)


def _time_condition(time: Fraction, name: str) -> Element:
    """A condition that is met from ``time`` on."""
    clock = element("SimulationTimeCondition", value=decimal(time), rule="greaterOrEqual")
    condition = element("Condition", element("ByValueCondition", clock), name=name, delay="0")
    condition.set("conditionEdge", "none")
    return element("ConditionGroup", condition)
