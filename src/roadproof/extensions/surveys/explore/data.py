"""The JSON of ``explore``: settings of the question, and its view."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Final, Literal

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.answers.drive import RoadField
from roadproof.evidence.claim import Engine
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.extensions.surveys.explore.explorable import Explorable
from roadproof.extensions.surveys.explore.values import ExplorationResult, SweepBoundary
from roadproof.extensions.surveys.extremes.extreme import Extreme
from roadproof.extensions.surveys.extremes.measure import Sense
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.questions.question import EvidencePlace
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict
from roadproof.world.units import unit_text

SCHEMA: Final = "roadproof/explore/2"


@dataclass(frozen=True, kw_only=True)
class ExploredFormula:
    """A formula that is explored."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    when: Annotated[str, Doc("At a moment at which this formula holds is measured; empty is at time 0.")] = ""


@dataclass(frozen=True, kw_only=True)
class VariationRange:
    """A varied parameter, from low to high (SI units)."""

    name: Annotated[str, Doc("A parameter, or a limit such as POV.a_lon.min.")]
    low: Fraction
    high: Fraction


@dataclass(frozen=True, kw_only=True)
class SearchSetup:
    """The road, limits and solver of the searches for drives."""

    road: Annotated[RoadField | None, Doc("The road; null for the usual one of a formula.")]
    lanes: Annotated[Mapping[str, str], Doc("Lanes of the road by free lanes of formulas.")]
    dt: Annotated[Fraction | None, Doc("The coarsest step, in s.")]
    reach: Annotated[Fraction, Doc("How far apart vehicles may start, in m.")]
    collisions: Annotated[bool, Doc("Whether boxes may overlap.")]
    engine: Engine
    solver: str


@dataclass(frozen=True, kw_only=True)
class ExplorationSettings:
    """The formulas, the values to vary and the measures of an exploration."""

    formulas: Annotated[tuple[ExploredFormula, ...], Rule(least=1)]
    vary: tuple[VariationRange, ...]
    steps: Annotated[int | None, Doc("Values of each.")] = None
    precision: Annotated[Fraction | None, Doc("Width of brackets, in SI units.")] = None
    least: Annotated[str | None, Doc("A term whose least value is wanted.")] = None
    greatest: Annotated[str | None, Doc("A term whose greatest value is wanted.")] = None
    place: SearchSetup


@dataclass(frozen=True, kw_only=True)
class Variation:
    """A varied parameter, from low to high."""

    name: Annotated[str, Doc("A parameter, or a limit such as POV.a_lon.min.")]
    unit: Annotated[str, Doc("Unit of all its values here.")]
    low: shared.Rational
    high: shared.Rational


@dataclass(frozen=True, kw_only=True)
class PointFindingData:
    """The answer whether a drive exists at a value."""

    at: Annotated[
        tuple[shared.Rational, ...],
        Doc("Values of what is varied, in its units; of an extreme the value of the measure."),
    ]
    verdict: DriveVerdict
    formula: shared.Formula
    reason: shared.Reason = NO_REASON
    number: Annotated[int | None, Doc("Tells drives apart; null where there is none.")] = None
    evidence: Annotated[shared.EvidenceField, Doc("A drive or a certificate; null in doubt.")] = None
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()


@dataclass(frozen=True, kw_only=True)
class BoundaryData:
    """The boundary beside which drives exist on one side of a value only."""

    held: Annotated[PointFindingData, Doc("A value with a drive.")]
    missed: Annotated[PointFindingData, Doc("The nearest value on one side for which none was found.")]
    surely: Annotated[
        PointFindingData | None, Doc("The nearest value there for which it is said that there is none.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class ExtremeData:
    """The extreme of a measure."""

    sense: Sense
    measure: Annotated[str, Rule(least=1), Doc("A term.")]
    when: Annotated[str, Doc("At a moment at which this formula holds; empty is at time 0.")]
    unit: Annotated[str, Doc("Of the measure, SI; empty where it has none.")]
    point: Annotated[tuple[shared.Rational, ...], Doc("Values of what is varied.")]
    best: Annotated[
        PointFindingData | None, Doc("The value that a drive reaches; null where there is no drive.")
    ] = None
    missed: Annotated[PointFindingData | None, Doc("The nearest value for which none was found.")] = None
    surely: Annotated[
        PointFindingData | None, Doc("The nearest value for which it is said that there is none.")
    ] = None
    endless: Annotated[bool, Doc("Whether the drive passes any value that is asked for.")] = False
    searches: shared.Count = 0

    @property
    def sides(self) -> dict[str, PointFindingData | None]:
        """The findings by name."""
        return {"best": self.best, "missed": self.missed, "surely": self.surely}


@dataclass(frozen=True, kw_only=True)
class ExplorationData:
    """The values for which a formula has a drive, and the extremes of measures."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    vary: tuple[Variation, ...]
    values: tuple[PointFindingData, ...]
    boundaries: tuple[BoundaryData, ...]
    searches: Annotated[shared.Count, Doc("How many searches it took.")] = 0
    drives: Annotated[shared.Count, Doc("How many drives serve the values.")] = 0
    extremes: tuple[ExtremeData, ...]


@dataclass(frozen=True, kw_only=True)
class ExploreData(headings.OnRoad, headings.AnswerHeading):
    """The values for which drives exist."""

    schema: Literal["roadproof/explore/2"] = SCHEMA
    options: shared.Options
    parameters: Annotated[shared.Parameters, Doc("All that are not varied, in SI units.")]
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    explored: tuple[ExplorationData, ...]


def exploration_data(
    explorable: Explorable, explored: ExplorationResult, place: EvidencePlace
) -> ExplorationData:
    """Return an exploration as plain data."""
    search = explorable.search
    return ExplorationData(
        scenario=search.scenario,
        set=search.specification.set_name,
        formula=search.query.text,
        vary=tuple(
            Variation(name=variable.name, unit=variable.unit, low=str(variable.low), high=str(variable.high))
            for variable in explorable.variables
        ),
        values=_findings(explored.findings, place),
        boundaries=tuple(_boundary(x, place) for x in explored.boundaries),
        searches=explored.searches,
        drives=explored.drives,
        extremes=tuple(_extreme(x, place) for x in explored.extremes),
    )


def _findings(findings: Sequence[PointFinding], place: EvidencePlace) -> tuple[PointFindingData, ...]:
    return tuple(_finding(x, place) for x in findings)


def _finding(x: PointFinding, place: EvidencePlace) -> PointFindingData:
    shown = x.answer if x.answer is not None and x.answer.is_final else None
    return PointFindingData(
        at=tuple(map(str, x.at)),
        verdict=x.verdict,
        formula=x.query.text,
        reason=x.reason,
        number=x.number,
        evidence=None if shown is None else place(x.name, shown),
        assuming=x.assuming,
    )


def _side(x: PointFinding | None, place: EvidencePlace) -> PointFindingData | None:
    return None if x is None else _finding(x, place)


def _boundary(x: SweepBoundary, place: EvidencePlace) -> BoundaryData:
    return BoundaryData(
        held=_finding(x.inside, place), missed=_finding(x.outside, place), surely=_side(x.excluded, place)
    )


def _extreme(x: Extreme, place: EvidencePlace) -> ExtremeData:
    return ExtremeData(
        sense=x.measure.sense,
        measure=x.measure.text,
        when=x.measure.when,
        unit=unit_text(x.measure.dimension),
        point=tuple(map(str, x.point)),
        best=_side(x.best, place),
        missed=_side(x.outside, place),
        surely=_side(x.excluded, place),
        endless=x.endless,
        searches=x.searches,
    )
