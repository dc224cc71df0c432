"""The targets that a drive shows in dense time, and the answer about a test that is a drive file."""

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.catalogue.catalogue_data import NearestScenario, ShownTarget
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer, has_scenario, in_order
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.initial_values import initial_values
from roadproof.extensions.catalogue.nearest_scenario import VehicleMotions, nearest_scenario
from roadproof.extensions.catalogue.role_choices import drive_in_roles, no_role_note, role_choices
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, GAP, TargetFormulas, TargetKey
from roadproof.extensions.catalogue.traces import roles_in
from roadproof.extensions.drivers.restriction import restriction_of, unrestricted
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, decide_drive
from roadproof.extensions.traffic.scenario_parts import danger_pair
from roadproof.library.scenarios import LANE, name_of
from roadproof.library.scenarios import roles as scenario_roles
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import DriveJudge, LazyJudge
from roadproof.semantics.exact.signals import DriveSignals
from roadproof.semantics.exact.truth import START, Cut
from roadproof.world.length_error import bend_note


def answer_of_drive(
    entry: ConcreteTest, file: DriveFile, formulas: TargetFormulas, freedom: Freedom, drivers: Drivers | None
) -> ConcreteAnswer:
    """Return the answer about a test that is a drive file, with the decisions of ``drivers``."""
    claims = entry.claims
    if file.scenario is not None and file.set_name == formulas.specification.set_name and not claims:
        claims = (name_of(file.scenario),)
    others = tuple(name for name, value in file.values.items() if formulas.values.get(name, value) != value)
    ruling = judge_file(_as_written(file, formulas.specification), formulas.specification.library)
    if not ruling.readable and drivers is not None:
        ruling = judge_file(file, drivers.specification.library)
    roles = roles_in(entry, tuple(file.drive.vehicles), formulas.role_names)
    played = drive_in_roles(file, roles)
    names = tuple(played.drive.vehicles)
    shown = all_targets_shown(played, formulas, freedom)
    is_cast = any(True for _ in role_choices(formulas.roles, formulas.all_roles, names, freedom.roles))
    why = None if has_scenario(shown) else nearest_on_drive(file, played, formulas, freedom)
    decisions = () if drivers is None else decisions_on(played, shown, drivers)
    notes = (
        *(() if ruling.readable else (f"its own formula cannot be read here: {ruling.reason}",)),
        *((roles.note,) if roles.note else ()),
        *filter(None, (bend_note(file.road),)),
        *(() if is_cast or formulas.role_names & {*names} else (no_role_note(names),)),
    )
    return ConcreteAnswer(
        entry,
        claims,
        tuple(replace(x, vehicles=roles.names_in_file(x.vehicles)) for x in shown),
        initial_values(played),
        True,
        others,
        notes=notes,
        made_with=tuple(_made_with(file, formulas, drivers)),
        rejected=ruling.reason if ruling.readable else "",
        why=why,
        decisions=tuple(replace(x, vehicles=roles.names_in_file(x.vehicles)) for x in decisions),
        roles=roles.played(formulas.role_names),
    )


def nearest_on_drive(
    file: DriveFile, played: DriveFile, formulas: TargetFormulas, freedom: Freedom
) -> NearestScenario | None:
    """Return the nearest scenario of a drive that shows none; ``played``: with vehicles named by role."""
    names = tuple(played.drive.vehicles)
    choices = role_choices(formulas.roles, formulas.all_roles, names, freedom.roles)
    in_roles = tuple(x for x in choices if formulas.role_names >= {*x[1]})
    motions = VehicleMotions(
        DriveSignals(played.drive), file.road, file.horizon, in_roles, _lanes(file, freedom.lanes)
    )
    return nearest_scenario(motions, formulas)


def _as_written(file: DriveFile, specification: Specification) -> DriveFile:
    """Return the file with the options of the library, where a driver model restricts scenarios."""
    options = unrestricted(specification).options
    changed = {name: x for name, x in options.items() if specification.options[name] != x}
    return replace(file, options={**changed, **file.options})


def _made_with(file: DriveFile, formulas: TargetFormulas, drivers: Drivers | None) -> Iterator[str]:
    """Yield the settings of a file that differ from the question's and occur in its definitions."""
    home = formulas.specification
    options, values = dict(home.options), dict(formulas.values)
    if drivers is not None:
        options, values = {**drivers.specification.options, **options}, {**drivers.values, **values}
    if file.set_name != home.set_name:
        yield f"set {file.set_name}"
    yield from (f"{k} = {v}" for k, v in file.options.items() if options.get(k, v) != v)
    yield from (f"{k} = {v} (SI)" for k, v in file.values.items() if values.get(k, v) != v)


# --- driver models -------------------------------------------------------------------------------


