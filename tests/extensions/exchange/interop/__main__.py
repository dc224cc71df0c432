"""``make interop``: witnesses of all scenarios, exported, and put to clients that nobody here wrote.

Every client runs in an environment of its own (environments.py) and is asked about every file of its format;
its complaints are counted, and it has to refuse damaged copies. What cannot be installed is skipped, with a
reason. The table goes into docs/data/interop.csv where all were asked.
"""

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from extensions.exchange.interop.damage import DAMAGES
from extensions.exchange.interop.environments import OUT, Client, clients, python_of
from extensions.exchange.interop.expected import expected
from extensions.maps.measured_lanelets import RAMPS, commonroad
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.exchange.exporting import export
from roadproof.frontends.api.drives import witness
from roadproof.frontends.cli.main import main as roadproof
from tally import rows, write

ROOT = Path(__file__).parents[4]
TABLE = ROOT / "docs/data/interop.csv"
EACH = 2
"""So many files are damaged in each way."""
MOTORWAY = ROOT / "examples/maps/motorway.xodr"
BENT, ON_LANELETS = "bent", (9, 12, 17, 20)
_ALL = 6
"""Entries where a metric of each kind is told, so that damage shows in all of them."""


@dataclass
class Outcome:
    """``skipped`` says why where nobody was asked; ``accepted``: damaged copies that were not refused.

    ``bent``: files of drives on roads with bends; ``issues`` and ``bent_issues``: of these and of the others.
    """

    client: Client
    files: int = 0
    bent: int = 0
    issues: list[str] = field(default_factory=list)
    bent_issues: list[str] = field(default_factory=list)
    damaged: int = 0
    accepted: list[str] = field(default_factory=list)
    skipped: str = ""

    @property
    def row(self) -> list[str]:
        if self.skipped:
            return [self.client.packages[0], self.client.about, f"skipped: {self.skipped}", *[""] * 4]
        refused = f"{self.damaged - len(self.accepted)} of {self.damaged}"
        counts = (self.files, len(self.issues), self.bent, len(self.bent_issues))
        return [self.client.packages[0], self.client.about, *map(str, counts), refused]


def find_drives(folder: Path) -> Path:
    """The witnesses of all 24 scenarios in the three sets, found unless they are there."""
    if len([*folder.glob("scenario-*.json")]) < 72:
        print("looking for drives (some minutes)", flush=True)
        line = [
            "witness",
            "--all",
            "--set",
            "base,extA,ext",
            "--no-pictures",
            "--quiet",
            "--out",
            str(folder),
        ]
        if roadproof(line) != 0:
            sys.exit("not every scenario has a drive")
    return folder


def find_bent(folder: Path) -> Path:
    """The witnesses of all 24 scenarios on the motorway with a bend, and of some on lanelets with one."""
    if len([*folder.glob("*.json")]) < 24 + len(ON_LANELETS):
        print("looking for drives on bends (some minutes)", flush=True)
        lanelets = folder / "maps" / "lanelets.xml"
        lanelets.parent.mkdir(parents=True, exist_ok=True)
        lanelets.write_text(commonroad(RAMPS, 1 / 400), "utf-8")
        for name, what, road in (("motorway", (), MOTORWAY), ("lanelets", ON_LANELETS, lanelets)):
            where = f"{road}#lanes=right" if name == "motorway" else str(road)
            found = witness(*what, road=where, pictures=False)
            for x in found.drives:
                path = folder / f"{name}-{x.file.scenario:02d}.json"
                path.write_text(json.dumps(x.as_data()), "utf-8")
    return folder


def ask(client: Client, python: Path, tasks: Mapping[Path, Any], work: Path) -> dict[Path, list[str]]:
    """What the client complains of, file by file."""
    work.mkdir(parents=True, exist_ok=True)
    asked, answer = work / "asked.json", work / "answer.json"
    answer.unlink(missing_ok=True)
    asked.write_text(json.dumps({str(path): told for path, told in tasks.items()}), "utf-8")
    script = Path(__file__).parent / "clients" / client.script
    found = subprocess.run(
        [str(python), str(script), str(asked), str(answer)], capture_output=True, text=True
    )
    if not answer.is_file():
        raise RuntimeError(f"{client.name} broke off:\n{found.stdout[-2000:]}\n{found.stderr[-2000:]}")
    return {Path(path): told for path, told in json.loads(answer.read_text("utf-8")).items()}


