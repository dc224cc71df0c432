"""The answer of ``roadproof evaluate``: dangers in recordings, and the scenarios that match them."""

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/traffic-results/5"
Driver: TypeAlias = Annotated[str, Rule(least=1), Doc("A driver model.")]
MinDanger: TypeAlias = Annotated[shared.Rational, Doc("In s.")]
Share: TypeAlias = Annotated[float, Rule(minimum=0)] | None
Interval: TypeAlias = tuple[float, float] | None
UnequalPair: TypeAlias = tuple[str, int, int, shared.Rational]


@dataclass(frozen=True, kw_only=True)
class EvaluationSettingsData:
    """The settings of an evaluation of traffic."""

    sets: shared.SetNames
    min_danger: Annotated[
        tuple[shared.Rational, ...], Rule(least=1), Doc("Values of the parameter minDanger, in s.")
    ]
    scenarios: tuple[shared.Number, ...]
    classes: Annotated[tuple[str, ...], Doc("Classes of vehicles that are looked at, such as Car.")]
    convention: Annotated[Literal["truncated", "clip"], Doc("What the end of a trace means.")]
    detectors: Annotated[tuple[str, ...], Doc("Detectors of earlier works, by name.")]
    options: shared.Options
    parameters: Annotated[shared.Parameters, Doc("All but minDanger, in SI units.")]
    drivers: Annotated[
        tuple[Driver, ...],
        LEFT_OUT,
        Rule(least=1, unique=True),
        Doc("Driver models that matches were put to; only where some were asked for."),
    ] = ()


@dataclass(frozen=True, kw_only=True)
class ResultsRowData:
    """A spec set under one min_danger, in a road sector."""

    sector: Annotated[str, Doc("The road sector of the row's scenarios, in the words of the specification.")]
    min_danger: MinDanger
    set: shared.SetName
    traces: Annotated[
        shared.Count, Doc("Unordered pairs on which danger arises, and that begin in the sector.")
    ]
    matching: Annotated[shared.Count, Doc("Those that a scenario of two cars matches.")]
    matching_uncertain: Annotated[
        shared.Count,
        Doc("Those of matching that depend on less than places may be off."),
    ]
    matching_possible: Annotated[
        shared.Count,
        Doc("Traces that no scenario of two cars matches, but one may, as places are off."),
    ]
    matching_with_three_cars: Annotated[shared.Count, Doc("Those that any scenario matches.")]
    recall: Annotated[Share, Doc("matching by traces; null where there are none.")]
    recall_interval: Annotated[
        Interval, Doc("recall by matches that are sure, and by all that are possible; null as recall.")
    ]
    recall_without_init_safe: Annotated[
        Share,
        Doc(
            "The share of all violating pairs that match a scenario of two cars of this sector; null where "
            "there are none."
        ),
    ]
    recall_without_init_safe_interval: Annotated[
        Interval, Doc("That share by matches that are sure, and by all that are possible.")
    ]
    scenarios: Annotated[
        Mapping[Annotated[str, Rule(pattern="^[0-9]+$", called="number")], shared.Count],
        Doc("Pairs by the number of the scenario that matches them."),
    ]
    matching_several: Annotated[shared.Count, Doc("Pairs that several scenarios match.")]
    together: Annotated[
        Mapping[Annotated[str, Rule(pattern="^[0-9]+-[0-9]+$", called="pair of numbers")], shared.Count],
        Doc("Pairs by two scenarios that both match them."),
    ]


@dataclass(frozen=True, kw_only=True)
class ChecksData:
    """Facts that were checked on this run."""

    broken: Annotated[tuple[str, ...], Doc("Facts that do not hold, in words: our fault.")]
    unequal_3_4: Annotated[
        tuple[UnequalPair, ...],
        Doc("Pairs that match only one of the two: recording, two vehicles, min_danger in s."),
    ]


@dataclass(frozen=True, kw_only=True)
class RepeatData:
    """A trace, violation or detection that an earlier recording shows, too."""

    recording: str
    pair: Annotated[tuple[int, int], Doc("Ids of vehicles.")]
    what: Annotated[str, Doc("trace, violation, or the name of a detector.")]
    min_danger: Annotated[shared.Rational | None, Doc("In s; null where it makes no difference.")]
    shown_in: Annotated[str, Doc("The earlier recording.")]


@dataclass(frozen=True, kw_only=True)
class DriverLabelsData:
    """The number of matches of a scenario by the label that a driver model gives them."""

    min_danger: MinDanger
    set: shared.SetName
    scenario: shared.Number
    driver: Driver
    preventable: Annotated[
        shared.Count,
        Doc("Matches in which SV, driven by the model, never touches POV before it has passed it."),
    ]
    unpreventable: Annotated[shared.Count, Doc("Those in which it touches POV.")]
    undecided: Annotated[
        shared.Count, Doc("Those in which SV passes POV first, after which nothing is claimed.")
    ]
    not_covered: Annotated[shared.Count, Doc("Those in which the manoeuvre never begins.")]


@dataclass(frozen=True, kw_only=True)
class EvaluationData(headings.BaseHeading):
    """Dangers in recordings, and the scenarios that match them."""

    schema: Literal["roadproof/traffic-results/5"] = SCHEMA
    settings: EvaluationSettingsData
    recordings: Annotated[shared.Count, Doc("Recordings that were used.")]
    vehicles: Annotated[shared.Count, Doc("Vehicles in them.")]
    samples: Annotated[shared.Count, Doc("Samples of these vehicles.")]
    violating: Annotated[
        shared.Count,
        Doc(
            "Pairs of vehicles that violate the RSS distance in some frame, each once over all windows that "
            "show it, in all road sectors, with and without initial safety."
        ),
    ]
    asked: Annotated[shared.Count, Doc("Questions to the monitor.")]
    undecided: Annotated[shared.Count, Doc("Those that depend on what comes after a trace.")]
    differing: Annotated[shared.Count, Doc("Those that truncated and clip answer otherwise.")]
    table: Annotated[
        tuple[ResultsRowData, ...],
        Doc("A row for each road sector that the recordings have, min_danger and set."),
    ]
    words: Annotated[tuple[shared.WordsField, ...], Doc("What the scenarios are called.")]
    detectors: Annotated[Mapping[str, shared.Count], Doc("Pairs that each detector reports.")]
    checks: ChecksData
    repeats: Annotated[
        tuple[RepeatData, ...], Doc("What an earlier recording shows too, which is counted there only.")
    ]
    notes: Annotated[Mapping[str, tuple[str, ...]], Doc("What is odd, by recording, in words.")]
    left_out: Annotated[
        Mapping[str, tuple[str, ...]],
        LEFT_OUT,
        Doc("Those of the notes that say which vehicles and parts of files were left out."),
    ] = field(default_factory=dict)
    failed: Annotated[Mapping[str, str], Doc("Recordings that were left out, and why.")]
    drivers: Annotated[
        tuple[DriverLabelsData, ...] | None,
        LEFT_OUT,
        Doc("What driver models say of matches; only where some were asked for."),
    ] = None
