"""What a concrete test shows: judged exactly where it is a drive, monitored where it is samples."""

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.catalogue.asked import DangerQuestion, Key, Questions
from roadproof.extensions.catalogue.entries import Concrete, Freedom
from roadproof.extensions.catalogue.kept import Shown, Why
from roadproof.extensions.catalogue.playing import cast_samples, choices, no_role, play_drive
from roadproof.extensions.catalogue.traces import digest_of, is_samples, roles_in, traces_of
from roadproof.extensions.catalogue.why import Course, signals_of, why_none
from roadproof.extensions.drivers.restriction import restriction_of, unrestricted
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, decide_drive, decide_trace
from roadproof.extensions.traffic.evaluate.faults import faults_of
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, is_pair
from roadproof.library.scenarios import LANE, PAIR, SUBJECT, endangered, name_of, number_in
from roadproof.library.scenarios import roles as scenario_roles
from roadproof.library.specification import Specification
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.semantics.exact.algebraic import approximate
from roadproof.semantics.exact.exact import DriveJudge, LazyJudge
from roadproof.semantics.exact.signals import DriveSignals
from roadproof.semantics.exact.truth import START, Cut
from roadproof.semantics.sampled.compiled import compile
from roadproof.verdict import Verdict
from roadproof.world.length_error import told_bends
from roadproof.world.signals import SignalName

_STATE: tuple[SignalName, ...] = ("s", "d", "v_lon")
ENDANGERED = "endangered"
"""What a test shows in which vehicles are safe and come into danger, whatever scenario that is."""
GAP = "gap"
"""Danger that no scenario says how, for any lane and in any roles."""


@dataclass(frozen=True)
class ConcreteAnswer:
    """What a test shows. ``begins``: how it begins, numbers by name; ``claims``: with those of its file.

    ``dense``: whether it was judged in dense time; ``others``: parameters that its file gives other values
    than are asked for. ``notes``: in what its samples contradict themselves. ``made_with``: parameters,
    readings and spec set of its file that are not those asked for; ``rejected``: why the judge rejects its
    file, with the file's own values. ``fault``: why it could not be read. ``why``: why it shows none.
    ``sha256``: the digest of its files when it was judged (``digest_of``). ``decisions``: what becomes of its
    scenarios under driver models. ``roles``: what the test calls the vehicle of each role, where that is not
    the role.
    """

    entry: Concrete
    claims: tuple[str, ...]
    shown: tuple[Shown, ...] = ()
    begins: Mapping[str, float] = field(default_factory=dict)
    dense: bool = False
    others: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    made_with: tuple[str, ...] = ()
    rejected: str = ""
    fault: str = ""
    why: Why | None = None
    sha256: str = ""
    decisions: tuple[Decision, ...] = ()
    roles: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def names(self) -> frozenset[str]:
        """All that it shows."""
        return frozenset(x.what for x in self.shown)

    @property
    def verdict(self) -> Verdict:
        """COVERED where it shows something, else GAPS."""
        return Verdict.COVERED if self.shown else Verdict.GAPS


def show(
    entry: Concrete, asked: Questions, freedom: Freedom, drivers: Drivers | None = None
) -> ConcreteAnswer:
    """Look at one test, and ask ``drivers`` of it. A test that cannot be read is answered with a fault."""
    digest = digest_of(entry.place)
    try:
        if entry.fault:
            raise InputError(entry.fault)
        if entry.place.endswith(".json") and not is_pair(entry.place):
            found = _of_drive(entry, load_drive(Path(entry.place)), asked, freedom, drivers)
        else:
            found = _of_traces(entry, asked, freedom, drivers)
    except InputError as error:
        found = ConcreteAnswer(entry, entry.claims, fault=str(error))
    return replace(_borne_out(found, asked), sha256=digest)


def _borne_out(answer: ConcreteAnswer, asked: Questions) -> ConcreteAnswer:
    """Return an answer without scenarios that begin as a restriction says and do not end so under its model.

    The restriction is a formula of a state; the model that is put into the test decides. Classes of the same
    vehicles are left out with them.
    """
    restriction = restriction_of(asked.specification.options)
    if restriction is None:
        return answer
    model, side, decided = restriction.model, restriction.side, answer.decisions
    sides = {(x.scenario, x.vehicles): x.side for x in decided if x.driver == model}
    wrong = {
        (x.what, x.vehicles): sides.get((x.what, x.vehicles), "undecided")
        for x in answer.shown
        if number_in(x.what) in restriction.scenarios and sides.get((x.what, x.vehicles)) != side
    }
    others = {vehicles for _, vehicles in wrong}

    def stays(x: Shown) -> bool:
        is_class = number_in(x.what) is None and x.what != ENDANGERED
        return (x.what, x.vehicles) not in wrong and not (is_class and x.vehicles in others)

    left = tuple(filter(stays, answer.shown))
    told = (
        f"{what} begins as {side}, but is {found} with {model} in place of SV"
        for (what, _), found in wrong.items()
    )
    return replace(answer, shown=left, notes=(*answer.notes, *told))


