"""What ``roadproof explore`` writes: drive files, certificates and pictures, named in its data."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import json_text, write_text

if TYPE_CHECKING:
    from roadproof.spec.library import Library


def with_evidence(data: dict[str, Any], number: int, folder: Path | None) -> dict[str, Any]:
    """The same with drives and certificates written to files, and named, where there is a folder."""
    if folder is None:
        return data
    scenario = data["scenario"]
    stem = f"formula-{number:02}" if scenario is None else f"scenario-{scenario:02}"
    stem = f"{stem}-{data['set']}"
    write = _writer(folder)
    values = [write(x, f"{stem}-value-{k:03}") for k, x in enumerate(data["values"], 1)]
    groups = {
        "boundaries": [(f"{stem}-boundary-{k}", x) for k, x in enumerate(data["boundaries"], 1)],
        "extremes": [(f"{stem}-{x['sense']}-{k}", x) for k, x in enumerate(data["extremes"], 1)],
    }
    written = {
        group: [
            {name: write(part, f"{at}-{name}") if _is_finding(part) else part for name, part in x.items()}
            for at, x in entries
        ]
        for group, entries in groups.items()
    }
    return {**data, "stem": stem, "values": values, **written}


def _is_finding(part: object) -> bool:
    return isinstance(part, dict) and "verdict" in part


def _writer(folder: Path) -> Callable[[Mapping[str, Any], str], dict[str, Any]]:
    """Writes the evidence of a finding and names the file in its place; a certificate is written once."""
    certificates: dict[str, str] = {}

    def write(finding: Mapping[str, Any], stem: str) -> dict[str, Any]:
        named = dict(finding)
        for kind in ("drive", "certificate"):
            if finding[kind] is None:
                continue
            text = json_text(finding[kind])
            path = folder / f"{stem}.json"
            if kind == "drive" or text not in certificates:
                write_text(path, text)
                certificates[text] = str(path)
            named[kind] = certificates[text]
        return named

    return write


def draw_all(explored: Sequence[Mapping[str, Any]], folder: Path, library: "Library") -> None:
    """A picture of each exploration, and of the drives at its boundaries and extremes."""
    from roadproof.evidence.drive_file import load_drive
    from roadproof.files import write_whole
    from roadproof.report.drive import draw_drive
    from roadproof.report.explore import draw_exploration

    for data in explored:
        if data["values"]:
            for kind, content in draw_exploration(data).items():
                write_whole(folder / f"{data['stem']}.{kind}", content)
        ends = [x["held"] for x in data["boundaries"]] + [x["best"] for x in data["extremes"]]
        for end in ends:
            if end is not None and end["drive"] is not None:
                path = Path(end["drive"])
                for kind, content in draw_drive(load_drive(path), library).items():
                    write_whole(path.with_suffix(f".{kind}"), content)
