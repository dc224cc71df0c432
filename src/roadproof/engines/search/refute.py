"""Searches drives that falsify a claim on a reference road."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from roadproof.engines.search.constant_motion import steady_drive
from roadproof.engines.search.drive_search import engine_reads_all, search_drive
from roadproof.engines.search.enumeration import Within, short_refuting_drive
from roadproof.engines.search.initial_candidates import space_of
from roadproof.engines.search.question import pose, usual_model
from roadproof.engines.search.sampling import Space, states
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.evidence.countermodel import Countermodel, Instant
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind, values_with
from roadproof.library.compose import negation
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import is_state
from roadproof.logic.initial_conditions import forced_values
from roadproof.logic.rewrite import is_cubic_state
from roadproof.logic.terms import Signal
from roadproof.runtime.budget import Budget, Effort
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.world.vehicle import Range, Vehicle

# Units of work: for a drive within the limits of the usual models, where one beyond them is known, and
# without them.
DRIVE, KNOWN, WIDER = 5.0, 0.5, 2.0
WITHIN: tuple[Within, ...] = ("model", "forward", "claim")
ROUNDS = 3
FASTEST, HARDEST = Fraction(80), Fraction(12)  # m/s and m/s^2


def quick_drive(
    specification: Specification, claim: Query, clock: Budget | None = None
) -> JudgedDrive | None:
    """Return a short drive on which ``claim`` is false, first within the usual models' limits, then without.

    It takes no solver and some tenths of a second; None where none was found. Raises ``BudgetExceeded``
    where the seconds of the ``clock`` have passed.
    """
    return _small(specification, claim, 1, clock)


def _small(
    specification: Specification, claim: Query, rounds: int, clock: Budget | None = None
) -> JudgedDrive | None:
    for within in WITHIN:
        drive = short_refuting_drive(specification, claim, within, rounds, clock)
        if drive is not None:
            return drive
    return None


def refuting_drive(
    specification: Specification, claim: Query, effort: Effort, known: JudgedDrive | None = None
) -> JudgedDrive | None:
    """Return a judged drive on which ``claim`` is false at time 0, or None where none was found.

    Searched within the limits of the usual models first, then (unless ``known`` is such a drive) without.
    On the usual road, with parameters at the values that the claim's premise forces, else declared ones; not
    for a claim about one instant that no engine can encode. Raises ``InputError`` and ``UsageError`` for
    claims that are not about drives, and ``BudgetExceeded``.
    """
    setting = Setting(values=forced_values(claim.formula))
    units = min(DRIVE if known is None else KNOWN, effort.units)
    within = _searched(specification, claim, setting, effort.with_units(units))
    if within is not None or known is not None:
        return within or known
    small = _small(specification, claim, ROUNDS, effort.meter())
    if small is not None:
        return small
    wide = {name: _without_limits(usual_model(negation(claim).formula, name)) for name in claim.vehicles}
    anyhow = replace(setting, vehicles=wide, collisions=True, natural=False)
    return _searched(specification, claim, anyhow, effort.with_units(min(WIDER, effort.units)))


def _searched(
    specification: Specification, claim: Query, setting: Setting, effort: Effort
) -> JudgedDrive | None:
    search_options = SearchOptions("smooth", effort=effort, explain=False)
    search = Search(specification, negation(claim), setting, search_options)
    if is_state(claim.formula) and not engine_reads_all(search):
        return None
    outcome = search_drive(search)
    return outcome.drives[0] if outcome.drives else None


def _without_limits(model: Vehicle) -> Vehicle:
    """Return the same box, able to stand, drive fast and swerve; the search has no reversing."""
    return replace(
        model,
        name=f"{model.name} without limits",
        v_lon=(Fraction(0), FASTEST),
        cruise=(Fraction(0), FASTEST),
        v_lat=(-HARDEST, HARDEST),
        a_lon=(-HARDEST, HARDEST),
        a_lat=(-HARDEST, HARDEST),
        lateral_share=Fraction(10),
    )


def beyond_limits(drive: JudgedDrive) -> str:
    """Return how a drive leaves the limits of the usual models, in words; '' where it keeps them.

    Boxes that overlap within the horizon of the file count as well.
    """
    file = drive.file
    models = {name: usual_model(drive.judgement.formula, name) for name in file.drive.vehicles}
    breach = first_breach(file.drive, models, None)
    if breach is not None:
        return f"limits of the shipped {models[breach.vehicle].name}: {breach}"
    overlap = first_overlap(file.drive, file.horizon)
    return "" if overlap is None else f"usual drives: {overlap}"


def sampled_drive(
    specification: Specification, claim: Query, values: Mapping[str, Fraction], setting: Setting
) -> JudgedDrive | None:
    """Return a drive of constant motion on which ``claim`` is false at time 0, or None.

    States are sampled within the limits of the vehicles of ``setting``, then around them; the drive need not
    keep these limits. ``values`` of parameters, SI. Only for claims about one instant that have signals of
    vehicles and nothing else.
    """
    against = negation(claim)
    if not claim.vehicles or not is_cubic_state(claim.formula):
        return None
    library = specification.library
    question = pose(library, against, replace(setting, values=values))
    formula = bind(against.formula, question.road, {}, question.values)
    inside = space_of(question)
    for space in (inside, _around(inside)):
        for state in states(formula, space, 1):
            now = {f"{x.name}({x.vehicle})": value for x, value in state.items()}
            now |= {f"{x.name}({x.vehicle})": value for x, value in space.sizes.items()}
            countermodel = Countermodel(
                (Instant(Fraction(0), now, {}),), values_with(library, values), "before"
            )
            drive = steady_drive(specification, claim, countermodel, values_with(library, values))
            if drive is not None:
                return drive
    return None


def _around(space: Space) -> Space:
    """Return a space whose ranges extend by their width on both sides; no vehicle reverses."""

    def wider(signal: Signal, ends: Range) -> Range:
        low, high = ends
        below = low - (high - low)
        return (max(below, Fraction(0)) if signal.name == "v_lon" else below), high + (high - low)

    return Space({x: wider(x, ends) for x, ends in space.ranges.items()}, space.sizes)