# --- drives --------------------------------------------------------------------------------------


def _of_drive(
    entry: Concrete, file: DriveFile, asked: Questions, freedom: Freedom, drivers: Drivers | None
) -> ConcreteAnswer:
    claims = entry.claims
    if file.scenario is not None and file.set_name == asked.specification.set_name and not claims:
        claims = (name_of(file.scenario),)
    others = tuple(name for name, value in file.values.items() if asked.values.get(name, value) != value)
    ruling = judge_file(_as_written(file, asked.specification), asked.specification.library)
    if not ruling.readable and drivers is not None:
        ruling = judge_file(file, drivers.specification.library)
    roles = roles_in(entry, tuple(file.drive.vehicles), asked.role_names)
    played = play_drive(file, roles)
    shown = all_shown_by(played, asked, freedom)
    chosen = tuple(choices(asked.roles, asked.all_roles, tuple(played.drive.vehicles), freedom.roles))
    why = None if _has_scenario(shown) else why_not(file, played, asked, freedom)
    decided = () if drivers is None else decisions_on(played, shown, drivers)
    notes = (
        *(() if ruling.readable else (f"its own formula cannot be read here: {ruling.reason}",)),
        *((roles.note,) if roles.note else ()),
        *filter(None, (told_bends(file.road),)),
        *(() if chosen or asked.role_names & {*played.drive.vehicles} else (no_role(played.drive.vehicles),)),
    )
    return ConcreteAnswer(
        entry,
        claims,
        tuple(replace(x, vehicles=roles.own(x.vehicles)) for x in shown),
        begins_of(played),
        True,
        others,
        notes=notes,
        made_with=tuple(_made_with(file, asked, drivers)),
        rejected=ruling.reason if ruling.readable else "",
        why=why,
        decisions=tuple(replace(x, vehicles=roles.own(x.vehicles)) for x in decided),
        roles=roles.played(asked.role_names),
    )


def why_not(file: DriveFile, played: DriveFile, asked: Questions, freedom: Freedom) -> Why | None:
    """Why a drive shows no scenario; ``played``: with vehicles called as their roles."""
    chosen = choices(asked.roles, asked.all_roles, tuple(played.drive.vehicles), freedom.roles)
    named = tuple(x for x in chosen if asked.role_names >= {*x[1]})
    course = Course(DriveSignals(played.drive), file.road, file.horizon, named, _lanes(file, freedom.lanes))
    return why_none(course, asked)


def decisions_on(file: DriveFile, shown: Iterable[Shown], drivers: Drivers) -> tuple[Decision, ...]:
    """What becomes of each scenario that a drive shows, whichever lane it is for."""
    first: dict[tuple[str, tuple[str, ...]], Shown] = {}
    for x in shown:
        first.setdefault((x.what, x.vehicles), x)
    return tuple(y for x in first.values() for y in _decided(file, x, drivers))


def _decided(file: DriveFile, shown: Shown, drivers: Drivers) -> Iterator[Decision]:
    """As ``decide_drive``, with the vehicles called as the roles that they play."""
    names = scenario_roles(len(shown.vehicles))
    played = replace(file, drive=file.drive.cast(dict(zip(names, shown.vehicles, strict=True))))
    for x in decide_drive(played, drivers, shown.what, names, shown.at):
        yield replace(x, vehicles=shown.vehicles)


def _as_written(file: DriveFile, specification: Specification) -> DriveFile:
    """The file with scenarios that begin as the library says, where a driver model is asked about."""
    options = unrestricted(specification).options
    changed = {name: x for name, x in options.items() if specification.options[name] != x}
    return replace(file, options={**changed, **file.options})


def _made_with(file: DriveFile, asked: Questions, drivers: Drivers | None) -> Iterator[str]:
    """What the file was made with, and is not asked with; nothing of what the definitions do not speak of."""
    home = asked.specification
    options, values = dict(home.options), dict(asked.values)
    if drivers is not None:
        options, values = {**drivers.specification.options, **options}, {**drivers.values, **values}
    if file.set_name != home.set_name:
        yield f"set {file.set_name}"
    yield from (f"{k} = {v}" for k, v in file.options.items() if options.get(k, v) != v)
    yield from (f"{k} = {v} (SI)" for k, v in file.values.items() if values.get(k, v) != v)


def all_shown_by(file: DriveFile, asked: Questions, freedom: Freedom) -> tuple[Shown, ...]:
    """As ``shown_by``, gaps too."""
    shown = shown_by(file, asked, freedom)
    return (*shown, *_gap(file, asked, shown))


