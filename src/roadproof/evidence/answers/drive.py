"""The files of judged drives, and traces that refute a claim, with their roads, as they stand in JSON."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Literal, TypeAlias

from roadproof.evidence.answers.shared import Dense, Formula, OneScenario, SetName
from roadproof.evidence.codec import LACKING, LEFT_OUT, Doc, Key, Remedy, Rule
from roadproof.evidence.json_schema import Plain, Shared, Whole
from roadproof.runtime.records import dataclass
from roadproof.world.road import Attribute, Zone
from roadproof.world.signals import Kind

_ZONES = "zone= and attribute= are described in docs/explanation/semantics.md"


@dataclass(frozen=True, kw_only=True)
class Lanelet:
    """A rectangle of the road."""

    id: Annotated[str, Doc("Name of the lanelet, of which there is one in the road.")]
    lane: Annotated[str, Doc("Name of the lane that it is a part of.")]
    zone: Annotated[Zone, Remedy(_ZONES), Doc("Which kind of road it is on.")]
    attribute: Annotated[Attribute, Remedy(_ZONES), Doc("What its lane is for.")]
    s: Annotated[
        tuple[Fraction | None, Fraction | None],
        Doc("Where it begins and ends along the road, in m; null is without end."),
    ]
    d: Annotated[tuple[Fraction, Fraction], Doc("Its right and its left edge, in m.")]


KeptLanelet: TypeAlias = Annotated[Lanelet, Shared("lanelet")]


_FOUR = Rule(least=4, most=4)


@dataclass(frozen=True, kw_only=True)
class Curve:
    """A part of the line in the plane along which s is measured, from where s, x, y and heading are."""

    kind: Annotated[Literal["line", "spiral", "cubic", "polyline"], Doc("Its shape.")]
    s: Annotated[Fraction, Doc("Where it begins, in m along the road.")]
    length: Annotated[Fraction, Doc("In m.")]
    x: Annotated[Fraction, Doc("In m; of the end where the road goes backward.")]
    y: Annotated[Fraction, Doc("In m; of the end where the road goes backward.")]
    heading: Annotated[Fraction, Doc("In rad, to the left from the x axis.")]
    curvature: Annotated[
        tuple[Fraction, Fraction] | None, LEFT_OUT, Doc("Of a spiral, at its beginning and its end, in 1/m.")
    ] = None
    u: Annotated[tuple[Fraction, ...], _FOUR, LEFT_OUT, Doc("Coefficients of a cubic along, in m.")] = ()
    v: Annotated[
        tuple[Fraction, ...], _FOUR, LEFT_OUT, Doc("Coefficients of a cubic to the left, in m.")
    ] = ()
    last: Annotated[Fraction | None, LEFT_OUT, Doc("Parameter at the end of a cubic.")] = None
    points: Annotated[
        tuple[tuple[Fraction, Fraction], ...], Rule(most=100_000), LEFT_OUT, Doc("Of a polyline, in m.")
    ] = ()
    backward: Annotated[bool, LEFT_OUT, Doc("Whether the road goes from its end to its beginning.")] = False
    offset: Annotated[Fraction, LEFT_OUT, Doc("How far the line is to its left, in m.")] = Fraction(0)


@dataclass(frozen=True, kw_only=True)
class Road:
    """Lanelets by s, which grows in driving direction, and d, which grows to the left, both in m."""

    name: Annotated[str, Doc("Name of the road.")]
    lanelets: Annotated[tuple[KeptLanelet, ...], Rule(most=1000), Doc("All lanelets.")]
    adjacent: Annotated[
        tuple[Annotated[tuple[str, str], Remedy("lanes without a neighbour are no pair")], ...],
        Rule(most=1000),
        Doc("Pairs of names of lanes that lie beside each other."),
    ]
    line: Annotated[
        tuple[Curve, ...],
        Rule(most=10_000),
        LEFT_OUT,
        Doc("Where the road is in the plane; none: s and d are x and y."),
    ] = ()
    map: Annotated[str | None, LEFT_OUT, Doc("The map that the road is from, and which stretch of it.")] = (
        None
    )
    unread: Annotated[
        tuple[str, ...], Rule(most=1000), LEFT_OUT, Doc("Kinds of parts of the map that were not read.")
    ] = ()


KeptRoad: TypeAlias = Annotated[Road, Shared("road")]


@dataclass(frozen=True, kw_only=True)
class Piece:
    """A time with constant accelerations."""

    duration: Annotated[Fraction | None, Doc("In s; null is for ever.")]
    a_lon: Annotated[Fraction, Doc("At the start of the piece, in m/s^2.")]
    a_lat: Annotated[Fraction, Doc("In m/s^2.")]


@dataclass(frozen=True, kw_only=True)
class JerkPiece(Piece):
    """A time with constant jerk."""

    j_lon: Annotated[Fraction, Doc("By which a_lon grows, in m/s^3; 0 in the last piece.")]


_PIECES = (
    Rule(least=1, most=2000),
    Remedy("the last piece lasts for ever"),
    Doc("Accelerations and jerks one after the other; the last one lasts for ever."),
)


@dataclass(frozen=True, kw_only=True)
class Motion:
    """A box: s and d are those of its front-left corner, s along the road, d to the left."""

    kind: Annotated[
        Kind | None, LEFT_OUT, Doc("What kind of vehicle it is; left out where nothing says it.")
    ] = None
    length: Annotated[Fraction, Doc("In m.")]
    width: Annotated[Fraction, Doc("In m.")]
    s: Annotated[Fraction, Doc("At time 0, in m.")]
    d: Annotated[Fraction, Doc("At time 0, in m.")]
    v_lon: Annotated[Fraction, Doc("At time 0, in m/s.")]
    v_lat: Annotated[Fraction, Doc("At time 0, in m/s.")]
    pieces: Annotated[tuple[Piece, ...], *_PIECES]


@dataclass(frozen=True, kw_only=True)
class JerkMotion(Motion):
    """A motion in a file in which some vehicle has jerk."""

    pieces: Annotated[tuple[JerkPiece, ...], *_PIECES]


@dataclass(frozen=True, kw_only=True)
class CourseValue:
    """A value of an own signal."""

    start: Annotated[Fraction, Key("from"), Doc("From when on it has the value, in s; the first is 0.")]
    value: Annotated[Fraction, Doc("In SI units; 0 and 1 are false and true.")]


@dataclass(frozen=True, kw_only=True)
class Signal:
    """The course of an own signal, constant from one time to the next and for ever after the last."""

    signal: Annotated[
        str, Rule(pattern="^[A-Za-z_][A-Za-z0-9_]*$", called="name"), Doc("Name of the signal.")
    ]
    vehicle: Annotated[str | None, Doc("Null for a signal of no vehicle.")] = None
    values: Annotated[tuple[CourseValue, ...], Rule(least=1, most=2000), Doc("Its values in time.")]


@dataclass(frozen=True, kw_only=True)
class TrueTimes:
    """When a definition in the formula is true."""

    formula: Annotated[str, Doc("The definition with what it is applied to.")]
    true: Annotated[str, Doc("Intervals in s, open and closed ends, such as [0, 3.2); empty where never.")]


@dataclass(frozen=True, kw_only=True)
class DriveSays:
    """What the judge said of the drive when the file was written; who reads the file judges again."""

    verdict: Literal["WITNESSED"] = "WITNESSED"
    view: Dense = "dense"
    natural: Annotated[bool | None, LEFT_OUT, Doc("Whether it was looked for among natural drives.")] = None
    times: Annotated[tuple[TrueTimes, ...], Doc("When the definitions in the formula are true.")]


@dataclass(frozen=True, kw_only=True)
class AnyDrive:
    """What both versions of drive files say."""

    schema: str
    scenario: OneScenario = None
    set: SetName
    formula: Annotated[Formula, Doc("What holds on the drive from time 0 on.")]
    horizon: Annotated[
        Fraction,
        Rule(pattern="^[0-9]{1,40}(/[0-9]{1,40})?$"),
        Doc("Up to when boxes are known to be apart, in s."),
    ]
    lane: Annotated[
        str | None, Doc("The lane of the road that L stands for; null where the formula has no L.")
    ] = None
    lanes: Annotated[
        Mapping[str, str] | None,
        LEFT_OUT,
        Doc("A lane of the road for each free lane of the formula, where there are others than L."),
    ] = None
    overlaps_allowed: Annotated[
        bool, LEFT_OUT, Doc("Whether boxes may overlap; false where it is left out.")
    ] = False
    parameters: Annotated[
        Mapping[str, str], Doc("Values of parameters (rationals, SI units) and readings of options, by name.")
    ]
    road: KeptRoad
    vehicles: Mapping[str, Motion]
    signals: Annotated[
        tuple[Signal, ...],
        Rule(most=100),
        LEFT_OUT,
        Doc("Courses of own signals; left out where there are none."),
    ] = ()
    verdict: Annotated[object, Plain(DriveSays)] = None


_VEHICLES = (Rule(most=20), Doc("Motions by the name of the vehicle in the formula."))


@dataclass(frozen=True, kw_only=True)
class Drive(AnyDrive):
    """A judged drive without jerk. Numbers are exact rationals as text, in SI units."""

    schema: Literal["roadproof/drive/1"] = "roadproof/drive/1"
    vehicles: Annotated[Mapping[str, Motion], *_VEHICLES]


@dataclass(frozen=True, kw_only=True)
class JerkDrive(AnyDrive):
    """A judged drive in which a piece of some vehicle has jerk; every piece says its jerk."""

    schema: Literal["roadproof/drive/2"] = "roadproof/drive/2"
    vehicles: Annotated[Mapping[str, JerkMotion], *_VEHICLES]


# --- traces that refute a claim ---------------------------------------------------------------------

MOST_INSTANTS = 1000
Between: TypeAlias = Literal["the state of the instant before", "the state of the instant after"]


@dataclass(frozen=True, kw_only=True)
class Repeats:
    """The trace repeats itself for ever; left out where it keeps its last state."""

    start: Annotated[Fraction, Key("from"), Doc("The instant that each round begins with, in s.")]
    period: Annotated[Fraction, Doc("How long a round is, in s; it ends after the last instant.")]


@dataclass(frozen=True, kw_only=True)
class Instant:
    """A state at a point in time."""

    time: Annotated[Fraction, Doc("In s.")]
    true: Annotated[tuple[str, ...], Doc("Atoms of the claim that are true.")]
    values: Annotated[
        Mapping[str, Fraction], Doc("Signals and sizes of vehicles, such as v_lon(SV), in SI units.")
    ]
    after: Annotated[
        Mapping[str, Fraction] | None,
        LEFT_OUT,
        Doc("The same from just after the instant up to the next, where it is a state of its own."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class Trace:
    """A trace over points in time on which a claim is judged false, where no drive was found."""

    kind: Annotated[Literal["trace"], Remedy("a drive is a file beside the index")]
    between: Annotated[Between, Doc("What holds between two instants.")]
    parameters: Annotated[
        Mapping[str, Fraction], Doc("Values of parameters by name, in SI units (s, m, m/s, m/s^2).")
    ]
    road: Annotated[
        KeptRoad | None,
        LACKING,
        Doc("Null where the claim speaks of no lanes, and left out by earlier versions."),
    ] = None
    repeats: Annotated[Repeats | None, LEFT_OUT] = None
    instants: Annotated[
        tuple[Instant, ...],
        Rule(least=1, most=MOST_INSTANTS),
        Remedy(f"a trace has at least one and not more than {MOST_INSTANTS} instants"),
        Doc("States in the order of time, the first at 0."),
    ]


@dataclass(frozen=True, kw_only=True)
class RefutingDrive:
    """A judged drive on which the claim is false."""

    kind: Literal["drive"]
    drive: Annotated[object, Whole("drive.json")]


KeptTrace: TypeAlias = Annotated[object, Plain(Trace), Shared("trace")]
KeptCounterexample: TypeAlias = Annotated[
    object,
    Plain(KeptTrace | RefutingDrive | None),
    Doc("What refutes the claim, judged: a drive, or else a trace; null where nothing does."),
    Shared("counterexample"),
]
