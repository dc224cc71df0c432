"""An exploration as it is kept, and back."""

from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.analysis.explore.answer import (
    Boundary,
    Explorable,
    ExplorationResult,
    Extreme,
    Point,
    PointFinding,
)
from roadproof.analysis.explore.extreme import ExtremeQuestion, soughts_of
from roadproof.analysis.study.evidence_store import EvidenceStore
from roadproof.errors import InputError
from roadproof.evidence.answers import explore as kept
from roadproof.evidence.certificate import Certificate
from roadproof.library.specification import Query
from roadproof.world.units import unit_text

_EXTREME = ("best", "missed", "surely")


def as_kept(
    name: str, asked: Explorable, explored: ExplorationResult, shelf: EvidenceStore
) -> kept.Exploration:
    """What was explored under a ``name``, with which the names of its files begin."""
    search, writing = asked.search, _Writer(shelf)
    return kept.Exploration(
        scenario=search.scenario,
        set=search.specification.set_name,
        formula=search.query.text,
        vary=tuple(
            kept.Variation(name=knob.name, unit=knob.unit, low=str(knob.low), high=str(knob.high))
            for knob in asked.knobs
        ),
        values=tuple(writing.finding(x, f"{name}-value-{k:03}") for k, x in enumerate(explored.findings, 1)),
        boundaries=tuple(
            kept.Boundary(
                held=writing.finding(x.held, _boundary_file(name, k, "held")),
                missed=writing.finding(x.missed, _boundary_file(name, k, "missed")),
                surely=writing.side(x.surely, _boundary_file(name, k, "surely")),
            )
            for k, x in enumerate(explored.boundaries, 1)
        ),
        searches=explored.searches,
        drives=explored.drives,
        extremes=tuple(writing.extreme(x, name, k) for k, x in enumerate(explored.extremes, 1)),
        seconds=round(explored.seconds, 1),
    )


def ends_of(name: str, explored: ExplorationResult) -> list[tuple[str, PointFinding]]:
    """What was found at boundaries and as extremes, each with the name of its file without ``.json``."""
    ends: list[tuple[str, PointFinding | None]] = []
    ends += [(_boundary_file(name, k, "held"), x.held) for k, x in enumerate(explored.boundaries, 1)]
    ends += [(_extreme_file(name, x, k, "best"), x.best) for k, x in enumerate(explored.extremes, 1)]
    return [(file, finding) for file, finding in ends if finding is not None]


def _boundary_file(name: str, number: int, side: str) -> str:
    return f"{name}-boundary-{number}-{side}"


def _extreme_file(name: str, extreme: Extreme, number: int, side: str) -> str:
    return f"{name}-{extreme.measure.sense}-{number}-{side}"


class _Writer:
    """Puts evidence on the shelf; a certificate that serves several findings only once."""

    def __init__(self, shelf: EvidenceStore) -> None:
        self.shelf = shelf
        self.certificates: list[tuple[Certificate, object]] = []

    def finding(self, finding: PointFinding, file: str) -> kept.Finding:
        return kept.Finding(
            at=tuple(map(str, finding.at)),
            verdict=finding.verdict,
            formula=finding.query.text,
            reason=finding.reason,
            number=finding.number,
            drive=self.shelf.drive(f"{file}.json", finding.drive),
            certificate=self.certificate(finding.certificate, file),
            assuming=finding.assuming,
        )

    def side(self, finding: PointFinding | None, file: str) -> kept.Finding | None:
        return None if finding is None else self.finding(finding, file)

    def certificate(self, certificate: Certificate | None, file: str) -> object:
        if certificate is None:
            return None
        for known, file_or_data in self.certificates:
            if known == certificate:
                return file_or_data
        self.certificates.append((certificate, self.shelf.certificate(f"{file}.json", certificate)))
        return self.certificates[-1][1]

    def extreme(self, extreme: Extreme, name: str, number: int) -> kept.Extreme:
        measure, sides = extreme.measure, (extreme.best, extreme.missed, extreme.surely)
        best, missed, surely = (
            self.side(x, _extreme_file(name, extreme, number, side))
            for x, side in zip(sides, _EXTREME, strict=True)
        )
        return kept.Extreme(
            sense=measure.sense,
            measure=measure.text,
            when=measure.when,
            unit=unit_text(measure.dimension),
            point=tuple(map(str, extreme.point)),
            best=best,
            missed=missed,
            surely=surely,
            endless=extreme.endless,
            searches=extreme.searches,
        )


def explored_of(asked: Explorable, said: kept.Exploration, shelf: EvidenceStore) -> ExplorationResult:
    """The inverse of ``as_kept``. Raises ``InputError`` where it is no whole answer to what is asked."""
    reading = _Reader(asked, shelf)
    findings = tuple(reading.at_point(x) for x in said.values)
    if [x.at for x in findings] != asked.points:
        raise InputError(
            f"{len(findings)} findings, not at the {len(asked.points)} values that are asked for"
        )
    boundaries = tuple(reading.boundary(x) for x in said.boundaries)
    explored = ExplorationResult(findings, boundaries, (), said.searches, said.drives, said.seconds)
    soughts = [x for measure in asked.measures for x in soughts_of(asked, explored, measure)]
    if len(soughts) != len(said.extremes):
        raise InputError(f"{len(said.extremes)} extremes of the {len(soughts)} that are asked for")
    extremes = (reading.extreme(x, y) for x, y in zip(soughts, said.extremes, strict=True))
    return replace(explored, extremes=tuple(extremes))


@dataclass(frozen=True)
class _Reader:
    asked: Explorable
    shelf: EvidenceStore

    def at_point(self, said: kept.Finding) -> PointFinding:
        """A finding at a value of the knobs, of the grid or beside it."""
        return self.finding(said, self.asked.query(_at(said)))

    def boundary(self, said: kept.Boundary) -> Boundary:
        surely = None if said.surely is None else self.at_point(said.surely)
        return Boundary(self.at_point(said.held), self.at_point(said.missed), surely)

    def extreme(self, sought: ExtremeQuestion, said: kept.Extreme) -> Extreme:
        measure = sought.measure
        where = (measure.sense, measure.text, tuple(map(str, sought.point)))
        if (said.sense, said.measure, said.point) != where:
            raise InputError(f"an extreme of {said.measure}, where one of {measure.text} was asked for")
        best, missed, surely = (self.reached(sought, x) for x in said.sides.values())
        return Extreme(measure, sought.point, best, missed, surely, said.searches, said.endless)

    def reached(self, sought: ExtremeQuestion, said: kept.Finding | None) -> PointFinding | None:
        """A finding at a value of a measure, or at none."""
        if said is None:
            return None
        return self.finding(said, sought.query(next(iter(_at(said)), None)))

    def finding(self, said: kept.Finding, query: Query) -> PointFinding:
        if said.formula != query.text:
            raise InputError(f"a finding on {said.formula}, where one on {query.text} was asked for")
        return PointFinding(
            _at(said),
            query,
            verdict=said.verdict,
            reason=said.reason,
            drive=self.shelf.read_drive(said.drive),
            number=said.number,
            certificate=self.shelf.read_certificate(said.certificate),
        )


def _at(said: kept.Finding) -> Point:
    return tuple(Fraction(value) for value in said.at)
