"""The answer of ``roadproof monitor``: where a formula holds on one trace."""

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.headings import BaseHeading, OnRoad
from roadproof.evidence.answers.shared import Formula, Rational, SetName
from roadproof.evidence.codec import LEFT_OUT, Doc, Key, Rule
from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/monitor/2"
Truth: TypeAlias = Literal["true", "false", "undecided"]
View: TypeAlias = Literal["dense", "recorded"]
Spans: TypeAlias = tuple[tuple[float, float | None], ...]


@dataclass(frozen=True, kw_only=True)
class FormulaPartData:
    """The times at which a part of the formula is true."""

    formula: str
    true: Annotated[
        Spans,
        Doc("When it is true: begin and end in s from the first sample on, ends included; null is for ever."),
    ]
    undecided: Annotated[Spans, Doc("When that depends on what comes after the trace: as above.")]
    exact: Annotated[
        str, LEFT_OUT, Doc("When it is true, with open and closed ends, in s; where the view is dense.")
    ] = ""


@dataclass(frozen=True, kw_only=True)
class OverrideData:
    """A setting of the command line that replaces the one in a drive file."""

    what: Annotated[str, Rule(pattern="^(set|parameter .+|option .+)$")]
    asked: str
    said: Annotated[str, Doc("What the file says; parameters in SI units.")]


@dataclass(frozen=True, kw_only=True)
class MonitoredTraceData:
    """The trace that was monitored, with its road, lanes, set and roles."""

    trace: Annotated[str, Doc("Where the trace was read.")]
    start: Annotated[str, Doc("When its first sample is, as the source counts: seconds, or a frame.")]
    set_name: Annotated[SetName, Key("set")]
    road: Annotated[str, Doc("Name of the road.")]
    lanes: Annotated[Mapping[str, str], Doc("The lane that each free lane of the formula stands for.")]
    overruled: Annotated[
        tuple[OverrideData, ...], Doc("What was asked for otherwise than a drive file says.")
    ]
    roles: Annotated[
        Mapping[str, str],
        LEFT_OUT,
        Doc("What the trace calls the vehicle of each role, where that is not the role."),
    ] = field(default_factory=dict)

    def __str__(self) -> str:
        parts = [f"trace: {self.trace}", f"start: {self.start}"]
        parts += [f"{role}: vehicle {name}" for role, name in self.roles.items()]
        parts += [f"set: {self.set_name}", f"road: {self.road}"]
        parts += [f"lane {name}: {lane}" for name, lane in self.lanes.items()]
        for x in self.overruled:
            values = f"{x.asked} (the file says {x.said})"
            parts.append(f"set of the file: {x.said}" if x.what == "set" else f"{x.what}: {values}")
        return "; ".join(parts)


@dataclass(frozen=True, kw_only=True)
class LeastMarginData:
    """The least robustness over time, the first of several."""

    value: float
    time: Annotated[float, Rule(minimum=0), Doc("In s from the first sample on.")]
    attained: Annotated[
        bool, Doc("False: values come near it just before that time, at which the robustness jumps.")
    ]


@dataclass(frozen=True, kw_only=True)
class MarginPieceData:
    """A piece of the robustness over time: a polynomial, up to where the next one begins."""

    begin: Annotated[float, Rule(minimum=0), Doc("In s.")]
    exact: Annotated[str, Doc("The same as decimals, with a bound where it is rounded.")]
    coefficients: Annotated[
        tuple[Rational, ...], Doc("Of the polynomial in s since 0, the lowest power first; none is 0.")
    ]


@dataclass(frozen=True, kw_only=True)
class RobustnessSignalData:
    """The robustness over time: that of the trace from each sample on."""

    exact: Annotated[bool, Doc("Whether it is known at every instant: pieces say it, or it is infinite.")]
    sampled: Annotated[
        str, LEFT_OUT, Doc("Why the robustness on a drive is known at samples alone, on the grid of dt.")
    ] = ""
    times: Annotated[tuple[float, ...], Doc("Of the samples, in s from the first one on.")]
    low: Annotated[
        tuple[float | None, ...],
        Doc("Lower bounds at the samples; null is infinite: above 0 where the verdict is true, else below."),
    ]
    high: Annotated[
        tuple[float | None, ...],
        Doc("Upper bounds; null is infinite: below 0 where the verdict is false, else above."),
    ]
    verdicts: Annotated[tuple[Truth, ...], Doc("At the samples.")]
    least: Annotated[LeastMarginData | None, Doc("null where no finite value is known.")]
    positive: Annotated[
        Spans, Doc("When it is above 0: begin and end in s, ends included for samples; null is for ever.")
    ]
    negative: Annotated[Spans, Doc("When it is below 0: as above.")]
    pieces: Annotated[
        tuple[MarginPieceData, ...], LEFT_OUT, Doc("On a drive, where the robustness is exact and finite.")
    ] = ()


@dataclass(frozen=True, kw_only=True)
class ObservationData(BaseHeading):
    """The verdict, robustness and parts of a formula on one trace."""

    formula: Formula
    view: Annotated[View, Doc("dense: a drive, judged exactly; recorded: samples.")]
    end: Annotated[
        Literal["truncated", "clip"] | None,
        Doc("What the end of the trace means; null where the view is dense, since a drive has no end."),
    ]
    verdict: Annotated[Truth, Doc("At the first sample.")]
    under_the_other_end: Annotated[
        Truth | None, Doc("The verdict with the other of truncated and clip; null where the view is dense.")
    ]
    robustness: Annotated[
        tuple[float | None, float | None],
        Doc("Bounds of the margin by which it holds, in the SI units of what is compared; null is no bound."),
    ]
    decides: Annotated[
        bool,
        Doc(
            "Whether the robustness has a sign, which is then that of the verdict; of a drive it is 0 where "
            "samples and judge disagree."
        ),
    ]
    seconds: Annotated[float, Rule(minimum=0), Doc("How long the trace is, in s; of a drive its horizon.")]
    dt: Annotated[Rational, Doc("Time between samples, in s; of a drive those of the margin.")]
    parts: Annotated[
        tuple[FormulaPartData, ...], Rule(least=1), Doc("The formula, then the definitions in it.")
    ]


@dataclass(frozen=True, kw_only=True)
class MonitorData(MonitoredTraceData, OnRoad, ObservationData):
    """The verdict of a formula on one trace, with its parts, notes and driver verdicts."""

    notes: Annotated[
        tuple[str, ...],
        LEFT_OUT,
        Doc("What is odd in the recording, what was computed, and which vehicles were left out."),
    ] = ()
    drivers: Annotated[
        tuple[DriverVerdict, ...],
        LEFT_OUT,
        Doc("What becomes of the trace from its start on where driver models drive SV."),
    ] = ()
    robust_signal: Annotated[
        RobustnessSignalData | None, LEFT_OUT, Doc("The robustness over time, with --robust-signal.")
    ] = None
    schema: Literal["roadproof/monitor/2"] = SCHEMA
