"""OpenSCENARIO files of folders: how many run and are judged, and why the others are refused.

    python benchmarks/storyboards.py FOLDER ... --out table.csv

Each storyboard is run, and every scenario of the paper's sets is judged on its samples. Files with the same
content count once; catalogues, which have no storyboard, do not count. Of a distribution of parameters one
scenario is judged. The table has a row a file.
"""

import argparse
import csv
import hashlib
import re
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.exchange.openscenario import RATE
from roadproof.extensions.exchange.storyboard.distributions import scenarios_of
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording
from roadproof.extensions.traffic.evaluate.questions import (
    EvaluationQuestions,
    compile_questions,
    default_settings,
)
from roadproof.extensions.traffic.formats.sources import find_source


@dataclass(frozen=True)
class Row:
    """A file: what became of it, in how many seconds, and the notes on it or the reason of its refusal."""

    folder: str
    file: str
    outcome: str
    vehicles: int
    matches: int
    seconds: float
    told: str


def storyboards(folder: Path) -> Iterator[Path]:
    """Files with a storyboard or a distribution, those of the same content once."""
    seen = set[bytes]()
    for path in sorted(folder.rglob("*.xosc")):
        content = path.read_bytes()
        digest = hashlib.sha256(content).digest()
        if digest not in seen and re.search(rb"<(Storyboard|ParameterValueDistribution)[\s>]", content):
            seen.add(digest)
            yield path


def judge(folder: Path, path: Path, questions: EvaluationQuestions) -> Row:
    """Run and judge a file."""
    begun = time.perf_counter()
    try:
        scenarios = scenarios_of(path)
        recording = find_source(scenarios[len(scenarios) // 2]).read()
        matches = len(evaluate_recording(recording, questions).matches)
        outcome, vehicles, told = "judged", recording.vehicles, "; ".join(recording.notes)
    except InputError as error:
        outcome, vehicles, matches, told = "refused", 0, 0, str(error)
    seconds = round(time.perf_counter() - begun, 2)
    return Row(folder.name, str(path.relative_to(folder)), outcome, vehicles, matches, seconds, told)


def reason(told: str) -> str:
    """The reason of a refusal without file, path, names and numbers."""
    rule = re.sub(r"^\S*(OpenSCENARIO|/)\S*(?: [^:/]*)*(?=/)", "", told.split(": ", 1)[-1])
    return re.sub(r"'[^']*'|\S*/\S*|[\d.]+", "…", rule)[:100]


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--out", type=Path, default=Path("storyboards.csv"))
    args = parser.parse_args()
    questions = compile_questions(default_settings(), RATE)
    rows = [judge(folder, path, questions) for folder in args.folders for path in storyboards(folder)]
    with args.out.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, [x.name for x in fields(Row)])
        writer.writeheader()
        writer.writerows(map(asdict, rows))
    for folder in args.folders:
        found = Counter(x.outcome for x in rows if x.folder == folder.name)
        print(f"{folder.name}: {found['judged']} judged, {found['refused']} refused")
    for told, count in Counter(reason(x.told) for x in rows if x.outcome == "refused").most_common():
        print(f"{count:5d}  {told}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
