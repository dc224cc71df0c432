"""The table beside a file: what each row encodes, and where that is written."""

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from roadproof.engines.encode.problem import LimitKind
from roadproof.extensions.encoding.naming import WHOLE, QuestionPart
from roadproof.extensions.encoding.posed import PosedSearch
from roadproof.frontends.report.csv_table import csv_text
from roadproof.library.specification import source_of
from roadproof.library.uses import parts_of_claim
from roadproof.logic.formula import Application, Compare
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.runtime.records import dataclass

HEADER = ("row", "part", "step", "vehicles", "condition", "within", "file", "line")
CONDITIONS: Mapping[LimitKind, str] = {
    LimitKind.MOTION: "places follow from speeds by the trapezoid rule",
    LimitKind.ACCELERATION: "the acceleration is within the limits of the vehicle",
    LimitKind.LATERAL_SHARE: "the speed across the road is at most a share of the speed along it",
    LimitKind.JUMP: "the acceleration changes by at most the jump of the vehicle",
    LimitKind.REACH: "vehicles start within the reach of each other",
    LimitKind.ROAD: "the box is on the road",
    LimitKind.CLEARANCE: "the boxes are apart",
    LimitKind.LANE: "the box is in a lane",
    LimitKind.ONE_WAY: "the vehicle moves across the road in one direction only",
    LimitKind.STEADY: "the acceleration lasts two steps",
    LimitKind.START: "the drive begins so",
    LimitKind.OTHER_DRIVE: "the drive differs clearly from another one",
}
"""What rows of each kind ask for; a test keeps the table complete."""


@dataclass(frozen=True)
class DefinitionPlace:
    """The file and the line at which a definition is written."""

    file: str
    line: int


@dataclass(frozen=True)
class RowDescriber:
    """A describer of rows of a posed search."""

    posed: PosedSearch

    @cached_property
    def places(self) -> Mapping[str, DefinitionPlace]:
        """The places of the definitions that the formula uses, by name."""
        specification = self.posed.search.specification
        used = parts_of_claim(specification, self.posed.query.claim).named
        files = {name: source_of(specification.library, x).name for name, x in used.items()}
        return {name: DefinitionPlace(files[name], x.at.line) for name, x in used.items() if files[name]}

    def condition(self, part: QuestionPart) -> str:
        """Return what a part asks for, in words or as a comparison."""
        match None if part.origin is None else part.origin.part:
            case LimitKind() as limit:
                return CONDITIONS[limit]
            case Compare() as comparison:
                return text(as_syntax(comparison))
            case _:  # open: a part that several rows encode
                return "one of its parts holds"

    def place(self, part: QuestionPart) -> DefinitionPlace | None:
        """Return where the innermost definition around a part is written."""
        application = part.definition
        return None if application is None else self.places.get(application.name)

    def sentence(self, name: str, part: QuestionPart) -> str:
        """Return in words which part of the question a row encodes."""
        who = f" of {' and '.join(part.vehicles)}" if part.vehicles else ""
        about = part.limit or ("the formula" if part.name == WHOLE else part.name)
        place = self.place(part)
        at = "" if place is None else f" ({place.file}, line {place.line})"
        return f"row {name}: {about}{who} at step {part.step}{at}: {self.condition(part)}"

    def table(self, rows: Iterable[tuple[str, QuestionPart]]) -> str:
        """Return the table of rows as CSV."""
        return csv_text(HEADER, self._lines(rows))

    def _lines(self, rows: Iterable[tuple[str, QuestionPart]]) -> Iterator[tuple[object, ...]]:
        for name, part in rows:
            place = self.place(part)
            file, line = ("", "") if place is None else (place.file, place.line)
            around = " / ".join(x.name for x in part.path if isinstance(x, Application))
            vehicles = " ".join(part.vehicles)
            yield name, part.name, part.step, vehicles, self.condition(part), around, file, line
