"""The heading of every answer, and the fields of an answer on a road."""

from typing import TYPE_CHECKING, Annotated, TypeAlias, TypedDict

from roadproof.evidence.answers.shared import Fingerprint, Signals, Version
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.evidence.schema_notes import SharedType
from roadproof.extension import entries, import_entry
from roadproof.runtime.records import dataclass
from roadproof.world.length_error import length_error_of
from roadproof.world.not_read import road_not_read_note
from roadproof.world.road import Road


@dataclass(frozen=True, kw_only=True)
class LengthErrorData:
    """The relative and absolute error of lengths along s, on a road with bends."""

    per_cent: Annotated[float, Rule(minimum=0), Doc("At one place.")]
    metres: Annotated[float, Rule(minimum=0), Doc("On the whole way along a lane.")]


LengthErrorField: TypeAlias = Annotated[
    LengthErrorData,
    Doc("By how much lengths in lanes differ at most from those in s; left out on straight roads."),
    SharedType("length_error"),
]


LeftOutParts: TypeAlias = Annotated[
    tuple[str, ...],
    LEFT_OUT,
    Doc("Notes on vehicles and on parts of files that were left out, such as of the map of the road."),
    SharedType("left_out"),
]


class RoadFields(TypedDict):
    """The fields of ``OnRoad`` as keywords."""

    length_error: LengthErrorData | None
    left_out: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class OnRoad:
    """The additional fields of an answer on a road that the question may name."""

    length_error: Annotated[LengthErrorField | None, LEFT_OUT] = None
    left_out: LeftOutParts = ()

    @staticmethod
    def of_road(road: Road | None) -> RoadFields:
        """Return the fields of an answer on a road."""
        return {"length_error": bends(road), "left_out": road_not_read_note(road)}


def bends(road: Road | None) -> LengthErrorData | None:
    """Return the error of lengths on a road; None if it is straight."""
    error_of_road = length_error_of(road)
    if error_of_road is None:
        return None
    return LengthErrorData(per_cent=float(100 * error_of_road.share), metres=float(error_of_road.metres))


@dataclass(frozen=True, kw_only=True)
class BaseHeading:
    """The heading of every answer."""

    schema: str
    roadproof: Version
    library: Fingerprint
    signals: Annotated[Signals | None, LEFT_OUT] = None


def with_modifiers(heading: type[BaseHeading]) -> type[BaseHeading]:
    """Return a heading with the fields by which extensions say that a question is modified."""
    more = tuple(import_entry(x) for x in entries("headings").values())
    about: dict[str, object] = {
        "__doc__": heading.__doc__,
        "__module__": heading.__module__,
        "__annotations__": {},
    }
    made: type[BaseHeading] = dataclass(frozen=True, kw_only=True)(
        type(heading.__name__, (*more, heading), about)
    )
    return made


if TYPE_CHECKING:
    AnswerHeading = BaseHeading
else:

    @with_modifiers
    @dataclass(frozen=True, kw_only=True)
    class AnswerHeading(BaseHeading):
        """The heading of an answer whose question extensions may modify."""
