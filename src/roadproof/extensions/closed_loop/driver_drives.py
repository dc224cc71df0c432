"""Driver models in the place of the controller, in a drive in which it fails."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from roadproof.errors import RoadproofError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.closed_loop.claim_names import claim_name
from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, decide_drive, manoeuvre_of
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.questions.question import Answers
from roadproof.reasons import ReasonKind
from roadproof.semantics.exact.judging import judge
from roadproof.verdict import Verdict


def models_of(drivers: Drivers | None, scenario: str) -> tuple[str, ...]:
    """Return the driver models that speak of a scenario by name."""
    manoeuvre = manoeuvre_of(scenario)
    return () if drivers is None or manoeuvre is None else drivers.of(manoeuvre)


def decisions_on(
    drive: JudgedDrive,
    drivers: Drivers | None,
    scenario: str,
    vehicles: tuple[str, ...],
    breach: Claim | None,
    values: Mapping[str, Fraction],
) -> tuple[Decision, ...]:
    """Return the exact decisions of the driver models on a failing drive.

    ``vehicles``: SV first. ``breach``: the claim that a requirement is broken; a model prevents a failure
    only if its own drive keeps the requirement, too.
    """
    if drivers is None or not models_of(drivers, scenario):
        return ()
    try:
        every = tuple(decide_drive(drive.file, drivers, scenario, vehicles, 0.0))
    except RoadproofError:
        return ()  # a drive that no model can be put into, such as one without a lane below SV
    return tuple(_with_requirement(x, drive, breach, values) for x in every)


def _with_requirement(
    decision: Decision, drive: JudgedDrive, breach: Claim | None, values: Mapping[str, Fraction]
) -> Decision:
    driven = decision.driven
    if decision.side != "preventable" or driven is None or breach is None:
        return decision
    bound = bind(breach.formula, drive.file.road, drive.file.lanes, values)
    if judge(bound, driven.drive).holds:
        reason = ReasonKind.BREAKS_REQUIREMENT()
        return replace(decision, side="undecided", gap=None, reason=reason, driven=None)
    formula = f"({driven.formula}) and not {breach.text}"
    return replace(decision, driven=replace(driven, formula=formula))


def driven_claims(
    home: Specification, failing: JudgedDrive, decisions: Sequence[Decision], part: str, target: str
) -> Iterator[tuple[str, Decision, Claim]]:
    """Yield for each driver model the claim about its drive in the place of the controller, with its name."""
    for decision in decisions:
        if decision.driven is not None:
            mode = Exists(
                road=failing.file.road,
                horizon=decision.driven.rests,
                collisions=True,
                explain=False,
                like=decision.driven.drive,
            )
            claim = claim_of(home, read_claim(home, decision.driven.formula), mode, {})
            yield claim_name(part, target, decision.driver), decision, claim


def confirmed(
    decisions: Sequence[Decision], claims: Iterator[tuple[str, Decision, Claim]], known: Answers
) -> tuple[tuple[Decision, ...], dict[str, ClaimAnswer]]:
    """Return the decisions, undecided where no judged drive confirms one, and the answers by driver model."""
    pairs = [(x, known.get(name)) for name, x, _ in claims]
    of = {x.driver: x for x in decisions}
    for x, answer in pairs:
        if answer is None or answer.verdict is not Verdict.WITNESSED:
            of[x.driver] = replace(x, side="undecided", gap=None, instant=None, speed=None)
    return tuple(of.values()), {x.driver: answer for x, answer in pairs if answer is not None}


def verdict_data(decision: Decision) -> DriverVerdict:
    """Return a decision as plain data."""
    return DriverVerdict(
        scenario=decision.scenario,
        vehicles=decision.vehicles,
        driver=decision.driver,
        side=decision.side,
        at=decision.at,
        gap=decision.gap,
        instant=decision.instant,
        speed=decision.speed,
        start=decision.start,
        reason=decision.reason,
    )
