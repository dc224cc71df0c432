"""The answer of ``roadproof road``: the roads of a map."""

from typing import Annotated, Final, Literal

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.answers.drive import LaneletField
from roadproof.evidence.codec import Doc
from roadproof.runtime.records import dataclass
from roadproof.world.road import Zone

SCHEMA: Final = "roadproof/road/1"


@dataclass(frozen=True, kw_only=True)
class ZoneSpanData:
    """A span of the road where lanelets are in a zone."""

    zone: Zone
    begin: Annotated[float, Doc("In m along the road.")]
    end: Annotated[float, Doc("In m along the road.")]


@dataclass(frozen=True, kw_only=True)
class StretchData:
    """A road in one direction."""

    select: Annotated[str, Doc("What --road takes.")]
    name: Annotated[str, Doc("Its name in the map; may be empty.")]
    length: Annotated[float, Doc("In m.")]
    direction: Annotated[str, Doc("Whether its lanes are driven along s of the map or against it.")]
    lanes: Annotated[tuple[int, int], Doc("The least and the greatest number of lanes side by side.")]
    zones: tuple[ZoneSpanData, ...]
    radius: Annotated[float | None, Doc("Of the sharpest bend, in m; null where the road is straight.")]
    width_error: Annotated[float, Doc("How far edges of lanelets are at most from those of the lanes, in m.")]
    length_share: Annotated[float, Doc("By which share lengths along lanes differ at most from those in s.")]
    length_metres: Annotated[float, Doc("By how many m a whole lane is at most longer or shorter than in s.")]
    lanelets: Annotated[tuple[LaneletField, ...], Doc("Rectangles by s and d.")]
    refused: Annotated[str | None, Doc("Why it cannot be used; null where it can.")]


@dataclass(frozen=True, kw_only=True)
class MapData:
    """The parts of a map that can be selected."""

    schema: Literal["roadproof/road/1"] = SCHEMA
    roadproof: shared.Version
    map: Annotated[str, Doc("The file.")]
    stretches: tuple[StretchData, ...]
    left_out: headings.LeftOutParts = ()
