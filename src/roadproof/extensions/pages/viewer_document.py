"""The document that the viewer in a browser reads: a drive or a recorded trace, and formulas on it."""

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass
from typing import NamedTuple

from roadproof.frontends.report.drive_data import Danger
from roadproof.library.uses import Place
from roadproof.runtime.records import dataclass
from roadproof.world.road import Zone

SCHEMA = "roadproof/viewer/1"


class Span(NamedTuple):
    """From when to when (s) something is true, without end where ``end`` is None; which ends belong to it."""

    begin: float
    end: float | None
    has_begin: bool = True
    has_end: bool = True


@dataclass(frozen=True)
class PartView:
    """A part of a formula with when it is ``true``; ``open``: when that depends on what comes later.

    ``op``: name, and, or, not, F, G, U, compare, truth or part; ``children``: places in the list of parts.
    """

    op: str
    text: str
    children: Sequence[int]
    true: Sequence[Span]
    open: Sequence[Span] | None = None
    exact: str = ""
    says: str | None = None
    words: str | None = None
    margins: Sequence[float | None] | None = None


@dataclass(frozen=True)
class FormulaView:
    """A formula with its parts, or with an ``error`` in place of all else.

    ``more``: how many parts were left out; ``step``: seconds between margins; ``because``: by the places of
    parts, when they make one part what it is at an instant; ``said``: where in texts.
    """

    role: str
    formula: str
    set: str
    error: str | None = None
    text: str | None = None
    sentence: str | None = None
    holds: bool | None = None
    undecided: bool | None = None
    parts: Sequence[PartView] | None = None
    more: int | None = None
    step: float | None = None
    because: Mapping[str, Sequence[Span]] | None = None
    said: Sequence[Place] | None = None


@dataclass(frozen=True)
class LaneletView:
    """A lanelet with its extent (m), None where it has no end."""

    lane: str
    zone: Zone
    s: Sequence[float | None]
    d: Sequence[float]


class LengthErrorView(NamedTuple):
    """By how much lengths in lanes differ at most from those in s: at one place, and on a whole lane."""

    per_cent: float
    metres: float


@dataclass(frozen=True)
class RoadView:
    """A road; of one with bends the ``line`` along which s is measured, and what that does to lengths.

    ``line``: s, x, y and heading (m, rad) at places some metres apart; ``error``: in per cent and metres.
    """

    name: str
    lanelets: Sequence[LaneletView]
    line: Sequence[Sequence[float]] | None = None
    error: LengthErrorView | None = None


@dataclass(frozen=True)
class VehicleView:
    """``knots``: time, place, speed, acceleration and jerk, along and across, where these change (SI)."""

    length: float
    width: float
    knots: Sequence[Sequence[float]]


@dataclass(frozen=True)
class DistanceView:
    """``gap`` and RSS distance ``needed`` (m) at each sample; ``one_behind``: who is behind, or right."""

    direction: str
    one: str
    other: str
    gap: Sequence[float | None]
    needed: Sequence[float | None]
    one_behind: Sequence[bool]


@dataclass(frozen=True)
class DriveView:
    """Road, vehicles by name, and distances every ``grain`` s up to the ``horizon``."""

    set: str
    horizon: float
    grain: float
    lanes: Mapping[str, str]
    road: RoadView
    vehicles: Mapping[str, VehicleView]
    distances: Sequence[DistanceView]
    dangers: Sequence[Danger] = ()


@dataclass(frozen=True)
class Document:
    """All of it; ``file``: the drive file as plain data, None of a recorded trace."""

    title: str
    drive: DriveView
    file: object
    formulas: Sequence[FormulaView]

    def as_json(self) -> dict[str, object]:
        """Plain data; what is None is left out of formulas and parts."""
        head = {"schema": SCHEMA, "title": self.title, "verdict": {}, "drive": _plain(self.drive)}
        return {**head, "file": self.file, "formulas": _plain(self.formulas)}


def _plain(value: object) -> object:
    match value:
        case Place(source=source, at=at):
            return {"source": source, "from": [at.line, at.column], "to": [at.end_line, at.end_column]}
        case Mapping():
            return {name: _plain(x) for name, x in value.items()}
        case list() | tuple():
            return [_plain(x) for x in value]
        case _ if is_dataclass(value):
            return {name: _plain(x) for name, x in vars(value).items() if x is not None}
        case _:
            return value
