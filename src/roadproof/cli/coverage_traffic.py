"""``roadproof coverage --on``: how often the classes of gaps occur in recordings, and whether that fits."""

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.progress import tell
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.analysis.requests import Asked

Entry = dict[str, Any]


def count_in_traffic(asked: "Asked", folder: Path, classes: list[Entry]) -> Entry:
    """What recordings hold, as plain data; every class is given its count, and a trace where it has one.

    A class without a drive that occurs is seen so: its reason says where. A class that is proved empty
    and occurs is CROSSCHECK-FAILED.
    """
    from roadproof.analysis.coverage.classes import Classes
    from roadproof.analysis.coverage.traffic import disturbances_in

    known = Classes(asked)
    disturbances = 0
    gaps: list[Entry] = []
    counts: Counter[str] = Counter()
    where: dict[str, str] = {}
    for trace in disturbances_in(asked, folder):
        disturbances += 1
        tell(f"{disturbances} disturbances in traffic, {len(gaps)} of them missed")
        if not trace.missed:
            continue
        pair = f"{trace.first} and {trace.second}, frames {trace.frames[0]} to {trace.frames[1]}"
        keys = [*trace.classes, *([""] if known.has(None, trace.classes) else [])]
        gaps.append({"recording": trace.recording, "pair": pair, "classes": keys})
        counts.update(keys)
        for key in keys:
            where.setdefault(key, f"recording {trace.recording}, vehicles {pair}")
    for entry in classes:
        key = entry["component"] + (f": {entry['condition']}" if entry["condition"] else "")
        entry["in_traffic"] = counts[key]
        if not counts[key]:
            continue
        entry["trace"] = where[key]
        if entry["verdict"] == str(Verdict.IMPOSSIBLE):
            entry["verdict"] = str(Verdict.CROSSCHECK_FAILED)
        if entry["verdict"] != str(Verdict.WITNESSED):
            entry["reason"] = f"occurs in {where[key]}"
    return {"recordings": str(folder), "view": "recorded", "disturbances": disturbances, "missed": gaps}