def names_shown(drive: JudgedDrive, asked: Questions) -> tuple[str, ...]:
    """All that a drive shows in the roles and the lane of its file, by name, in order."""
    return tuple(sorted({x.what for x in shown_from_start(drive, asked)}))


def shown_from_start(drive: JudgedDrive, asked: Questions) -> tuple[Shown, ...]:
    """Return what a drive shows in the roles and the lane of its file, which is looked at once."""
    return asked.remembered.of(
        ("shown", id(drive)), drive, lambda: all_shown_by(drive.file, asked, Freedom())
    )


def _gap(file: DriveFile, asked: Questions, shown: tuple[Shown, ...]) -> Iterator[Shown]:
    """The danger of a drive, from its start on, where no scenario holds for any lane and in any roles.

    Nothing where scenarios begin as a driver model says: a drive that does not is no gap.
    """
    if restriction_of(asked.specification.options) is not None:
        return
    danger = next((x for x in shown if x.what == ENDANGERED and x.at == 0), None)
    if danger is not None and {x.what for x in shown} == {ENDANGERED}:
        wider = {x.what for x in shown_by(file, asked, Freedom(roles=True, lanes=True))}
        if wider == {ENDANGERED}:
            kinds = () if asked.gaps is None else asked.gaps.of_drive(file, endangered(danger.vehicles))
            yield from (replace(danger, what=what) for what in (GAP, *kinds))


def shown_by(file: DriveFile, asked: Questions, freedom: Freedom) -> tuple[Shown, ...]:
    """What a drive shows, judged in dense time: parts that formulas share are judged once."""
    shown: dict[tuple[str, tuple[str, ...], str], Shown] = {}
    kind = LazyJudge if asked.is_always_judged else DriveJudge
    for roles, vehicles in choices(asked.roles, asked.all_roles, tuple(file.drive.vehicles), freedom.roles):
        judge = kind.on(file.drive.cast(dict(zip(roles, vehicles, strict=True))))
        for lane in _lanes(file, freedom.lanes):
            formulas = asked.on(file.road, roles, roles, lane)
            for cut, true in _instants(judge, formulas, file, freedom.start):
                for what in _what(asked, roles, true):
                    at = approximate(cut.point)
                    shown.setdefault((what, vehicles, lane), Shown(what, vehicles, lane, at))
    return _sorted(shown.values())


def _lanes(file: DriveFile, free: bool) -> tuple[str, ...]:
    return (file.lanes[LANE],) if LANE in file.lanes and not free else file.road.lanes


def _instants(
    judge: DriveJudge | LazyJudge, formulas: Mapping[Key, Formula], file: DriveFile, free: bool
) -> Iterator[tuple[Cut, frozenset[Key]]]:
    """The start, or all instants within the horizon at which something changes, with what is true."""
    if not free:
        yield START, frozenset(key for key, formula in formulas.items() if judge.holds(formula))
        return
    truths = {key: judge.visit(formula) for key, formula in formulas.items()}
    cuts = {START, *(cut for truth in truths.values() for cut in truth.cuts if cut.point <= file.horizon)}
    for cut in sorted(cuts):
        yield cut, frozenset(key for key, truth in truths.items() if bisect_right(truth.cuts, cut) % 2)


def _what(asked: Questions, roles: tuple[str, ...], true: frozenset[Key]) -> Iterator[str]:
    yield from asked.shown(roles, true)
    if DangerQuestion() in true:
        yield ENDANGERED


# --- samples -------------------------------------------------------------------------------------


def _of_traces(
    entry: Concrete, asked: Questions, freedom: Freedom, drivers: Drivers | None
) -> ConcreteAnswer:
    decisions: dict[tuple[str, tuple[str, ...]], tuple[Decision, ...]] = {}
    shown: dict[tuple[str, tuple[str, ...], str], Shown] = {}
    begins: dict[str, float] = {}
    endangered_in: dict[Shown, OneTrace] = {}
    first: OneTrace | None = None
    notes: dict[str, None] = {}
    played = dict(entry.roles)
    for trace, told in traces_of(entry, asked.role_names):
        faults = faults_of(trace)
        if faults:
            raise InputError(f"{entry.place}: the samples are no motion: {'; '.join(faults)}")
        first = first or trace
        if is_samples(entry):
            played = {role: name for role, name in told.items() if role in asked.role_names}
        notes |= dict.fromkeys((*trace.notes, *filter(None, (told_bends(trace.road),))))
        for roles, vehicles in choices(
            asked.roles, asked.all_roles, tuple(trace.lanes), freedom.roles, any_way=True
        ):
            called = tuple(told.get(name, name) for name in vehicles)
            cast, names = cast_samples(trace, roles, vehicles)
            for lane in trace.road.lanes:
                for what, at in _monitored(cast, asked, roles, names, lane):
                    shown.setdefault((what, called, lane), Shown(what, called, lane, at))
                    if drivers is not None and (what, called) not in decisions:
                        made = decide_trace(cast, drivers, what, names, at, called)
                        decisions[what, called] = tuple(made)
        dangers = [x for x in shown.values() if x.what == ENDANGERED]
        if dangers and {*trace.lanes} == {*PAIR}:
            endangered_in.setdefault(min(dangers, key=lambda x: x.at), trace)
        begins = begins or _begins(_states(trace))
    gaps = [
        gap
        for danger, trace in endangered_in.items()
        if {x.what for x in shown.values()} == {ENDANGERED}
        for gap in _gap_in_samples(trace, asked, danger)
    ]
    why = None if first is None or _has_scenario(shown.values()) else _why(first, asked, freedom)
    found = (*_sorted(shown.values()), *gaps)
    decided = tuple(x for made in decisions.values() for x in made)
    return ConcreteAnswer(
        entry, entry.claims, found, begins, notes=tuple(notes), why=why, decisions=decided, roles=played
    )


