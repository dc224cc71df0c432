"""Processor time of catalogues: 20 drives with 20 formulas, 3 of them with unfit roles, and 1,000 drives.

``python benchmarks/catalogue_speed.py [FOLDER] [--drives 1000] [--no-formulas]`` makes the catalogues in
FOLDER (``catalogues``) unless they are there, and asks each twice: first with an empty cache, then with what
the first run left. Prints processor seconds of all processes. The drives are those of the classes with other
sizes, gaps and speeds, so that no two are alike.
"""

import argparse
import json
import os
import random
import resource
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path
from typing import Any

import roadproof as rp

SEED = 26
CONCRETE, ABSTRACT = 20, 20
_SPEEDS = ("15 m/s .. 25 m/s", "20 m/s .. 30 m/s", "25 m/s .. 35 m/s")
_VALID = "v_lon(SV) >= 0 m/s"
"""What every made drive says of itself, and shows."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", default=Path("catalogues"))
    parser.add_argument("--drives", type=int, default=1000)
    parser.add_argument("--no-formulas", action="store_true")
    given = parser.parse_args()
    mixed, many = given.folder / "mixed", given.folder / f"drives-{given.drives}"
    if not mixed.exists():
        make_drives(mixed, CONCRETE)
        make_formulas(mixed, ABSTRACT)
    if not many.exists():
        make_drives(many, given.drives)
    for folder in (many,) if given.no_formulas else (mixed, many):
        for drivers in ("none", "all models"):
            asked = ["--drivers", "none"] if drivers == "none" else []
            with tempfile.TemporaryDirectory() as cache:
                cold, warm = (seconds_of(folder, asked, cache) for _ in range(2))
            print(f"{folder.name}, driver models {drivers}: {cold:.1f} s cold, {warm:.1f} s warm", flush=True)


def seconds_of(folder: Path, options: list[str], cache: str) -> float:
    """Processor time of one run, its workers included."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-m", "roadproof", "catalogue", str(folder), "--no-pictures", *options]
    subprocess.run(
        command,
        env={**os.environ, "XDG_CACHE_HOME": cache},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def make_drives(folder: Path, count: int) -> None:
    """So many drives, each that of a class with other numbers."""
    folder.mkdir(parents=True)
    shuffled = random.Random(SEED)
    with tempfile.TemporaryDirectory() as name:
        rp.classify(shares=False, out=name)
        originals = sorted((Path(name) / "drives").glob("*.json"))
        order = shuffled.sample(originals, len(originals))
        for k in range(count):
            path = order[k % len(order)]
            content = changed(json.loads(path.read_text()), shuffled)
            (folder / f"{path.stem}~{k}.json").write_text(json.dumps(content, indent=1))


def changed(drive: dict[str, Any], shuffled: random.Random) -> dict[str, Any]:
    """The same drive elsewhere along the road, with vehicles of other sizes, gaps and speeds."""
    faster = shuffled.randint(-50, 50)  # cm/s
    for vehicle in drive["vehicles"].values():
        for name, spread in (("s", 20), ("length", 10), ("v_lon", 2)):
            more = shuffled.randint(-spread, spread) + (faster if name == "v_lon" else 0)
            vehicle[name] = str(Fraction(vehicle[name]) + Fraction(more, 100))
    kept = {name: x for name, x in drive.items() if name not in ("verdict", "scenario")}
    return {**kept, "set": "base", "formula": _VALID, "scenario": None}


def make_formulas(folder: Path, count: int) -> None:
    """A catalogue.toml of scenarios with ranges at the start, one a scenario."""
    entries = []
    for k in range(count):
        speed = _SPEEDS[k % len(_SPEEDS)]
        entries.append(
            f'[[test]]\nid = "F{k + 1:02}"\nformula = "scenario_{k + 1}(SV,POV,L)"\n'
            f'at_start = {{ "v_lon(SV)" = "{speed}" }}\nclaims = [{k + 1}]\n'
        )
    (folder / "catalogue.toml").write_text("\n".join(entries))


if __name__ == "__main__":
    main()
