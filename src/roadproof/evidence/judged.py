"""Drives that have been judged: the formula of a drive file elaborated with the library at hand, and the
exact judge asked, no solver.
"""

from collections.abc import Callable

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers.drive import DriveSays, TrueTimes
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import DriveFile, drive_data, natural_of, read_drive
from roadproof.evidence.strict import JsonObject
from roadproof.library.bind import bind, values_with, without_empty_windows
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library, Query, Specification
from roadproof.reasons import NO_REASON, Reason, Why
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


@dataclass(frozen=True, init=False)
class JudgedDrive:
    """A drive file that stands: its formula holds on its drive. Only judging makes one.

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
