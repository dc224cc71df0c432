"""``python -m fuzz``: random formulas and traces through every reader (docs/explanation/tests.md).

A case on which two readers disagree is made smaller and kept in ``found/``, where a test replays it.
"""

import argparse
import importlib
import json
import shutil
import time
from pathlib import Path

from fuzz.run import READERS, run

RESULTS = Path(__file__).parent / "results.json"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("--pairs", type=int, default=2000, help="formula/trace pairs a reader")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--reader", choices=READERS, action="append", help="default: all")
    parser.add_argument("--keep", action="store_true", help="add the counts to results.json")
    asked = parser.parse_args()
    found = 0
    for name in asked.reader or READERS:
        begun = time.monotonic()
        reader = importlib.import_module(f"fuzz.{name}")
        if getattr(reader, "NEEDS_COQ", False) and shutil.which("coqc") is None:
            print(f"{name:8} left out: coqc is not installed (apt-get install -y coq)", flush=True)
            continue
        counted = run(reader, asked.pairs, asked.seed)
        found += len(counted.found)
        seconds = time.monotonic() - begun
        told = f"{counted.pairs:7} pairs in {seconds:6.0f} s, seed {asked.seed}"
        print(f"{name:8} {told}: {len(counted.found)} disagreements  {counted.notes}", flush=True)
        for path in counted.found:
            print(f"         {path}")
        if asked.keep:
            keep(name, asked.seed, counted.pairs, len(counted.found))
    return 1 if found else 0


def keep(reader: str, seed: int, pairs: int, disagreements: int) -> None:
    """Write what came out beside what other runs have written; a run with the same seed replaces its own."""
    kept = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else []
    kept = [entry for entry in kept if (entry["reader"], entry["seed"]) != (reader, seed)]
    kept.append({"reader": reader, "seed": seed, "pairs": pairs, "disagreements": disagreements})
    kept.sort(key=lambda entry: (READERS.index(entry["reader"]), entry["seed"]))
    RESULTS.write_text("[\n" + ",\n".join(json.dumps(entry) for entry in kept) + "\n]\n", "utf-8")


if __name__ == "__main__":
    raise SystemExit(main())
