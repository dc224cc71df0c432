"""The JSON form of judged drives, of traces that refute a claim, and of their roads."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Literal, TypeAlias

from roadproof.evidence.answers.shared import Dense, Formula, OneScenario, SetName
from roadproof.evidence.codec import LACKING, LEFT_OUT, Doc, ErrorHint, Key, Rule
from roadproof.evidence.schema_notes import DescribedBy, EvidenceSchema, SharedType
from roadproof.runtime.records import dataclass
from roadproof.world.road import Attribute, Zone
from roadproof.world.signals import Kind

_ZONES = "zone= and attribute= are described in docs/explanation/semantics.md"


@dataclass(frozen=True, kw_only=True)
class LaneletData:
    """A rectangle of the road."""

    id: Annotated[str, Doc("Name of the lanelet, of which there is one in the road.")]
    lane: Annotated[str, Doc("Name of the lane that it is a part of.")]
    zone: Annotated[Zone, ErrorHint(_ZONES), Doc("Which kind of road it is on.")]
    attribute: Annotated[Attribute, ErrorHint(_ZONES), Doc("What its lane is for.")]
    s: Annotated[
        tuple[Fraction | None, Fraction | None],
        Doc("Where it begins and ends along the road, in m; null is without end."),
    ]
    d: Annotated[tuple[Fraction, Fraction], Doc("Its right and its left edge, in m.")]


LaneletField: TypeAlias = Annotated[LaneletData, SharedType("lanelet")]


_FOUR = Rule(least=4, most=4)


@dataclass(frozen=True, kw_only=True)
class CurveData:
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
class RoadData:
    """Lanelets by s, which grows in driving direction, and d, which grows to the left, both in m."""

    name: Annotated[str, Doc("Name of the road.")]
    lanelets: Annotated[tuple[LaneletField, ...], Rule(most=1000), Doc("All lanelets.")]
    adjacent: Annotated[
        tuple[Annotated[tuple[str, str], ErrorHint("lanes without a neighbour are no pair")], ...],
        Rule(most=1000),
        Doc("Pairs of names of lanes that lie beside each other."),
    ]
    line: Annotated[
        tuple[CurveData, ...],
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


RoadField: TypeAlias = Annotated[RoadData, SharedType("road")]


@dataclass(frozen=True, kw_only=True)
class PieceData:
    """A time with constant accelerations."""

    duration: Annotated[Fraction | None, Doc("In s; null is for ever.")]
    a_lon: Annotated[Fraction, Doc("At the start of the piece, in m/s^2.")]
    a_lat: Annotated[Fraction, Doc("In m/s^2.")]


@dataclass(frozen=True, kw_only=True)
class JerkPieceData(PieceData):
    """A time with constant jerk."""

    j_lon: Annotated[Fraction, Doc("By which a_lon grows, in m/s^3; 0 in the last piece.")]


_PIECES = (
    Rule(least=1, most=2000),
    ErrorHint("the last piece lasts for ever"),
    Doc("Accelerations and jerks one after the other; the last one lasts for ever."),
)


@dataclass(frozen=True, kw_only=True)
class MotionData:
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
    pieces: Annotated[tuple[PieceData, ...], *_PIECES]


@dataclass(frozen=True, kw_only=True)
class JerkMotionData(MotionData):
    """A motion in a file in which some vehicle has jerk."""

    pieces: Annotated[tuple[JerkPieceData, ...], *_PIECES]


@dataclass(frozen=True, kw_only=True)
class CourseValueData:
    """A value of a custom signal."""

    start: Annotated[Fraction, Key("from"), Doc("From when on it has the value, in s; the first is 0.")]
    value: Annotated[Fraction, Doc("In SI units; 0 and 1 are false and true.")]


@dataclass(frozen=True, kw_only=True)
class SignalData:
    """The values of a custom signal in time; each lasts until the next, and the last for ever."""

    signal: Annotated[
        str, Rule(pattern="^[A-Za-z_][A-Za-z0-9_]*$", called="name"), Doc("Name of the signal.")
    ]
    vehicle: Annotated[str | None, Doc("Null for a signal of no vehicle.")] = None
    values: Annotated[tuple[CourseValueData, ...], Rule(least=1, most=2000), Doc("Its values in time.")]


@dataclass(frozen=True, kw_only=True)
class TrueTimesData:
    """The times at which a definition in the formula is true."""

    formula: Annotated[str, Doc("The definition with what it is applied to.")]
    true: Annotated[str, Doc("Intervals in s, open and closed ends, such as [0, 3.2); empty where never.")]


@dataclass(frozen=True, kw_only=True)
class DriveVerdictData:
    """The verdict of the judge when the file was written; a reader of the file judges the drive again."""

    verdict: Literal["WITNESSED"] = "WITNESSED"
    view: Dense = "dense"
    natural: Annotated[bool | None, LEFT_OUT, Doc("Whether it was looked for among natural drives.")] = None
    times: Annotated[tuple[TrueTimesData, ...], Doc("When the definitions in the formula are true.")]


@dataclass(frozen=True, kw_only=True)
class AnyDriveData:
    """The fields of both versions of drive files."""

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
    road: RoadField
    vehicles: Mapping[str, MotionData]
    signals: Annotated[
        tuple[SignalData, ...],
        Rule(most=100),
        LEFT_OUT,
        Doc("Courses of custom signals; left out where there are none."),
    ] = ()
    verdict: Annotated[object, DescribedBy(DriveVerdictData)] = None


_VEHICLES = (Rule(most=20), Doc("Motions by the name of the vehicle in the formula."))


@dataclass(frozen=True, kw_only=True)
class DriveData(AnyDriveData):
    """A judged drive without jerk. Numbers are exact rationals as text, in SI units."""

    schema: Literal["roadproof/drive/1"] = "roadproof/drive/1"
    vehicles: Annotated[Mapping[str, MotionData], *_VEHICLES]


@dataclass(frozen=True, kw_only=True)
class JerkDriveData(AnyDriveData):
    """A judged drive in which a piece of some vehicle has jerk; every piece says its jerk."""

    schema: Literal["roadproof/drive/2"] = "roadproof/drive/2"
    vehicles: Annotated[Mapping[str, JerkMotionData], *_VEHICLES]


# --- traces that refute a claim ---------------------------------------------------------------------

MOST_INSTANTS = 1000
Between: TypeAlias = Literal["the state of the instant before", "the state of the instant after"]


@dataclass(frozen=True, kw_only=True)
class RepeatsData:
    """The trace repeats itself for ever; left out where it keeps its last state."""

    start: Annotated[Fraction, Key("from"), Doc("The instant that each round begins with, in s.")]
    period: Annotated[Fraction, Doc("How long a round is, in s; it ends after the last instant.")]


@dataclass(frozen=True, kw_only=True)
class InstantData:
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
class RefutingTraceData:
    """A trace over points in time on which a claim is judged false, where no drive was found."""

    kind: Annotated[Literal["trace"], ErrorHint("a drive is a file beside the index")]
    between: Annotated[Between, Doc("What holds between two instants.")]
    parameters: Annotated[
        Mapping[str, Fraction], Doc("Values of parameters by name, in SI units (s, m, m/s, m/s^2).")
    ]
    road: Annotated[
        RoadField | None,
        LACKING,
        Doc("Null where the claim speaks of no lanes, and left out by earlier versions."),
    ] = None
    repeats: Annotated[RepeatsData | None, LEFT_OUT] = None
    instants: Annotated[
        tuple[InstantData, ...],
        Rule(least=1, most=MOST_INSTANTS),
        ErrorHint(f"a trace has at least one and not more than {MOST_INSTANTS} instants"),
        Doc("States in the order of time, the first at 0."),
    ]


@dataclass(frozen=True, kw_only=True)
class RefutingDriveData:
    """A judged drive on which the claim is false."""

    kind: Literal["drive"]
    drive: Annotated[object, EvidenceSchema("drive.json")]


TraceField: TypeAlias = Annotated[object, DescribedBy(RefutingTraceData), SharedType("trace")]
CounterexampleField: TypeAlias = Annotated[
    object,
    DescribedBy(TraceField | RefutingDriveData | None),
    Doc("What refutes the claim, judged: a drive, or else a trace; null where nothing does."),
    SharedType("counterexample"),
]
