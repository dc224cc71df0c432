"""What is asked of an exploration, and what it shows, as plain data."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Final, Literal

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.drive import KeptRoad
from roadproof.evidence.claim import Engine
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.extensions.surveys.explore.asking import Explorable
from roadproof.extensions.surveys.explore.values import Boundary, ExplorationResult
from roadproof.extensions.surveys.extremes.extreme import Extreme
from roadproof.extensions.surveys.extremes.measure import Sense
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.questions.question import Place
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict
from roadproof.world.units import unit_text

SCHEMA: Final = "roadproof/explore/2"


@dataclass(frozen=True, kw_only=True)
class AskedFormula:
    """A formula that is explored."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    when: Annotated[str, Doc("At a moment at which this formula holds is measured; empty is at time 0.")] = ""


@dataclass(frozen=True, kw_only=True)
class AskedVariation:
    """What is varied, from low to high (SI units)."""

    name: Annotated[str, Doc("A parameter, or a limit such as POV.a_lon.min.")]
    low: Fraction
    high: Fraction


@dataclass(frozen=True, kw_only=True)
class SearchedPlace:
    """Where and how drives are looked for."""

    road: Annotated[KeptRoad | None, Doc("The road; null for the usual one of a formula.")]
    lanes: Annotated[Mapping[str, str], Doc("Lanes of the road by free lanes of formulas.")]
    dt: Annotated[Fraction | None, Doc("The coarsest step, in s.")]
    reach: Annotated[Fraction, Doc("How far apart vehicles may start, in m.")]
    collisions: Annotated[bool, Doc("Whether boxes may overlap.")]
    engine: Engine
    solver: str


@dataclass(frozen=True, kw_only=True)
class Exploring:
    """For which values of what is varied formulas have drives, and how far measures can go."""

    formulas: Annotated[tuple[AskedFormula, ...], Rule(least=1)]
    vary: tuple[AskedVariation, ...]
    steps: Annotated[int | None, Doc("Values of each.")] = None
    precision: Annotated[Fraction | None, Doc("Width of brackets, in SI units.")] = None
    least: Annotated[str | None, Doc("A term whose least value is wanted.")] = None
    greatest: Annotated[str | None, Doc("A term whose greatest value is wanted.")] = None
    place: SearchedPlace


@dataclass(frozen=True, kw_only=True)
class Variation:
    """What is varied, from low to high."""

    name: Annotated[str, Doc("A parameter, or a limit such as POV.a_lon.min.")]
    unit: Annotated[str, Doc("Unit of all its values here.")]
    low: shared.Rational
    high: shared.Rational


@dataclass(frozen=True, kw_only=True)
class FindingData:
    """Whether there is a drive at a value."""

    at: Annotated[
        tuple[shared.Rational, ...],
        Doc("Values of what is varied, in its units; of an extreme the value of the measure."),
    ]
    verdict: DriveVerdict
    formula: shared.Formula
    reason: shared.Reason = NO_REASON
    number: Annotated[int | None, Doc("Tells drives apart; null where there is none.")] = None
    evidence: Annotated[shared.KeptEvidence, Doc("A drive or a certificate; null in doubt.")] = None
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()


@dataclass(frozen=True, kw_only=True)
class BoundaryData:
    """Where drives end on one side of a value."""

    held: Annotated[FindingData, Doc("A value with a drive.")]
    missed: Annotated[FindingData, Doc("The nearest value on one side for which none was found.")]
    surely: Annotated[
        FindingData | None, Doc("The nearest value there for which it is said that there is none.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class ExtremeData:
    """How far a measure can go."""

    sense: Sense
    measure: Annotated[str, Rule(least=1), Doc("A term.")]
    when: Annotated[str, Doc("At a moment at which this formula holds; empty is at time 0.")]
    unit: Annotated[str, Doc("Of the measure, SI; empty where it has none.")]
    point: Annotated[tuple[shared.Rational, ...], Doc("Values of what is varied.")]
    best: Annotated[
        FindingData | None, Doc("The value that a drive reaches; null where there is no drive.")
    ] = None
    missed: Annotated[FindingData | None, Doc("The nearest value for which none was found.")] = None
    surely: Annotated[
        FindingData | None, Doc("The nearest value for which it is said that there is none.")
    ] = None
    endless: Annotated[bool, Doc("Whether the drive passes any value that is asked for.")] = False
    searches: shared.Count = 0

    @property
    def sides(self) -> dict[str, FindingData | None]:
        """What was found, by name."""
        return {"best": self.best, "missed": self.missed, "surely": self.surely}


@dataclass(frozen=True, kw_only=True)
class ExplorationData:
    """For which values a formula has a drive, and how far measures can go."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    vary: tuple[Variation, ...]
    values: tuple[FindingData, ...]
    boundaries: tuple[BoundaryData, ...]
    searches: Annotated[shared.Count, Doc("How many searches it took.")] = 0
    drives: Annotated[shared.Count, Doc("How many drives serve the values.")] = 0
    extremes: tuple[ExtremeData, ...]


@dataclass(frozen=True, kw_only=True)
class ExploreData(shared.OnRoad, shared.Heading):
    """For which values there is a drive."""

    schema: Literal["roadproof/explore/2"] = SCHEMA
    options: shared.Options
    parameters: Annotated[shared.Parameters, Doc("All that are not varied, in SI units.")]
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    explored: tuple[ExplorationData, ...]


def exploration_data(asked: Explorable, explored: ExplorationResult, place: Place) -> ExplorationData:
    """Return what was explored as plain data."""
    search = asked.search
    return ExplorationData(
        scenario=search.scenario,
        set=search.specification.set_name,
        formula=search.query.text,
        vary=tuple(
            Variation(name=knob.name, unit=knob.unit, low=str(knob.low), high=str(knob.high))
            for knob in asked.knobs
        ),
        values=_findings(explored.findings, place),
        boundaries=tuple(_boundary(x, place) for x in explored.boundaries),
        searches=explored.searches,
        drives=explored.drives,
        extremes=tuple(_extreme(x, place) for x in explored.extremes),
    )


def _findings(findings: Sequence[PointFinding], place: Place) -> tuple[FindingData, ...]:
    return tuple(_finding(x, place) for x in findings)


def _finding(x: PointFinding, place: Place) -> FindingData:
    shown = x.answer if x.answer is not None and x.answer.is_final else None
    return FindingData(
        at=tuple(map(str, x.at)),
        verdict=x.verdict,
        formula=x.query.text,
        reason=x.reason,
        number=x.number,
        evidence=None if shown is None else place(x.name, shown),
        assuming=x.assuming,
    )


def _side(x: PointFinding | None, place: Place) -> FindingData | None:
    return None if x is None else _finding(x, place)


def _boundary(x: Boundary, place: Place) -> BoundaryData:
    return BoundaryData(
        held=_finding(x.held, place), missed=_finding(x.missed, place), surely=_side(x.surely, place)
    )


def _extreme(x: Extreme, place: Place) -> ExtremeData:
    return ExtremeData(
        sense=x.measure.sense,
        measure=x.measure.text,
        when=x.measure.when,
        unit=unit_text(x.measure.dimension),
        point=tuple(map(str, x.point)),
        best=_side(x.best, place),
        missed=_side(x.missed, place),
        surely=_side(x.surely, place),
        endless=x.endless,
        searches=x.searches,
    )
