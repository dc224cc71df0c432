"""Settled claims to look at: a line, a table, or all details."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import groupby
from typing import TYPE_CHECKING

from roadproof.evidence.drive_file import other_values
from roadproof.library.assumption import assumes_motion, claim_statement
from roadproof.library.scenarios import LANE
from roadproof.library.words import legend, words_named_in
from roadproof.world.motion import state_at

if TYPE_CHECKING:
    from roadproof.evidence.certificate import Certificate
    from roadproof.evidence.countermodel import Countermodel
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.library.assumption import Assumption
    from roadproof.library.specification import Library, Specification
    from roadproof.questions.prove import ClaimResult, ProveQuestion
    from roadproof.world.road import Road


def line(answered: ClaimResult) -> str:
    """The verdict in one line."""
    task = answered.task
    scenario = "" if task.scenario is None else f" {task.scenario}"
    mark = "" if answered.verdict is answered.expected else f", expected {answered.expected}"
    seconds = answered.seconds
    at = f" at {', '.join(task.assuming)}" if task.assuming else ""
    took = f" ({seconds:.2f} s)" if seconds else ""
    return f"{task.id}{scenario} {task.set_name}{at}: {verdict(answered)}{mark}{took}"


def verdict(answered: ClaimResult) -> str:
    """The verdict; of a claim that is refuted also by what, since not every trace can be driven."""
    by = answered.refuted_by
    return str(answered.verdict) if by is None else f"{answered.verdict} by a {by}"


def table(answered: Sequence[ClaimResult], specification: Specification) -> str:
    """A line for each property and set; below it what was not as expected.

    At the end at which values claims were settled, and what scenarios are called.
    """
    rows: list[str] = []
    for (name, title, set_name), group in groupby(
        answered, key=lambda s: (s.task.id, s.task.title, s.task.set_name)
    ):
        results = list(group)
        verdicts = sorted({verdict(s) for s in results})
        expected = results[0].expected
        slowest = max(s.seconds for s in results)
        took = f"{slowest:5.2f} s" if slowest else ""  # none of a recalled answer
        mark = "" if all(s.verdict is expected for s in results) else f"   expected {expected}"
        count = f"{len(results)} claim{'s' if len(results) > 1 else ''}"
        rows.append(f"{name:3} {set_name:5} {count:10} {', '.join(verdicts):8} {took:7}  {title}{mark}")
        rows += [f"      {line(s)} {s.reason}" for s in results if s.verdict is not s.expected]
    values = sorted({value for s in answered for value in s.task.assuming})
    rows += [f"each at those of {', '.join(values)} that it speaks of"] if values else []
    words = words_named_in(specification, (s.task.claim for s in answered))
    rows += [f"  {line}" for line in legend(words)]
    return "\n".join(rows)


def sheet_of(answered: Sequence[ClaimResult]) -> Sheet[ClaimResult]:
    """An entry for each claim."""
    from roadproof.frontends.report.sheet import Column, Sheet  # here: a line needs no table

    return Sheet(
        (
            Column("claim", lambda x: " ".join(x.task.claim.split()), look="code"),
            Column("assuming", lambda x: ", ".join(x.task.assuming)),
            Column("premises", _premises),
            Column("set", lambda x: x.task.set_name),
            Column("verdict", lambda x: x.verdict, look="verdict"),
            Column("refuted_by", lambda x: x.refuted_by),
            Column("expected", lambda x: x.expected),
            Column("reason", lambda x: x.reason),
            Column("seconds", lambda x: x.seconds, "frame"),
        ),
        answered,
    )


def _premises(answer: ClaimResult) -> str:
    """The limits and facts about motion that a proof uses; empty where there is no proof or it uses none."""
    certificate = answer.certificate
    return "" if certificate is None else "; ".join(certificate.assumed.premises)


def details(answered: ClaimResult, question: ProveQuestion) -> str:
    """The verdict with its evidence: certificate in numbers, drive or trace.

    Also what scenarios are called, and what is supposed of custom signals.
    """
    task = answered.task
    lines = [f"{verdict(answered)}  {claim_statement(task.assuming, ' '.join(task.claim.split()))}"]
    lines += [
        f"  {words}"
        for words in words_named_in(question.specification_of(task), [task.claim]).values()
        if words.name
    ]
    within = "drives up to a horizon" if answered.is_bounded else "dense time, all horizons"
    took = f", {answered.seconds:.2f} s" if answered.seconds else ""
    lines.append(f"  set {task.set_name}, {within}{took}")
    lines += [f"  {text}" for text in question.supposed(task)]
    if answered.reason:
        lines.append(f"  {answered.reason}")
    if answered.certificate is not None:
        certificate = answered.certificate
        count = sum(len(texts) for texts in certificate.instances.values())
        lines.append(
            f"  certificate: {count} instance{'s' if count != 1 else ''}, "
            f"{len(certificate.lemmas)} lemma{'s' if len(certificate.lemmas) != 1 else ''}"
            + _values_of(certificate)
        )
        lines += _show_premises(certificate.assumed)
    if answered.drive is not None:
        lines += _show_drive(answered.drive, question.specification_of(task).library)
        lines += [f"  this drive lies outside the {answered.beyond}"] if answered.beyond else []
    elif answered.trace is not None:
        lines += _show_countermodel(answered.trace)
    return "\n".join(lines)


def _values_of(certificate: Certificate) -> str:
    """The values of parameters that its premise demands, and that it holds for all others."""
    pinned = f", at {', '.join(certificate.pinned)}" if certificate.pinned else ""
    return pinned + (f", for all {', '.join(certificate.assumptions)}" if certificate.assumptions else "")


def _show_premises(assumed: Assumption) -> list[str]:
    """The premises of a certificate: limits, facts about motion and inductions; and the other limits."""
    lines = []
    if assumes_motion(assumed.texts):
        lines += [f"  of the limits: {', '.join(assumed.limits)}"] if assumed.limits else []
        lines += [f"  of motion: {', '.join(map(str, assumed.facts))}"] if assumed.facts else []
        if not lines:
            without = "neither a limit nor a fact about motion" if assumed.unused else "no fact about motion"
            lines = [f"  the proof uses {without}: the claim holds without them"]
        elif assumed.unused:
            lines.append(f"  limits not used: {', '.join(assumed.unused)}")
    return lines + [f"  by induction over time: {x}" for x in assumed.inductions]


def _show_drive(judged: JudgedDrive, library: Library) -> list[str]:
    """Return where each vehicle starts and how its speed goes; the whole drive is in the file of --out."""
    named = judged.file.lanes
    lanes = named[LANE] if set(named) == {LANE} else ", ".join(f"{k}={v}" for k, v in named.items())
    if not judged.file.drive.vehicles and not judged.file.drive.custom_signals:
        values = ", ".join(other_values(judged.file, library))
        at_values = f", with {values}" if values else ""
        return [f"  false on a drive without vehicles, judged exactly in dense time{at_values}"]
    lines = [f"  false on this drive, judged exactly in dense time{f' (lane {lanes})' if lanes else ''}:"]
    for name, motion in judged.file.drive.vehicles.items():
        start = f"starts at s={_short(motion.s)} m, d={_short(motion.d)} m"
        last = sum((x.duration for x in motion.pieces if x.duration is not None), Fraction(0))
        end = state_at(motion, last)
        moved = f", moves to d={_short(end.d)} m" if abs(end.d - motion.d) > 1 else ""
        lines.append(f"    {name} {start}, {_short(motion.v_lon)} -> {_short(end.v_lon)} m/s{moved}")
    for (signal, vehicle), course in judged.file.drive.custom_signals.items():
        values = ", ".join(f"{_short(value)} from {_short(since)} s" for since, value in course[:4])
        more = ", …" if len(course) > 4 else ""
        lines.append(f"    {signal}{f'({vehicle})' if vehicle else ''} is {values}{more}")
    return lines


def _short(value: Fraction) -> str:
    return f"{float(value):.4g}"


def _show_countermodel(countermodel: Countermodel) -> list[str]:
    lines = [
        "  false on this trace over points in time, judged; it may jump:",
        f"    between two instants it keeps the state of the one {countermodel.interpolation}",
    ]
    if countermodel.loop is not None:
        loop = countermodel.loop
        lines.append(f"    from {_number(loop.start)} s on it repeats itself every {_number(loop.period)} s")
    if countermodel.parameters:
        shown = ", ".join(f"{n}={_number(v)}" for n, v in sorted(countermodel.parameters.items()))
        lines.append(f"    parameters: {shown}")
    if countermodel.road is not None:
        lines.append("    on a road made for it:")
        lines += [f"      {_lane(lane, countermodel.road)}" for lane in countermodel.road.lanes]
    for instant in countermodel.instants:
        true = ", ".join(sorted(x for x, holds in instant.atoms.items() if holds)) or "none of the predicates"
        lines.append(f"    at {_number(instant.time)} s: {true}")
        lines += [f"      {x}" for x in _values_in(instant.values, countermodel)]
        if instant.after is not None and instant.after != instant.values:
            lines += [f"      after it {x}" for x in _values_in(instant.after, countermodel)]
    return lines


def _values_in(values: Mapping[str, Fraction], countermodel: Countermodel) -> list[str]:
    """A state without the parameters, in a line; none where nothing is left."""
    shown = [f"{n}={_number(v)}" for n, v in sorted(values.items()) if n not in countermodel.parameters]
    return [", ".join(shown)] if shown else []


def _lane(lane: str, road: Road) -> str:
    """The rectangles of a lane, in metres along and across, and the lanes beside it."""
    shown = ", ".join(
        f"{x.zone} [{_end(x.s[0])}, {_end(x.s[1])}] x [{_number(x.d[0])}, {_number(x.d[1])}]"
        for x in road.lanelets_of(lane)
    )
    beside = road.adjacent_lanes(lane)
    return f"{lane}: {shown}" + (f"; beside {', '.join(beside)}" if beside else "")


def _end(value: Fraction | None) -> str:
    return "" if value is None else _number(value)


def _number(value: Fraction) -> str:
    return f"{float(value):.6g}"
