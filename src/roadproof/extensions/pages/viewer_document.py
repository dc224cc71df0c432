"""The document that the drive viewer reads: a drive or a recorded trace, and formulas on it."""

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass
from typing import NamedTuple

from roadproof.extensions.pages.drive_data import Danger
from roadproof.extensions.pages.places import FormulaPlace
from roadproof.runtime.records import dataclass
from roadproof.world.road import Zone

SCHEMA = "roadproof/viewer/1"


class TruthSpan(NamedTuple):
    """A span of time (s) in which something is true, without end where ``end`` is None; which ends belong to
    it.
    """

    begin: float
    end: float | None
    has_begin: bool = True
    has_end: bool = True


@dataclass(frozen=True)
class PartView:
    """A part of a formula; ``true``: when it is true; ``open``: when that depends on later samples.

    ``op``: name, and, or, not, F, G, U, compare, truth or part; ``children``: indices in the list of parts.
    """

    op: str
    text: str
    children: Sequence[int]
    true: Sequence[TruthSpan]
    open: Sequence[TruthSpan] | None = None
    exact: str = ""
    says: str | None = None
    words: str | None = None
    margins: Sequence[float | None] | None = None


@dataclass(frozen=True)
class FormulaView:
    """A formula with its parts, or with an ``error`` instead of everything else.

    ``more``: the number of parts left out; ``step``: seconds between margins; ``because``: when each part, by
    its index, makes an explained part true or false; ``said``: the places of these parts in texts.
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
    because: Mapping[str, Sequence[TruthSpan]] | None = None
    said: Sequence[FormulaPlace] | None = None


@dataclass(frozen=True)
class LaneletView:
    """A lanelet with its extent (m), None where it has no end."""

    lane: str
    zone: Zone
    s: Sequence[float | None]
    d: Sequence[float]


class LengthErrorView(NamedTuple):
    """The largest difference of lengths in lanes from those in s: at one place, and on a whole lane."""

    per_cent: float
    metres: float


@dataclass(frozen=True)
class ViewerRoad:
    """A road; for one with bends also its reference ``line``, and the ``error`` of lengths.

    ``line``: s, x, y and heading (m, rad) at places some metres apart; ``error``: in per cent and metres.
    """

    name: str
    lanelets: Sequence[LaneletView]
    line: Sequence[Sequence[float]] | None = None
    error: LengthErrorView | None = None


@dataclass(frozen=True)
class VehicleView:
    """A vehicle; ``knots``: time, place, speed, acceleration and jerk, along and across, where these change
    (SI).
    """

    length: float
    width: float
    knots: Sequence[Sequence[float]]


@dataclass(frozen=True)
class DistanceView:
    """The ``gap`` and RSS distance ``needed`` (m) at each sample; ``one_behind``: whether ``one`` is behind,
    or right.
    """

    direction: str
    one: str
    other: str
    gap: Sequence[float | None]
    needed: Sequence[float | None]
    one_behind: Sequence[bool]


@dataclass(frozen=True)
class DriveView:
    """The road, vehicles by name, and distances every ``grain`` s up to the ``horizon``."""

    set: str
    horizon: float
    grain: float
    lanes: Mapping[str, str]
    road: ViewerRoad
    vehicles: Mapping[str, VehicleView]
    distances: Sequence[DistanceView]
    dangers: Sequence[Danger] = ()


@dataclass(frozen=True)
class ViewerDocument:
    """The whole document; ``file``: the drive file as plain data, None for a recorded trace."""

    title: str
    drive: DriveView
    file: object
    formulas: Sequence[FormulaView]

    def as_json(self) -> dict[str, object]:
        """Return plain data; fields that are None are left out of formulas and parts."""
        head = {"schema": SCHEMA, "title": self.title, "verdict": {}, "drive": _plain(self.drive)}
        return {**head, "file": self.file, "formulas": _plain(self.formulas)}


def _plain(value: object) -> object:
    match value:
        case FormulaPlace(source=source, at=at):
            return {"source": source, "from": [at.line, at.column], "to": [at.end_line, at.end_column]}
        case Mapping():
            return {name: _plain(x) for name, x in value.items()}
        case list() | tuple():
            return [_plain(x) for x in value]
        case _ if is_dataclass(value):  # open: any data class of this module
            return {name: _plain(x) for name, x in vars(value).items() if x is not None}
        case _:  # open: plain JSON values
            return value
