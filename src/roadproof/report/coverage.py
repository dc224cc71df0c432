"""The classes of gaps as a table, and a picture for each."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from roadproof.evidence.drive_file import read_drive
from roadproof.report.drive import draw_drive
from roadproof.spec.library import Library

Entry = Mapping[str, Any]


def as_table(classes: Sequence[Entry], gaps: Sequence[Entry]) -> str:
    """One line a class, below the component that it belongs to; gaps by their numbers."""
    lines: list[str] = []
    for entry in classes:
        if entry["scenario"] is None:
            lines.append("no single condition is to blame: in every scenario two or more are false")
            lines.append(_line("", entry, gaps))
        elif not entry["condition"]:
            lines.append(f"scenario {entry['scenario']}, {entry['component']}: {entry['description']}")
            lines.append(_line("the component", entry, gaps))
        else:
            lines.append(_line(entry["condition"], entry, gaps))
    return "\n".join(lines)


def _line(what: str, entry: Entry, gaps: Sequence[Entry]) -> str:
    return f"  {what:<70} {entry['verdict']:<10} {_evidence(entry, gaps)}".rstrip()


def _evidence(entry: Entry, gaps: Sequence[Entry]) -> str:
    said = [f"drive {number} ({_catching(gaps[number - 1])})" for number in entry["gaps"]]
    said += [entry["reason"]] if entry["reason"] else []
    said += [f"{entry['in_traffic']} in traffic"] if entry.get("in_traffic") else []
    said += (
        [f"no drive found that {' or '.join(entry['none_for'])} is first to catch"]
        if entry["none_for"]
        else []
    )
    return "; ".join(said)


def _catching(gap: Entry) -> str:
    choices = " or ".join(" with ".join(names) for names in gap["caught_by"])
    return f"{gap['first']}: {choices}" if gap["first"] else "caught by no set"


def summary(classes: Sequence[Entry], gaps: Sequence[Entry]) -> Iterator[str]:
    """How many classes have which answer, and which wider set catches drives of how many."""
    counts = {
        name: sum(x["verdict"] == name for x in classes) for name in ("WITNESSED", "IMPOSSIBLE", "UNKNOWN")
    }
    yield (
        f"of {len(classes)} classes {counts['WITNESSED']} have a judged drive, {counts['IMPOSSIBLE']} are "
        f"proved empty, {counts['UNKNOWN']} are undecided"
    )
    for name in dict.fromkeys(gap["first"] for gap in gaps):
        has = sum(any(gaps[n - 1]["first"] == name for n in x["gaps"]) for x in classes)
        who = f"{name} is the first set to catch" if name else "no set catches"
        yield f"  {who} a drive of {has} classes"


def draw_gap(entry: Entry, drive: Mapping[str, Any], library: Library) -> dict[str, bytes]:
    """The picture of a gap, with when each part of the missed scenario is true."""
    formula = "initSafe(SV,POV) and F danger(SV,POV)"
    if entry["scenario"] is not None:
        formula = f"scenario_{entry['scenario']}(SV,POV,L)"
    title = f"missed by {drive['set']}: {entry['component'] or 'no single condition'}"
    if entry["condition"]:
        title += f", {entry['condition']}"
    return draw_drive(replace(read_drive(dict(drive), "drive"), formula=formula), library, title)
