"""An exploration as plain data, and back: the only place where its answers become JSON."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from roadproof.analysis.explore.answer import Boundary, Explorable, Explored, Extreme, PointFinding
from roadproof.analysis.explore.extreme import Sought, soughts_of
from roadproof.analysis.explore.knobs import Point
from roadproof.errors import InputError
from roadproof.evidence.certificate import Certificate
from roadproof.spec.query import Query
from roadproof.study.shelf import Shelf
from roadproof.units import unit_text
from roadproof.verdict import Verdict

_BOUNDARY = ("held", "missed", "surely")
_EXTREME = ("best", "missed", "surely")


def as_data(name: str, asked: Explorable, explored: Explored, shelf: Shelf) -> dict[str, Any]:
    """What was explored under a ``name``, with which the names of its files begin."""
    search, writing = asked.search, _Writing(shelf)
    data: dict[str, Any] = {
        "scenario": search.scenario,
        "set": search.specification.set_name,
        "formula": search.query.text,
        "vary": [
            {"name": knob.name, "unit": knob.unit, "low": str(knob.low), "high": str(knob.high)}
            for knob in asked.knobs
        ],
        "values": [writing.finding(x, f"{name}-value-{k:03}") for k, x in enumerate(explored.findings, 1)],
        "boundaries": [
            {side: writing.finding(getattr(x, side), _boundary_file(name, k, side)) for side in _BOUNDARY}
            for k, x in enumerate(explored.boundaries, 1)
        ],
        "searches": explored.searches,
        "drives": explored.drives,
        "extremes": [writing.extreme(x, name, k) for k, x in enumerate(explored.extremes, 1)],
        "seconds": round(explored.seconds, 1),
    }
    return data if shelf.folder is None else {**data, "stem": name}


def ends_of(name: str, explored: Explored) -> list[tuple[str, PointFinding]]:
    """What was found at boundaries and as extremes, each with the name of its file without ``.json``."""
    ends: list[tuple[str, PointFinding | None]] = []
    ends += [(_boundary_file(name, k, "held"), x.held) for k, x in enumerate(explored.boundaries, 1)]
    ends += [(_extreme_file(name, x, k, "best"), x.best) for k, x in enumerate(explored.extremes, 1)]
    return [(file, finding) for file, finding in ends if finding is not None]


def _boundary_file(name: str, number: int, side: str) -> str:
    return f"{name}-boundary-{number}-{side}"


def _extreme_file(name: str, extreme: Extreme, number: int, side: str) -> str:
    return f"{name}-{extreme.measure.sense}-{number}-{side}"


class _Writing:
    """Puts evidence on the shelf; a certificate that serves several findings only once."""

    def __init__(self, shelf: Shelf) -> None:
        self.shelf = shelf
        self.certificates: list[tuple[Certificate, object]] = []

    def finding(self, finding: PointFinding | None, file: str) -> dict[str, Any] | None:
        if finding is None:
            return None
        return {
            "at": [str(value) for value in finding.at],
            "verdict": str(finding.verdict),
            "formula": finding.query.text,
            "reason": finding.reason,
            "number": finding.number,
            "drive": self.shelf.drive(f"{file}.json", finding.drive),
            "certificate": self.certificate(finding.certificate, file),
            **({"assuming": list(finding.assuming)} if finding.assuming else {}),
        }

    def certificate(self, certificate: Certificate | None, file: str) -> object:
        if certificate is None:
            return None
        for known, kept in self.certificates:
            if known == certificate:
                return kept
        self.certificates.append((certificate, self.shelf.certificate(f"{file}.json", certificate)))
        return self.certificates[-1][1]

    def extreme(self, extreme: Extreme, name: str, number: int) -> dict[str, Any]:
        measure = extreme.measure
        sides = {
            side: self.finding(getattr(extreme, side), _extreme_file(name, extreme, number, side))
            for side in _EXTREME
        }
        return {
            "sense": measure.sense,
            "measure": measure.text,
            "when": measure.when,
            "unit": unit_text(measure.dimension),
            "point": [str(value) for value in extreme.point],
            **sides,
            "endless": extreme.endless,
            "searches": extreme.searches,
        }


def read_data(asked: Explorable, data: Mapping[str, Any], shelf: Shelf) -> Explored:
    """The inverse of ``as_data``. Raises ``InputError`` where it is no whole answer to what is asked."""
    reading = _Reading(asked, shelf)
    findings = tuple(reading.at_point(x) for x in data["values"])
    if [x.at for x in findings] != asked.points:
        raise InputError(
            f"{len(findings)} findings, not at the {len(asked.points)} values that are asked for"
        )
    explored = Explored(
        findings,
        tuple(reading.boundary(x) for x in data["boundaries"]),
        (),
        data["searches"],
        data["drives"],
        data["seconds"],
    )
    soughts = [x for measure in asked.measures for x in soughts_of(asked, explored, measure)]
    if len(soughts) != len(data["extremes"]):
        raise InputError(f"{len(data['extremes'])} extremes of the {len(soughts)} that are asked for")
    extremes = (reading.extreme(x, y) for x, y in zip(soughts, data["extremes"], strict=True))
    return replace(explored, extremes=tuple(extremes))


@dataclass(frozen=True)
class _Reading:
    asked: Explorable
    shelf: Shelf

    def at_point(self, said: Mapping[str, Any]) -> PointFinding:
        """A finding at a value of the knobs, of the grid or beside it."""
        return self.finding(said, self.asked.query(_at(said)))

    def boundary(self, said: Mapping[str, Any]) -> Boundary:
        held, missed = self.at_point(said["held"]), self.at_point(said["missed"])
        return Boundary(held, missed, None if said["surely"] is None else self.at_point(said["surely"]))

    def extreme(self, sought: Sought, said: Mapping[str, Any]) -> Extreme:
        measure = sought.measure
        where = (measure.sense, measure.text, tuple(map(str, sought.point)))
        if (said["sense"], said["measure"], tuple(said["point"])) != where:
            raise InputError(f"an extreme of {said['measure']}, where one of {measure.text} was asked for")
        best, missed, surely = (self.reached(sought, said[side]) for side in _EXTREME)
        return Extreme(measure, sought.point, best, missed, surely, said["searches"], said["endless"])

    def reached(self, sought: Sought, said: Mapping[str, Any] | None) -> PointFinding | None:
        """A finding at a value of a measure, or at none."""
        if said is None:
            return None
        value = next(iter(_at(said)), None)
        return self.finding(said, sought.query(value))

    def finding(self, said: Mapping[str, Any], query: Query) -> PointFinding:
        if said["formula"] != query.text:
            raise InputError(f"a finding on {said['formula']}, where one on {query.text} was asked for")
        return PointFinding(
            _at(said),
            Verdict(said["verdict"]),
            query,
            said["reason"],
            self.shelf.read_drive(said["drive"]),
            said["number"],
            self.shelf.read_certificate(said["certificate"]),
        )


def _at(said: Mapping[str, Any]) -> Point:
    return tuple(Fraction(value) for value in said["at"])
