"""What a formula is on one trace: a drive, samples, or vehicles of a recording."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from math import isfinite
from pathlib import Path
from typing import Any, TypeAlias, Unpack

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answers.shared import bends
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.evidence.heading import heading
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import JsonObject
from roadproof.extension import entries, imported
from roadproof.extensions.traffic.answers import monitor as kept
from roadproof.extensions.traffic.answers.monitor import Override, Place, Truth
from roadproof.extensions.traffic.evaluate import on_trace as driven
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.extensions.traffic.evaluate.observed import (
    FirstAnswer,
    Spans,
    answer_where_they_stand,
    observe_drive,
    observe_samples,
)
from roadproof.extensions.traffic.evaluate.one_trace import (
    OneTrace,
    is_pair,
    of_columns,
    play_samples,
    read_pair,
    read_samples,
    read_vehicles,
    refuse_unmeasured,
    sample_drive,
    with_causes,
)
from roadproof.extensions.traffic.formats.source import ReadDrive
from roadproof.extensions.traffic.formats.sources import has_numbers
from roadproof.extensions.traffic.formats.table import Frame, columns_of
from roadproof.extensions.traffic.keywords import MonitorKeywords
from roadproof.extensions.traffic.report.one_trace import as_text, draw_strips
from roadproof.extensions.traffic.settings import Monitor
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.definitions import Definitions, What, definitions_of, load
from roadproof.frontends.api.settings import as_road, positive
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.value_types import RoadLike
from roadproof.library.bind import bind, values_with
from roadproof.library.roles import cast_of, subject_in, vehicle_order
from roadproof.library.scenarios import SUBJECT, Scenario, lane_owner
from roadproof.library.specification import Library, Query
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode
from roadproof.world.length_error import LengthError, length_error_of
from roadproof.world.road import Road
from roadproof.world.unread import left_out_in, unread_of_road

# A path, a judged drive, a drive file, a trace that was read, or columns by name: arrays, or a frame.
TraceLike: TypeAlias = str | Path | JudgedDrive | DriveFile | OneTrace | Mapping[str, Any] | Frame
_CODES: dict[Truth, ExitCode] = {
    "true": ExitCode.AS_EXPECTED,
    "false": ExitCode.UNEXPECTED,
    "undecided": ExitCode.UNKNOWN,
}


@dataclass(frozen=True, repr=False)
class MonitorAnswer(Table):
    """The answer on one trace, with the definitions of ``library``; ``place`` says on which trace."""

    library: Library
    observed: FirstAnswer
    place: Place
    notes: tuple[str, ...] = ()
    road: Road | None = None
    decisions: tuple[Decision, ...] = ()

    @property
    def length_error(self) -> LengthError | None:
        """How far lengths in lanes of the road are from those in s; None where it is straight."""
        return length_error_of(self.road)

    @property
    def left_out(self) -> tuple[str, ...]:
        """The notes on vehicles and parts of the file that were left out."""
        return left_out_in(self.notes)

    @property
    def verdict(self) -> Truth:
        """At the first sample: "true", "false", or "undecided" where what comes after the trace decides."""
        return self.observed.verdict

    @property
    def robustness(self) -> tuple[float, float]:
        """Bounds of the margin by which it holds; equal where nothing after the trace matters."""
        return self.observed.margin

    @property
    def exit_code(self) -> ExitCode:
        return _CODES[self.verdict]

    def rows(self) -> list[Row]:
        """A row for each span in which a part is true or undecided: part, verdict, begin, end (s)."""
        return [
            {"part": strip.name, "verdict": verdict, "begin": begin, "end": end}
            for strip in self.observed.strips
            for verdict, spans in (("true", strip.true), ("undecided", strip.undecided))
            for begin, end in spans
        ]

    def as_data(self) -> JsonObject:
        """As the plain data of ``--json``."""
        x = self.observed
        answer = kept.Answer(
            **heading(kept.SCHEMA, self.library),
            length_error=bends(self.road),
            formula=x.formula,
            view=x.view,
            end=x.convention,
            verdict=x.verdict,
            under_the_other_end=x.other,
            robustness=(_finite(x.margin[0]), _finite(x.margin[1])),
            decides=x.decides,
            seconds=x.seconds,
            dt=str(x.dt),
            parts=tuple(
                kept.Part(
                    formula=strip.name,
                    true=_ended(strip.true),
                    undecided=_ended(strip.undecided),
                    exact=strip.exact,
                )
                for strip in x.strips
            ),
            notes=self.notes,
            left_out=self.left_out,
            drivers=tuple(map(driven.as_kept, self.decisions)),
            **vars(self.place),
        )
        return write(answer)

    def plot(self) -> Picture:
        """A strip for each part."""
        return picture(draw_strips(self.observed))

    def __str__(self) -> str:
        return "\n".join((as_text(self.observed), *driven.driver_lines(self.decisions), str(self.place)))

    def __repr__(self) -> str:
        return f"<Monitored: {self.verdict}>"


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None


def _ended(spans: Spans) -> kept.Spans:
    """Spans of which one that never ends has no end."""
    return tuple((begin, _finite(end)) for begin, end in spans)


def trace(columns: "Mapping[str, Any] | Frame", road: RoadLike = "main-2") -> OneTrace:
    """A trace out of columns: numpy arrays by name, or a frame of polars or pandas.

    Columns are ``time`` (s), ``vehicle`` (a name), ``s d`` (front-left corner, m), ``v_lon v_lat`` (m/s),
    ``a_lon a_lat`` (m/s^2), ``length width`` (m): a row a time and vehicle, in equal steps. Raises
    ``InputError`` with column, row, value and rule.
    """
    known = as_road(road)
    made = of_columns(columns_of(columns), known)
    return replace(made, notes=(*unread_of_road(known), *made.notes))


@takes(Monitor)
def monitor(
    what: What, on: TraceLike, using: Definitions | None = None, **options: Unpack[MonitorKeywords]
) -> MonitorAnswer:
    """Where a formula holds on one trace.

    ``on``: a drive (judged exactly in dense time unless ``view`` is "recorded"; then sampled every ``dt`` s),
    an OpenSCENARIO file (samples, unless ``view`` is "dense"),
    columns as for ``trace`` or a CSV or Parquet file of them on ``road`` (by default that beside the file, or
    main-2), or vehicles of a recording such as "highd/01_tracks.csv:12,15" on ``frames``. What a drive file
    says of set, readings and parameters holds where ``using`` is None. ``lanes``: for each free lane its
    name, or a vehicle, whose lane at the start it is. ``roles``: a vehicle by role, such as {"SV": "Ego"}; by
    default the vehicle of that name, for SV also the only one called ego, hero or the like, and the others in
    the order of the file where they are as many as roles are left. ``end``: what the end of a recorded trace
    means. ``drivers``: driver models that are put in place of SV, from the start on; so are those whose
    boundary the formula names. Raises ``InputError``, ``UsageError``, ``TextError``.
    """
    given = Monitor.of(options)
    if isinstance(on, str | Path) and str(on).endswith(".json"):
        return _on_drive(what, load_drive(Path(on)), str(on), using, given)
    if isinstance(on, JudgedDrive | DriveFile):
        return _on_drive(what, on.file if isinstance(on, JudgedDrive) else on, "drive", using, given)
    if given.view == "dense" and isinstance(on, str | Path) and Path(on).suffix in entries("drives"):
        return _on_given_drive(what, Path(str(on)), definitions_of(using), given)
    if given.view == "dense":
        raise UsageError("--view dense requires a drive or OpenSCENARIO file: others have samples only")
    home = definitions_of(using)
    return _on_trace(what, _read(on, given), home, home.all_values(), {}, given)


def _read(on: "str | Path | OneTrace | Mapping[str, Any] | Frame", given: Monitor) -> OneTrace:
    road, names = given.road, dict(given.roles or {})
    if isinstance(on, OneTrace):
        if names and on.names:
            raise UsageError(f"roles={names}: the vehicles of this trace have roles already")
        return on
    if not isinstance(on, str | Path):
        return trace(on, road or "main-2")
    if Path(on).suffix in (".csv", ".parquet", *entries("traces")) and not has_numbers(Path(on)):
        return read_samples(Path(on), None if road is None else as_road(road), given.strict)
    if isinstance(road, Road):
        raise UsageError(f"--road: {on} is a recording; name a road by its name, path or map, or omit it")
    chart = None if road is None else str(road)
    if is_pair(str(on)):
        if names:
            raise UsageError(f"--roles: the order of the vehicles in {on} says their roles; omit --roles")
        return read_pair(str(on), given.frames, given.strict, chart)
    if names:
        return read_vehicles(Path(on), _numbers(names), given.frames, str(on), given.strict, chart)
    raise InputError(
        f"{on}: a trace is a drive (.json), samples (.csv, .parquet or .xosc), or vehicles of a recording "
        "such as highd/01_tracks.csv:12,15; --roles SV=12,POV=15 names them, too"
    )


def _numbers(names: Mapping[str, str]) -> dict[str, int]:
    """The numbers of vehicles of a recording. Raises ``UsageError``."""
    for role, name in names.items():
        if not (name.isascii() and name.isdecimal() and len(name) < 10):
            raise UsageError(f"--roles {role}={name}: vehicles of recordings have numbers, as SV=12,POV=15")
    return {role: int(name) for role, name in names.items()}


def of_file(file: DriveFile) -> Definitions:
    """The definitions under which a drive file was judged."""
    home = load(file.set_name, options=file.options)
    return Definitions(home.specification, home.sets, file.values)


def _on_drive(
    what: What, file: DriveFile, source: str, using: Definitions | None, given: Monitor
) -> MonitorAnswer:
    home = using or of_file(file)
    values = values_with(home.library, {**file.values, **home.values})
    step = positive("dt", given.dt, "s")
    samples = sample_drive(file.drive, file.road, file.horizon, step, source)
    overruled = tuple(_overruled(file, home, values))
    if given.view == "recorded":
        answer = _on_trace(what, samples, home, values, file.lanes, given)
        return replace(answer, place=replace(answer.place, overruled=overruled))
    number, query = home.numbered(what, samples.lanes)
    roles = cast_of([*samples.lanes], query.vehicles, given.roles or {}, f"{source}: roles")
    played, drive = play_samples(samples, roles), file.drive
    drive = drive.cast({roles.called(name): name for name in drive.vehicles})
    lanes = _lanes(home, query, number, played, file.lanes, given)
    formula = bind(query.formula, file.road, lanes, values)
    observed = observe_drive(query.text, formula, drive, file.horizon, step)
    place = _place(played, home, query, lanes, overruled)
    casts = driven.casts_of(home, query, number, tuple(given.drivers))
    found = tuple(driven.decisions_on(replace(file, drive=drive), casts, home, values))
    notes = (*samples.notes, *answer_where_they_stand(query.text, formula, played.batch, given.end))
    return MonitorAnswer(home.library, observed, place, notes, file.road, found)


def _on_given_drive(what: What, path: Path, home: Definitions, given: Monitor) -> MonitorAnswer:
    if given.road is not None:
        raise UsageError(f"--road: {path} has the road of its storyboard; omit --road")
    read: ReadDrive = imported(entries("drives")[path.suffix])
    found = read(path)
    set_name, formula = home.specification.set_name, "true"
    file = DriveFile(None, set_name, formula, found.horizon, {}, {}, {}, found.road, found.drive)
    answer = _on_drive(what, file, str(path), home, given)
    return replace(answer, notes=(*answer.notes, found.note))


def _overruled(file: DriveFile, home: Definitions, values: Mapping[str, Fraction]) -> Iterator[Override]:
    specification = home.specification
    for name, value in file.values.items():
        if values[name] != value:
            yield Override(what=f"parameter {name}", asked=str(values[name]), said=str(value))
    for name, reading in file.options.items():
        if specification.options.get(name) != reading:
            asked = str(specification.options.get(name))
            yield Override(what=f"option {name}", asked=asked, said=reading)
    if specification.set_name != file.set_name:
        yield Override(what="set", asked=specification.set_name, said=file.set_name)


def _on_trace(
    what: What,
    samples: OneTrace,
    home: Definitions,
    values: Mapping[str, Fraction],
    known: Mapping[str, str],
    given: Monitor,
) -> MonitorAnswer:
    number, query = home.numbered(what, samples.lanes)
    if not samples.names:
        try:
            roles = cast_of([*samples.lanes], query.vehicles, given.roles or {}, f"{samples.source}: roles")
        except InputError as error:
            raise with_causes(error, left_out_in(samples.notes)) from None
        samples = play_samples(samples, roles)
    lanes = _lanes(home, query, number, samples, known, given)
    formula = bind(query.formula, samples.road, lanes, values)
    refuse_unmeasured(samples, formula)
    observed = observe_samples(query.text, formula, samples.batch, given.end)
    place = _place(samples, home, query, lanes)
    casts = driven.casts_of(home, query, number, tuple(given.drivers))
    found = tuple(driven.decisions_on(samples, casts, home, values))
    notes = (*samples.notes, *answer_where_they_stand(query.text, formula, samples.batch, given.end))
    return MonitorAnswer(home.library, observed, place, notes, samples.road, found)


def _place(
    samples: OneTrace,
    home: Definitions,
    query: Query,
    lanes: Mapping[str, str],
    overruled: tuple[Override, ...] = (),
) -> Place:
    return Place(
        trace=samples.source,
        start=samples.first,
        set_name=home.alone.set_name,
        road=samples.road.name,
        lanes=lanes,
        overruled=overruled,
        roles={role: samples.names[role] for role in vehicle_order(query.vehicles) if role in samples.names},
    )


def _lanes(
    home: Definitions,
    query: Query,
    number: int | None,
    samples: OneTrace,
    known: Mapping[str, str],
    given: Monitor,
) -> dict[str, str]:
    """A lane for each free lane of the formula: as asked for, as in the file, or a vehicle's."""
    missing = [name for name in query.vehicles if name not in samples.lanes]
    if missing:
        raise InputError(
            f"{query.text}: mentions {', '.join(missing)}, but {samples.source} has "
            f"{', '.join(samples.lanes)}; name other vehicles or another formula"
        )
    at_start = {own: samples.lanes[role] for role, own in samples.names.items()} | dict(samples.lanes)
    lanes = {**known, **{name: at_start.get(lane, lane) for name, lane in (given.lanes or {}).items()}}
    scenario = None if number is None else Scenario(number, home.specification.set_name)
    subject = subject_in(samples.lanes) or SUBJECT
    usual = subject if scenario is None else lane_owner(home.specification, scenario)
    for name in query.lanes:
        if not lanes.get(name):
            lanes[name] = samples.lanes.get(usual, "")
        if not lanes[name]:
            raise InputError(f"lane {name}: {usual} is in no lane at the start; add --lane {name}=LANE")
    return {name: lanes[name] for name in query.lanes}
