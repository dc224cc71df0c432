"""What ``roadproof prove`` says of settled claims: a line, a table, the details, plain data."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import groupby
from typing import TYPE_CHECKING, Any

from roadproof.cli.prove_settle import Settled
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.refutation import Countermodel
    from roadproof.world.road import Road


def line(settled: Settled) -> str:
    """The verdict in one line."""
    task = settled.task
    scenario = "" if task.scenario is None else f" {task.scenario}"
    mark = "" if settled.verdict is task.expected else f", expected {task.expected}"
    return f"{task.id}{scenario} {task.set_name}: {settled.verdict}{mark} ({settled.result.seconds:.2f} s)"


def table(settled: Sequence[Settled]) -> str:
    """A line for each property and set; below it what was not as expected."""
    rows: list[str] = []
    for (name, title, set_name), group in groupby(
        settled, key=lambda s: (s.task.id, s.task.title, s.task.set_name)
    ):
        found = list(group)
        verdicts = sorted({str(s.verdict) for s in found})
        expected = str(found[0].task.expected)
        slowest = max(s.result.seconds for s in found)
        mark = "" if verdicts == [expected] else f"   expected {expected}"
        count = f"{len(found)} claim{'s' if len(found) > 1 else ''}"
        rows.append(
            f"{name:3} {set_name:5} {count:10} {', '.join(verdicts):8} {slowest:5.2f} s  {title}{mark}"
        )
        rows += [f"      {line(s)} {s.result.reason}" for s in found if s.verdict is not s.task.expected]
    return "\n".join(rows)


def details(settled: Settled) -> str:
    """The verdict with its evidence: certificate in numbers, drive or trace."""
    result, task = settled.result, settled.task
    lines = [f"{settled.verdict}  {' '.join(task.claim.split())}"]
    within = "drives up to a horizon" if settled.bounded else "dense time, all horizons"
    lines.append(f"  set {task.set_name}, {within}, {result.seconds:.2f} s")
    if result.reason:
        lines.append(f"  {result.reason}")
    if result.certificate is not None:
        certificate = result.certificate
        count = sum(len(texts) for texts in certificate.instances.values())
        lines.append(
            f"  certificate: {count} instance{'s' if count != 1 else ''}, "
            f"{len(certificate.lemmas)} lemma{'s' if len(certificate.lemmas) != 1 else ''}"
            + (f", for all {', '.join(certificate.assumptions)}" if certificate.assumptions else "")
        )
    if settled.drive is not None:
        lines += _show_drive(settled.drive)
    elif result.countermodel is not None:
        lines += _show_countermodel(result.countermodel)
    return "\n".join(lines)


def _show_drive(drive: Mapping[str, Any]) -> list[str]:
    """Where each vehicle starts and how its speed goes; the whole drive is in the file of --out."""
    lanes = ", ".join(f"{k}={v}" for k, v in (drive.get("lanes") or {}).items()) or str(
        drive.get("lane") or ""
    )
    lines = [f"  false on this drive, judged exactly in dense time{f' (lane {lanes})' if lanes else ''}:"]
    for name, motion in drive["vehicles"].items():
        start = f"starts at s={_short(motion['s'])} m, d={_short(motion['d'])} m"
        speeds, across = [Fraction(motion["v_lon"])], Fraction(motion["d"])
        v_lat = Fraction(motion["v_lat"])
        for piece in motion["pieces"]:
            if piece["duration"] is not None:
                time, a_lat = Fraction(piece["duration"]), Fraction(piece["a_lat"])
                across += v_lat * time + a_lat * time**2 / 2
                v_lat += a_lat * time
                speeds.append(speeds[-1] + Fraction(piece["a_lon"]) * time)
        moved = f", moves to d={_short(str(across))} m" if abs(across - Fraction(motion["d"])) > 1 else ""
        lines.append(f"    {name} {start}, {_short(str(speeds[0]))} -> {_short(str(speeds[-1]))} m/s{moved}")
    return lines


def _short(text: str) -> str:
    return f"{float(Fraction(text)):.4g}"


def _show_countermodel(countermodel: "Countermodel") -> list[str]:
    lines = [
        "  false on this trace over points in time, judged; it may jump, and no drive was found:",
        f"    between two instants it keeps the state of the one {countermodel.held}",
    ]
    if countermodel.parameters:
        shown = ", ".join(f"{n}={_number(v)}" for n, v in sorted(countermodel.parameters.items()))
        lines.append(f"    parameters: {shown}")
    if countermodel.road is not None:
        lines.append("    on a road made for it:")
        lines += [f"      {_lane(lane, countermodel.road)}" for lane in countermodel.road.lanes]
    for instant in countermodel.instants:
        true = ", ".join(name for name, holds in instant.atoms.items() if holds) or "none of the predicates"
        lines.append(f"    at {_number(instant.time)} s: {true}")
        values = {n: v for n, v in instant.values.items() if n not in countermodel.parameters}
        if values:
            lines.append(f"      {', '.join(f'{n}={_number(v)}' for n, v in sorted(values.items()))}")
    return lines


def _lane(lane: str, road: "Road") -> str:
    """The rectangles of a lane, in metres along and across, and the lanes beside it."""
    shown = ", ".join(
        f"{x.zone} [{_end(x.s[0])}, {_end(x.s[1])}] x [{_number(x.d[0])}, {_number(x.d[1])}]"
        for x in road.lanelets_of(lane)
    )
    beside = road.beside(lane)
    return f"{lane}: {shown}" + (f"; beside {', '.join(beside)}" if beside else "")


def _end(value: Fraction | None) -> str:
    return "" if value is None else _number(value)


def _number(value: Fraction) -> str:
    return f"{float(value):.6g}"


def as_data(settled: Settled, file: str | None) -> dict[str, Any]:
    """The verdict as plain data; ``file``: where its certificate is."""
    task, result = settled.task, settled.result
    return {
        "property": task.id,
        "part": task.part,
        "scenario": task.scenario,
        "set": task.set_name,
        "claim": task.claim,
        "expected": str(task.expected),
        "verdict": str(settled.verdict),
        "view": "grid" if settled.verdict is Verdict.PROVED_BOUNDED else "dense",
        "seconds": round(result.seconds, 4),
        "reason": result.reason,
        **({"limits": dict(settled.limits)} if settled.limits is not None else {}),
        "assumptions": list(result.certificate.assumptions) if result.certificate else [],
        "certificate": file if result.certificate is not None else None,
        "counterexample": counterexample(settled),
    }


def counterexample(settled: Settled) -> dict[str, Any] | None:
    """The refuting drive, or else the countermodel, as plain data."""
    from roadproof.evidence.refutation import drive_data, trace_data

    if settled.drive is not None:
        return drive_data(settled.drive)
    found = settled.result.countermodel
    if found is None:
        return None
    return trace_data(found)