def damaged(client: Client, tasks: Mapping[Path, Any], work: Path) -> Iterator[tuple[Path, str, Any]]:
    """Copies with what is wrong, and what is expected of them."""
    usable = [path for path, told in tasks.items() if any(len(x) == _ALL for x in told["metrics"])]
    for number, (what, damage) in enumerate(DAMAGES[client.name].items(), 1):
        for path in (usable[0], usable[-1])[:EACH]:
            copy = work / f"damage-{number}" / path.name
            copy.parent.mkdir(parents=True, exist_ok=True)
            for beside in path.parent.glob(f"{path.stem}.*"):
                (copy.parent / beside.name).write_bytes(beside.read_bytes())
            text = path.read_text("utf-8")
            made = damage(text)
            if made == text:
                raise RuntimeError(f"{client.name}, {what}: {path.name} is as it was")
            copy.write_text(made, "utf-8")
            yield copy, f"{what}: {path.name}", tasks[path]


def examine(client: Client, folder: Path, told: Mapping[str, Any], work: Path) -> Outcome:
    outcome = Outcome(client)
    python = python_of(client)
    if isinstance(python, str):
        outcome.skipped = python
        return outcome
    tasks = {path: told[path.stem] for path in sorted((folder / client.format).glob(client.files))}
    found = ask(client, python, tasks, work)
    outcome.issues = [f"{path.name}: {text}" for path, texts in found.items() for text in texts]
    outcome.files = len(found)
    paths = sorted((folder / BENT / client.format).glob(client.files))
    bent = {x: told[x.stem] for x in paths if x.name != MOTORWAY.name}  # which is the user's own file
    found = ask(client, python, bent, work)
    outcome.bent_issues = [f"{path.name}: {text}" for path, texts in found.items() for text in texts]
    outcome.bent = len(found)
    copies = {path: (what, expects) for path, what, expects in damaged(client, tasks, work)}
    answers = ask(client, python, {path: x[1] for path, x in copies.items()}, work)
    outcome.damaged = len(answers)
    outcome.accepted = [copies[path][0] for path, texts in answers.items() if not texts]
    return outcome


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m extensions.exchange.interop", description=__doc__)
    parser.add_argument(
        "--only", metavar="NAME", action="append", default=[], help="a client; may be repeated"
    )
    parser.add_argument("--drives", metavar="DIR", type=Path, default=OUT / "drives")
    args = parser.parse_args()
    asked = [x for x in clients() if not args.only or x.name in args.only]
    drives = find_drives(args.drives)
    folder = OUT / "exported"
    bent = find_bent(args.drives.with_name("bent"))
    print(export(drives, ["openscenario", "opendrive", "commonroad", "highd", "csv"], folder), flush=True)
    print(export(bent, ["openscenario", "opendrive", "commonroad"], folder / BENT), flush=True)
    paths = (*sorted(drives.glob("scenario-*.json")), *sorted(bent.glob("*.json")))
    told = {path.stem: expected(load_drive(path)) for path in paths}
    outcomes = []
    for client in asked:
        outcome = examine(client, folder, told, OUT / "answers" / client.name)
        outcomes.append(outcome)
        print(" | ".join(outcome.row), flush=True)
        for text in (*outcome.issues[:5], *outcome.bent_issues[:5]):
            print(f"  issue: {text}")
        for text in outcome.accepted:
            print(f"  a damaged copy is accepted: {text}")
    if not args.only and not any(x.skipped for x in outcomes):
        heading = ("client", "what it is asked", "files", "issues", "files with bends", "issues there")
        heading = (*heading, "damaged copies refused")
        write(TABLE, rows(heading, [x.row for x in outcomes]))
    return int(any(x.issues or x.bent_issues or x.accepted for x in outcomes))


if __name__ == "__main__":
    sys.exit(main())
