"""Drives that have been judged: the formula of a drive file elaborated with the library at hand, and the
exact judge asked, no solver.
"""

from collections.abc import Callable
from html import escape
from pathlib import Path

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers.drive import DriveSays, TrueTimes
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import DriveFile, drive_data, natural_of, read_drive
from roadproof.evidence.strict import JsonObject
from roadproof.library.bind import bind, values_with, without_empty_windows
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library, Query, Specification
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.files import write_json
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import Judgement, judge
from roadproof.semantics.exact.replay import first_overlap

_READ = "read of a file"


@dataclass(frozen=True)
class Ruling:
    """Whether the file's claim stands; ``reason`` says why where it does not.

    ``readable``: whether the library at hand has all that the claim speaks of.
    """

    judgement: Judgement | None
    reason: Reason
    readable: bool = True

    @property
    def accepted(self) -> bool:
        return not self.reason


def judge_file(file: DriveFile, library: Library) -> Ruling:
    """Judge the drive on the formula in dense and unbounded time, with no look at the file's verdict."""
    try:
        query = _read(library.select(file.set_name, file.options), file.formula)
    except RoadproofError as error:
        return Ruling(None, Why.TOLD(error), readable=False)
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
        return Ruling(None, Why.TOLD(error))
    if not judgement.holds:
        return Ruling(judgement, Why.DOES_NOT_HOLD(file.formula))
    if not file.overlaps_allowed:
        overlap = first_overlap(file.drive, file.horizon)
        if overlap is not None:
            return Ruling(judgement, Why.TOLD(overlap))
    return Ruling(judgement, NO_REASON)


def _read(specification: Specification, formula: str) -> Query:
    """A formula of a file, each read once. Raises ``TextError``."""
    known = specification.worked_out
    if (_READ, formula) not in known:
        known[_READ, formula] = read_claim(specification, formula, "formula")
    query: Query = known[_READ, formula]
    return query


class RejectedError(InputError):
    """The judge rejects a drive file, for this reason."""


@dataclass(frozen=True, init=False, repr=False)
class JudgedDrive:
    """A drive file that stands: its formula holds on its drive. Only judging makes one.

    It prints as a few lines: the formula, the road, and how each vehicle starts and moves.

    ``natural``: whether it was looked for among natural drives (``encode.build.Assumptions``), None where it
    was not looked for.
    """

    file: DriveFile
    judgement: Judgement
    natural: bool | None

    def __init__(self, file: DriveFile, library: Library, natural: bool | None = None) -> None:
        """Raises ``RejectedError`` where the judge rejects the file."""
        ruling = judge_file(file, library)
        if not ruling.accepted or ruling.judgement is None:
            raise RejectedError(ruling.reason)
        object.__setattr__(self, "file", file)
        object.__setattr__(self, "judgement", ruling.judgement)
        object.__setattr__(self, "natural", natural)

    def as_data(self) -> JsonObject:
        """The drive file as plain data, with the verdict and with what is true when."""
        return drive_data(self.file, DriveSays(natural=self.natural, times=times_said(self.judgement)))

    def save(self, path: str | Path) -> Path:
        """Write the drive as a file that ``check``, ``export`` and the studio read, whole or not at all.

        Raises ``InputError`` where it cannot be written.
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
        """A heading, then how each vehicle starts, in SI units, and the number of its pieces of motion."""
        heading = ("vehicle", "kind", "place", "left side", "speed along", "speed across", "motion")
        rows: list[tuple[str, ...]] = [heading]
        for name, x in self.file.drive.vehicles.items():
            start = (f"s={float(x.s):.4g} m", f"d={float(x.d):.4g} m")
            speed = (f"v_lon={float(x.v_lon):.4g} m/s", f"v_lat={float(x.v_lat):.4g} m/s")
            count = len(x.pieces)
            rows.append((name, x.kind or "", *start, *speed, f"{count} piece{'' if count == 1 else 's'}"))
        return rows


class KnownDrive(JudgedDrive):
    """A drive that was judged before it was kept under a seal; it is judged again when it is looked at.

    Raises ``RejectedError`` then, where the judge rejects it.
    """

    _content: Callable[[], object]
    _where: str
    _library: Library

    def __init__(self, content: Callable[[], object], where: str, library: Library) -> None:
        self.__dict__.update(_content=content, _where=where, _library=library)

    def __getattr__(self, name: str) -> object:
        if name not in ("file", "judgement", "natural"):
            raise AttributeError(name)
        content, where = self._content(), self._where
        judged = JudgedDrive(read_drive(content, where), self._library, natural_of(content, where))
        self.__dict__.update(vars(judged))
        object.__setattr__(self, "__class__", JudgedDrive)  # from now on it is like any other
        return vars(judged)[name]

    def __eq__(self, other: object) -> bool:
        self.file, getattr(other, "file", None)
        return JudgedDrive.__eq__(self, other)

    def __reduce__(self) -> tuple[Callable[..., JudgedDrive], tuple[object, ...]]:
        return _judged, (self.file, self.judgement, self.natural)


def _judged(file: DriveFile, judgement: Judgement, natural: bool | None) -> JudgedDrive:
    """A drive that another process has judged."""
    made = object.__new__(JudgedDrive)
    made.__dict__.update(file=file, judgement=judgement, natural=natural)
    return made


def times_data(judgement: Judgement) -> list[JsonObject]:
    """As ``times_said``, as plain data."""
    return [write(x) for x in times_said(judgement)]


def times_said(judgement: Judgement) -> tuple[TrueTimes, ...]:
    """When each definition in the formula is true, as files tell it."""
    return tuple(
        TrueTimes(formula=f"{part.name}({', '.join(part.arguments)})", true=str(truth))
        for part, truth in judgement.named()
    )
