"""Traces over points in time that refute a claim, as they stand in JSON."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, Literal, TypeAlias

from roadproof.evidence.answers.drive import KeptRoad
from roadproof.evidence.codec import LACKING, LEFT_OUT, Doc, Key, Remedy, Rule
from roadproof.evidence.json_schema import Plain, Shared, Whole

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
