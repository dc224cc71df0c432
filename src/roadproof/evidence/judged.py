"""Judged drives: the exact judge evaluates the formula of a drive file, read with the library at hand."""

from html import escape
from pathlib import Path

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers.drive import DriveVerdictData, TrueTimesData
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import DriveFile, drive_data
from roadproof.evidence.strict import JsonObject
from roadproof.library.bind import bind, values_with, without_empty_windows
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library, Query, Specification
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.files import write_json
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import Judgement, judge
from roadproof.semantics.exact.replay import first_overlap

_READ = "read of a file"


@dataclass(frozen=True)
class Ruling:
    """The result of judging a drive file; ``reason`` says why its claim does not hold.

    ``readable``: whether the library has all definitions that the claim uses.
    """

    judgement: Judgement | None
    reason: Reason
    readable: bool = True

    @property
    def accepted(self) -> bool:
        return not self.reason


def judge_file(file: DriveFile, library: Library) -> Ruling:
    """Judge the formula on the drive in dense, unbounded time; the verdict in the file is ignored."""
    try:
        query = _read(library.select(file.set_name, file.options), file.formula)
    except RoadproofError as error:
        return Ruling(None, ReasonKind.TOLD(error), readable=False)
    try:
        missing = set(query.lanes) - set(file.lanes)
        if missing:
            raise InputError(f"the file names no lane for {', '.join(sorted(missing))}")
        for name, lane in file.lanes.items():
            if lane not in file.road.lanes:
                raise InputError(f"lane {name}={lane}: the road has {', '.join(file.road.lanes)}")
        absent = set(query.vehicles) - set(file.drive.vehicles)
        if absent:
            known = f"; it has {', '.join(file.drive.vehicles)}" if file.drive.vehicles else ""
            raise InputError(f"the file has no vehicle {', '.join(sorted(absent))}{known}")
        formula = bind(query.formula, file.road, file.lanes, values_with(library, file.values))
        judgement = judge(without_empty_windows(formula), file.drive)
    except RoadproofError as error:
        return Ruling(None, ReasonKind.TOLD(error))
    if not judgement.holds:
        return Ruling(judgement, ReasonKind.DOES_NOT_HOLD(file.formula))
    if not file.overlaps_allowed:
        overlap = first_overlap(file.drive, file.horizon)
        if overlap is not None:
            return Ruling(judgement, ReasonKind.TOLD(overlap))
    return Ruling(judgement, NO_REASON)


def _read(specification: Specification, formula: str) -> Query:
    """Return the parsed formula of a file; each is parsed once. Raises ``TextError``."""
    known = specification.memo
    if (_READ, formula) not in known:
        known[_READ, formula] = read_claim(specification, formula, "formula")
    query: Query = known[_READ, formula]
    return query


class RejectedError(InputError):
    """The error for a drive file that the judge rejects; its text is the reason."""


@dataclass(frozen=True, init=False, repr=False)
class JudgedDrive:
    """A drive file whose formula holds on its drive; only judging creates one.

    It prints as a few lines: the formula, the road, and how each vehicle starts and moves.

    ``natural``: whether the search was restricted to natural drives (``encode.build.Assumptions``); None if
    the drive does not come from a search.
    """

    file: DriveFile
    judgement: Judgement
    natural: bool | None

    def __init__(self, file: DriveFile, library: Library, natural: bool | None = None) -> None:
        """Raise ``RejectedError`` if the judge rejects the file."""
        ruling = judge_file(file, library)
        if not ruling.accepted or ruling.judgement is None:
            raise RejectedError(ruling.reason)
        object.__setattr__(self, "file", file)
        object.__setattr__(self, "judgement", ruling.judgement)
        object.__setattr__(self, "natural", natural)

    def as_data(self) -> JsonObject:
        """Return the JSON of the drive file, with the verdict and the times of each definition."""
        return drive_data(self.file, DriveVerdictData(natural=self.natural, times=true_times(self.judgement)))

    def save(self, path: str | Path) -> Path:
        """Write the drive as a file that ``check``, ``export`` and the studio read; the write is atomic.

        Raises ``InputError`` if it cannot be written.
        """
        write_json(Path(path), self.as_data())
        return Path(path)

    def __repr__(self) -> str:
        return f"<drive of {self.file.formula}@{self.file.set_name}: {', '.join(self.file.drive.vehicles)}>"

    def __str__(self) -> str:
        return "\n".join([self._heading, *(" ".join(filter(None, x)) for x in self._rows[1:])])

    def _repr_html_(self) -> str:
        first, *others = ("".join(f"<td>{escape(x)}</td>" for x in row) for row in self._rows)
        body = "".join(f"<tr>{row}</tr>" for row in others)
        heading = first.replace("td>", "th>")
        return f"<p><b>{escape(self._heading)}</b></p><table><tr>{heading}</tr>{body}</table>"

    @property
    def _heading(self) -> str:
        file = self.file
        lanes = "".join(f"  {name}={lane}" for name, lane in file.lanes.items())
        return f"{file.formula}  {file.set_name}  WITNESSED  road {file.road.name}{lanes}"

    @property
    def _rows(self) -> list[tuple[str, ...]]:
        """A heading row, then for each vehicle its start in SI units and its number of pieces of motion."""
        heading = ("vehicle", "kind", "place", "left side", "speed along", "speed across", "motion")
        rows: list[tuple[str, ...]] = [heading]
        for name, motion in self.file.drive.vehicles.items():
            start = (f"s={float(motion.s):.4g} m", f"d={float(motion.d):.4g} m")
            speed = (f"v_lon={float(motion.v_lon):.4g} m/s", f"v_lat={float(motion.v_lat):.4g} m/s")
            count = len(motion.pieces)
            rows.append(
                (name, motion.kind or "", *start, *speed, f"{count} piece{'' if count == 1 else 's'}")
            )
        return rows


def times_data(judgement: Judgement) -> list[JsonObject]:
    """Return ``true_times`` as JSON."""
    return [write(x) for x in true_times(judgement)]


def true_times(judgement: Judgement) -> tuple[TrueTimesData, ...]:
    """Return the times at which each definition in the formula is true."""
    return tuple(
        TrueTimesData(formula=f"{part.name}({', '.join(part.arguments)})", true=str(truth))
        for part, truth in judgement.named()
    )