def decisions_on(file: DriveFile, shown: Iterable[ShownTarget], drivers: Drivers) -> tuple[Decision, ...]:
    """Return the decisions of driver models on each scenario of a drive, for any lane."""
    first: dict[tuple[str, tuple[str, ...]], ShownTarget] = {}
    for x in shown:
        first.setdefault((x.what, x.vehicles), x)
    return tuple(y for x in first.values() for y in _decisions(file, x, drivers))


def _decisions(file: DriveFile, shown: ShownTarget, drivers: Drivers) -> Iterator[Decision]:
    """Yield the decisions of ``decide_drive`` with vehicles named by their roles."""
    names = scenario_roles(len(shown.vehicles))
    played = replace(file, drive=file.drive.cast(dict(zip(names, shown.vehicles, strict=True))))
    for x in decide_drive(played, drivers, shown.what, names, shown.at):
        yield replace(x, vehicles=shown.vehicles)


# --- targets -------------------------------------------------------------------------------------


def all_targets_shown(file: DriveFile, formulas: TargetFormulas, freedom: Freedom) -> tuple[ShownTarget, ...]:
    """Return the targets that a drive shows, gaps included."""
    shown = targets_shown(file, formulas, freedom)
    return (*shown, *_gap(file, formulas, shown))


def names_shown(drive: JudgedDrive, formulas: TargetFormulas) -> tuple[str, ...]:
    """Return the names of all targets that a drive shows in the roles and the lane of its file, in order."""
    return tuple(sorted({x.what for x in targets_at_start(drive, formulas)}))


def targets_at_start(drive: JudgedDrive, formulas: TargetFormulas) -> tuple[ShownTarget, ...]:
    """Return the targets that a drive shows in the roles and the lane of its file, worked out once."""
    return formulas.cache.of(
        ("shown", id(drive)), drive, lambda: all_targets_shown(drive.file, formulas, Freedom())
    )


def _gap(file: DriveFile, formulas: TargetFormulas, shown: tuple[ShownTarget, ...]) -> Iterator[ShownTarget]:
    """Yield the danger from the start of a drive as a gap, where no scenario holds for any lane and roles.

    Nothing where scenarios begin as a driver model says: a drive that does not is no gap.
    """
    if restriction_of(formulas.specification.options) is not None:
        return
    danger = next((x for x in shown if x.what == ENDANGERED and x.at == 0), None)
    if danger is not None and {x.what for x in shown} == {ENDANGERED}:
        wider = {x.what for x in targets_shown(file, formulas, Freedom(roles=True, lanes=True))}
        if wider == {ENDANGERED}:
            pair = danger_pair(danger.vehicles)
            classes = () if formulas.gaps is None else formulas.gaps.of_drive(file, pair)
            yield from (replace(danger, what=what) for what in (GAP, *classes))


def targets_shown(file: DriveFile, formulas: TargetFormulas, freedom: Freedom) -> tuple[ShownTarget, ...]:
    """Return the targets that a drive shows in dense time, without gaps; shared parts are judged once."""
    shown: dict[tuple[str, tuple[str, ...], str], ShownTarget] = {}
    kind = LazyJudge if formulas.is_always_judged else DriveJudge
    names = tuple(file.drive.vehicles)
    for roles, vehicles in role_choices(formulas.roles, formulas.all_roles, names, freedom.roles):
        judge = kind.on(file.drive.cast(dict(zip(roles, vehicles, strict=True))))
        for lane in _lanes(file, freedom.lanes):
            bound = formulas.on(file.road, roles, roles, lane)
            for cut, true in _instants(judge, bound, file, freedom.start):
                at = as_float(cut.point)
                for what in formulas.names_of(roles, true):
                    shown.setdefault((what, vehicles, lane), ShownTarget(what, vehicles, lane, at))
    return in_order(shown.values())


def _lanes(file: DriveFile, free: bool) -> tuple[str, ...]:
    return (file.lanes[LANE],) if LANE in file.lanes and not free else file.road.lanes


def _instants(
    judge: DriveJudge | LazyJudge, formulas: Mapping[TargetKey, Formula], file: DriveFile, free: bool
) -> Iterator[tuple[Cut, frozenset[TargetKey]]]:
    """Yield the start with the true keys; if ``free``, each instant within the horizon with a change."""
    if not free:
        yield START, frozenset(key for key, formula in formulas.items() if judge.holds(formula))
        return
    truths = {key: judge.visit(formula) for key, formula in formulas.items()}
    cuts = {START, *(cut for truth in truths.values() for cut in truth.cuts if cut.point <= file.horizon)}
    for cut in sorted(cuts):
        yield cut, frozenset(key for key, truth in truths.items() if bisect_right(truth.cuts, cut) % 2)