def _has_scenario(shown: Iterable[Shown]) -> bool:
    return any(number_in(x.what) is not None for x in shown)


def _why(trace: OneTrace, asked: Questions, freedom: Freedom) -> Why | None:
    """Why no scenario holds from the first sample on; None on measured roads, whose lanes are not known."""
    if trace.batch.given:
        return None
    end = (int(trace.batch.lengths[0]) - 1) * trace.batch.dt
    found = choices(asked.roles, asked.all_roles, tuple(trace.lanes), freedom.roles, any_way=True)
    roles = tuple(x for x in found if asked.role_names >= {*x[1]})
    return why_none(Course(signals_of(trace.batch), trace.road, end, roles, trace.road.lanes), asked)


def _monitored(
    trace: OneTrace, asked: Questions, roles: tuple[str, ...], vehicles: tuple[str, ...], lane: str
) -> Iterator[tuple[str, float]]:
    """What is shown, whatever comes after the trace, with the time of the first sample (s)."""
    monitor = compile(asked.on(trace.road, roles, vehicles, lane))
    answers = monitor.evaluate(trace.batch, "truncated", at="all").answers
    truths = {key: answer.true[:, 0] for key, answer in answers.items()}
    table = np.stack(list(truths.values()))
    changes = np.flatnonzero(np.any(table[:, 1:] != table[:, :-1], axis=0)) + 1
    for sample in (0, *changes.tolist()):
        true = frozenset(key for key, truth in truths.items() if truth[sample])
        for what in _what(asked, roles, true):
            yield what, float(sample * trace.batch.dt)


def _gap_in_samples(trace: OneTrace, asked: Questions, danger: Shown) -> Iterator[Shown]:
    """The danger of SV and POV as a gap, where no scenario covers it, whatever comes after the trace."""
    sample = round(danger.at / float(trace.batch.dt))
    kinds = () if asked.gaps is None else asked.gaps.of_trace(trace, sample)
    if kinds:
        yield from (replace(danger, what=what) for what in (GAP, *kinds))


def _states(trace: OneTrace) -> dict[str, tuple[float, ...]]:
    signals = trace.batch.signals
    return {n: tuple(float(signals[x, n][0, 0]) for x in _STATE) for n in trace.lanes}


def begins_of(file: DriveFile) -> dict[str, float]:
    """How a drive begins, numbers by name."""
    states = {name: (m.s, m.d, m.v_lon) for name, m in file.drive.vehicles.items()}
    return _begins({name: tuple(map(float, state)) for name, state in states.items()})


# --- both ----------------------------------------------------------------------------------------


def _begins(states: Mapping[str, tuple[float, ...]]) -> dict[str, float]:
    """Speeds, and how far each other vehicle is ahead of and left of SV, or the first one (m/s, m)."""
    first = SUBJECT if SUBJECT in states else next(iter(states))
    s, d, v_lon = states[first]
    begins = {f"v_lon({first})": v_lon}
    for name, (other_s, other_d, speed) in sorted(states.items()):
        if name == first:
            continue
        begins |= {
            f"v_lon({name})": speed,
            f"s({name}) - s({first})": other_s - s,
            f"d({name}) - d({first})": other_d - d,
        }
    return begins


@cache
def signal_of(begin: str) -> SignalName:
    """Which signal a number of ``begins_of`` is of: ``s`` of ``s(POV) - s(SV)``."""
    called = {x.name for x in syntax.walk(parse_claim(begin).body) if isinstance(x, syntax.Call)}
    return next(x for x in _STATE if x in called)


def _sorted(shown: Iterable[Shown]) -> tuple[Shown, ...]:
    return tuple(sorted(shown, key=lambda x: (x.at, x.what, x.vehicles, x.lane)))
