"""The monitor of one trace: a drive, samples, or vehicles of a recording."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias, Unpack

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answers.headings import bends
from roadproof.evidence.codec import write
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.evidence.heading import heading
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.specifications import load_specs_beside
from roadproof.evidence.strict import LARGEST_INDEX, Fields, JsonObject, read_json
from roadproof.extension import entries, import_entry
from roadproof.extensions.traffic.answers import monitor as monitor_data
from roadproof.extensions.traffic.answers.monitor import MonitoredTraceData, OverrideData, Truth
from roadproof.extensions.traffic.evaluate import on_trace as driven
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.extensions.traffic.evaluate.margin_signal import RobustnessSignal
from roadproof.extensions.traffic.evaluate.observed import (
    MonitorResult,
    note_on_standing,
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
from roadproof.extensions.traffic.evaluate.signal_data import ended, finite, signal_data
from roadproof.extensions.traffic.formats.source import ReadDrive
from roadproof.extensions.traffic.formats.sources import has_numbers
from roadproof.extensions.traffic.formats.table import Frame, columns_of
from roadproof.extensions.traffic.keywords import MonitorKeywords
from roadproof.extensions.traffic.report.one_trace import as_text, draw_strips
from roadproof.extensions.traffic.scenario_parts import lane_owner
from roadproof.extensions.traffic.settings import MonitorSettings
from roadproof.frontends.api.definitions import Definitions, What, definitions_of, load
from roadproof.frontends.api.settings import as_road, positive
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.picture import Picture, picture
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.value_types import RoadLike
from roadproof.library.bind import bind, values_with
from roadproof.library.loading import bundled_library
from roadproof.library.roles import assign_roles, subject_in, vehicle_order
from roadproof.library.scenarios import SUBJECT, Scenario
from roadproof.library.specification import Library, Query
from roadproof.questions.question import QUESTION
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode
from roadproof.world.length_error import LengthError, length_error_of
from roadproof.world.not_read import left_out_in, road_not_read_note
from roadproof.world.road import Road

# A path, a judged drive, a drive file, a trace that was read, or columns by name: arrays, or a frame.
Columns: TypeAlias = Mapping[str, Any] | Frame
"""Columns by name: numpy arrays, lists, or a frame of polars or pandas."""
TraceLike: TypeAlias = str | Path | JudgedDrive | DriveFile | OneTrace | Columns
_CODES: dict[Truth, ExitCode] = {
    "true": ExitCode.AS_EXPECTED,
    "false": ExitCode.UNEXPECTED,
    "undecided": ExitCode.UNKNOWN,
}


@dataclass(frozen=True, repr=False)
class MonitorAnswer(Table):
    """The answer on one trace, with the definitions of ``library``; ``place`` says on which trace."""

    library: Library
    observed: MonitorResult
    place: MonitoredTraceData
    notes: tuple[str, ...] = ()
    road: Road | None = None
    decisions: tuple[Decision, ...] = ()

    @property
    def length_error(self) -> LengthError | None:
        """Return how far lengths in lanes of the road are from those in s; None where it is straight."""
        return length_error_of(self.road)

    @property
    def left_out(self) -> tuple[str, ...]:
        """The notes on vehicles and parts of the file that were left out."""
        return left_out_in(self.notes)

    @property
    def verdict(self) -> Truth:
        """The verdict at the first sample; "undecided" where it depends on what comes after the trace."""
        return self.observed.verdict

    @property
    def robustness(self) -> tuple[float, float]:
        """Bounds of the margin by which it holds; equal where nothing after the trace matters."""
        return self.observed.margin

    @property
    def robust_signal(self) -> RobustnessSignal | None:
        """The robustness over time, where the option ``robust_signal`` asked for it."""
        return self.observed.signal

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
        """Return the plain data of ``--json``."""
        x = self.observed
        answer = monitor_data.MonitorData(
            **heading(monitor_data.SCHEMA, self.library),
            length_error=bends(self.road),
            formula=x.formula,
            view=x.view,
            end=x.convention,
            verdict=x.verdict,
            under_the_other_end=x.other,
            robustness=(finite(x.margin[0]), finite(x.margin[1])),
            decides=x.decides,
            seconds=x.seconds,
            dt=str(x.dt),
            parts=tuple(
                monitor_data.FormulaPartData(
                    formula=strip.name,
                    true=ended(strip.true),
                    undecided=ended(strip.undecided),
                    exact=strip.exact,
                )
                for strip in x.strips
            ),
            notes=self.notes,
            left_out=self.left_out,
            drivers=tuple(map(driven.driver_verdict, self.decisions)),
            robust_signal=None if x.signal is None else signal_data(x.signal),
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


def trace(columns: Columns, road: RoadLike = "main-2") -> OneTrace:
    """A trace out of columns: numpy arrays by name, or a frame of polars or pandas.

    Columns are ``time`` (s), ``vehicle`` (a name), ``s d`` (front-left corner, m), ``v_lon v_lat`` (m/s),
    ``a_lon a_lat`` (m/s^2), ``length width`` (m): a row a time and vehicle, in equal steps. Raises
    ``InputError`` with column, row, value and rule.
    """
    known = as_road(road)
    made = of_columns(columns_of(columns), known)
    return replace(made, notes=(*road_not_read_note(known), *made.notes))


@takes(MonitorSettings)
def monitor(
    what: What, on: TraceLike, using: Definitions | None = None, **options: Unpack[MonitorKeywords]
) -> MonitorAnswer:
    """Return where a formula holds on one trace.

    ``on``: a drive (judged exactly in dense time unless ``view`` is "recorded"; then sampled every ``dt`` s),
    an OpenSCENARIO file (samples, unless ``view`` is "dense"),
    columns as for ``trace`` or a CSV or Parquet file of them on ``road`` (by default that beside the file, or
    main-2), or vehicles of a recording such as "highd/01_tracks.csv:12,15" on ``frames``. What a drive file
    says of set, readings and parameters holds where ``using`` is None. ``lanes``: for each free lane its
    name, or a vehicle, whose lane at the start it is. ``roles``: a vehicle by role, such as {"SV": "Ego"}; by
    default the vehicle of that name, for SV also the only one called ego, hero or the like, and the others in
    the order of the file where they are as many as roles are left. ``end``: what the end of a recorded trace
    means. ``robust_signal``: give the robustness over time, too. ``drivers``: driver models that are put in
    place of SV, from the start on; so are those whose boundary the formula names. Raises ``InputError``,
    ``UsageError``, ``TextError``.
    """
    settings = MonitorSettings.of(options)
    if isinstance(on, str | Path) and str(on).endswith(".json"):
        file = load_drive(Path(on))
        definitions = using or of_file(file, specifications_of(file, Path(on).parent))
        return _on_drive(what, file, str(on), definitions, settings)
    if isinstance(on, JudgedDrive | DriveFile):
        return _on_drive(what, on.file if isinstance(on, JudgedDrive) else on, "drive", using, settings)
    if settings.view == "dense" and isinstance(on, str | Path) and Path(on).suffix in entries("drives"):
        return _on_given_drive(what, Path(str(on)), definitions_of(using), settings)
    if settings.view == "dense":
        raise UsageError("--view dense requires a drive or OpenSCENARIO file: others have samples only")
    definitions = definitions_of(using)
    return _on_trace(what, _read(on, settings), definitions, definitions.all_values(), {}, settings)


def _read(on: str | Path | OneTrace | Columns, settings: MonitorSettings) -> OneTrace:
    road, names = settings.road, dict(settings.roles or {})
    if isinstance(on, OneTrace):
        if names and on.names:
            raise UsageError(f"roles={names}: the vehicles of this trace have roles already")
        return on
    if not isinstance(on, str | Path):
        return trace(on, road or "main-2")
    if Path(on).suffix in (".csv", ".parquet", *entries("traces")) and not has_numbers(Path(on)):
        return read_samples(Path(on), None if road is None else as_road(road), settings.strict)
    if isinstance(road, Road):
        raise UsageError(f"--road: {on} is a recording; name a road by its name, path or map, or omit it")
    chart = None if road is None else str(road)
    if is_pair(str(on)):
        if names:
            raise UsageError(f"--roles: the order of the vehicles in {on} says their roles; omit --roles")
        return read_pair(str(on), settings.frames, settings.strict, chart)
    if names:
        return read_vehicles(Path(on), _numbers(names), settings.frames, str(on), settings.strict, chart)
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


def of_file(file: DriveFile, specs: Iterable[Path] = ()) -> Definitions:
    """Return the definitions under which a drive file was judged, with the specifications beside it."""
    definitions = load(file.set_name, options=file.options, specs=specs)
    return Definitions(definitions.specification, definitions.sets, file.values)


def specifications_of(file: DriveFile, folder: Path) -> tuple[Path, ...]:
    """Return the specifications beside a drive that its options need. Raises ``InputError``."""
    head = folder / QUESTION
    if {*file.options} <= {*bundled_library().options} or not head.is_file():
        return ()
    content = read_json(head, LARGEST_INDEX)
    basis = content.get("basis") if isinstance(content, dict) else None
    return load_specs_beside(Fields(basis, str(head)), folder, ())[1] if isinstance(basis, dict) else ()


def _on_drive(
    what: What, file: DriveFile, source: str, using: Definitions | None, settings: MonitorSettings
) -> MonitorAnswer:
    definitions = using or of_file(file)
    values = values_with(definitions.library, {**file.values, **definitions.values})
    step = positive("dt", settings.dt, "s")
    samples = sample_drive(file.drive, file.road, file.horizon, step, source)
    overruled = tuple(_overruled(file, definitions, values))
    if settings.view == "recorded":
        answer = _on_trace(what, samples, definitions, values, file.lanes, settings)
        return replace(answer, place=replace(answer.place, overruled=overruled))
    number, query = definitions.numbered(what, samples.lanes)
    roles = assign_roles([*samples.lanes], query.vehicles, settings.roles or {}, f"{source}: roles")
    played, drive = play_samples(samples, roles), file.drive
    drive = drive.cast({roles.role_of(name): name for name in drive.vehicles})
    lanes = _lanes(definitions, query, number, played, file.lanes, settings)
    formula = bind(query.formula, file.road, lanes, values)
    observed = observe_drive(query.text, formula, drive, file.horizon, step, settings.robust_signal)
    place = _place(played, definitions, query, lanes, overruled)
    casts = driven.scenario_casts(definitions, query, number, tuple(settings.drivers))
    decisions = tuple(driven.decisions_on(replace(file, drive=drive), casts, definitions, values))
    notes = (*samples.notes, *note_on_standing(query.text, formula, played.batch, settings.end))
    return MonitorAnswer(definitions.library, observed, place, notes, file.road, decisions)


def _on_given_drive(
    what: What, path: Path, definitions: Definitions, settings: MonitorSettings
) -> MonitorAnswer:
    if settings.road is not None:
        raise UsageError(f"--road: {path} has the road of its storyboard; omit --road")
    read: ReadDrive = import_entry(entries("drives")[path.suffix])
    drive = read(path)
    set_name, formula = definitions.specification.set_name, "true"
    file = DriveFile(None, set_name, formula, drive.horizon, {}, {}, {}, drive.road, drive.drive)
    answer = _on_drive(what, file, str(path), definitions, settings)
    return replace(answer, notes=(*answer.notes, drive.note))


def _overruled(
    file: DriveFile, definitions: Definitions, values: Mapping[str, Fraction]
) -> Iterator[OverrideData]:
    specification = definitions.specification
    for name, value in file.values.items():
        if values[name] != value:
            yield OverrideData(what=f"parameter {name}", asked=str(values[name]), said=str(value))
    for name, reading in file.options.items():
        if specification.options.get(name) != reading:
            current = str(specification.options.get(name))
            yield OverrideData(what=f"option {name}", asked=current, said=reading)
    if specification.set_name != file.set_name:
        yield OverrideData(what="set", asked=specification.set_name, said=file.set_name)


def _on_trace(
    what: What,
    samples: OneTrace,
    definitions: Definitions,
    values: Mapping[str, Fraction],
    known: Mapping[str, str],
    settings: MonitorSettings,
) -> MonitorAnswer:
    number, query = definitions.numbered(what, samples.lanes)
    if not samples.names:
        try:
            roles = assign_roles(
                [*samples.lanes], query.vehicles, settings.roles or {}, f"{samples.source}: roles"
            )
        except InputError as error:
            raise with_causes(error, left_out_in(samples.notes)) from None
        samples = play_samples(samples, roles)
    lanes = _lanes(definitions, query, number, samples, known, settings)
    formula = bind(query.formula, samples.road, lanes, values)
    refuse_unmeasured(samples, formula)
    observed = observe_samples(query.text, formula, samples.batch, settings.end, settings.robust_signal)
    place = _place(samples, definitions, query, lanes)
    casts = driven.scenario_casts(definitions, query, number, tuple(settings.drivers))
    decisions = tuple(driven.decisions_on(samples, casts, definitions, values))
    notes = (*samples.notes, *note_on_standing(query.text, formula, samples.batch, settings.end))
    return MonitorAnswer(definitions.library, observed, place, notes, samples.road, decisions)


def _place(
    samples: OneTrace,
    definitions: Definitions,
    query: Query,
    lanes: Mapping[str, str],
    overruled: tuple[OverrideData, ...] = (),
) -> MonitoredTraceData:
    return MonitoredTraceData(
        trace=samples.source,
        start=samples.first,
        set_name=definitions.alone.set_name,
        road=samples.road.name,
        lanes=lanes,
        overruled=overruled,
        roles={role: samples.names[role] for role in vehicle_order(query.vehicles) if role in samples.names},
    )


def _lanes(
    definitions: Definitions,
    query: Query,
    number: int | None,
    samples: OneTrace,
    known: Mapping[str, str],
    settings: MonitorSettings,
) -> dict[str, str]:
    """A lane for each free lane of the formula: as asked for, as in the file, or a vehicle's."""
    missing = [name for name in query.vehicles if name not in samples.lanes]
    if missing:
        raise InputError(
            f"{query.text}: mentions {', '.join(missing)}, but {samples.source} has "
            f"{', '.join(samples.lanes)}; name other vehicles or another formula"
        )
    at_start = {own: samples.lanes[role] for role, own in samples.names.items()} | dict(samples.lanes)
    lanes = {**known, **{name: at_start.get(lane, lane) for name, lane in (settings.lanes or {}).items()}}
    scenario = None if number is None else Scenario(number, definitions.specification.set_name)
    subject = subject_in(samples.lanes) or SUBJECT
    usual = subject if scenario is None else lane_owner(definitions.specification, scenario)
    for name in query.lanes:
        if not lanes.get(name):
            lanes[name] = samples.lanes.get(usual, "")
        if not lanes[name]:
            raise InputError(f"lane {name}: {usual} is in no lane at the start; add --lane {name}=LANE")
    return {name: lanes[name] for name in query.lanes}
