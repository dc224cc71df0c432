"""Which faults are tried: a number of them, by a seed, spread over files by size and over operators."""

from functools import cache
from hashlib import sha256
from itertools import zip_longest
from math import sqrt
from pathlib import Path

from mutants.edits import Edit, edits_of, is_fault
from mutants.spec_edits import spec_edits_of

FOLDERS = {
    "semantics/exact": "judge",
    "semantics/sampled": "extensions/traffic/monitoring",
    "engines/encode": "encode",
    "engines/solve": "solve",
    "evidence": "evidence",
    "engines/prove": "proving",
    "engines/search": "searching",
    "extensions/traffic/formats": "formats",
    "extensions/traffic/evaluate": "evaluation",
    "extensions/traffic/simulate": "simulation",
    "extensions/exchange/export": "extensions/exchange/exporting",
    "extensions/drivers": "extensions/drivers",
    "extensions/drivers/preventable": "extensions/drivers",
    "extensions/kernel/derivations": "deriving",
    "extensions/kernel": "extensions/kernel",
    "extensions/pages/studio": "extensions/pages/studio",
    "frontends/api": "api",
    "extensions/catalogue": "extensions/catalogue",
}
"""Folders whose files get faults, and the folder below ``tests`` whose tests have to notice."""

SPECS = "library/sets"
SPEC_WEIGHT = 3  # a definition says in a line what takes Python a page


def targets(package: Path) -> list[Path]:
    """The files that faults are made in, relative to the package."""
    python = [path for folder in FOLDERS for path in sorted((package / folder).rglob("*.py"))]
    python = list(dict.fromkeys(python))  # some of these folders contain others
    specs = sorted((package / SPECS).glob("*.spec"))
    return [path.relative_to(package) for path in (*python, *specs)]


@cache
def faults_of(package: Path, file: Path) -> list[Edit]:
    text = (package / file).read_text("utf-8")
    return spec_edits_of(str(file), text) if file.suffix == ".spec" else edits_of(str(file), text)


def choose(package: Path, number: int, seed: int, only: str = "") -> list[Edit]:
    """About ``number`` faults of all targets, and of them those whose file begins with ``only``, or one of
    several beginnings with commas between them.

    A file's share goes by the square root of how many faults it could have, so that long files do not
    crowd out short ones. Each fault has its rank by seed and key, so a change elsewhere moves no other.
    """
    every = {file: faults_of(package, file) for file in targets(package)}
    every = {file: faults for file, faults in every.items() if faults}
    weights = {file: sqrt(len(faults)) for file, faults in every.items()}
    weights |= {file: SPEC_WEIGHT * weight for file, weight in weights.items() if file.suffix == ".spec"}
    whole = sum(weights.values())
    chosen: list[Edit] = []
    for file, faults in every.items():
        share = max(1, round(number * weights[file] / whole))
        if str(file).startswith(tuple(only.split(","))):
            chosen += _best(faults, share, seed, (package / file).read_text("utf-8"))
    return chosen


def _best(faults: list[Edit], number: int, seed: int, text: str) -> list[Edit]:
    """The first ``number`` by rank, one of each operator in turns."""
    by_operator: dict[str, list[Edit]] = {}
    for fault in sorted(faults, key=lambda x: rank(x, seed)):
        by_operator.setdefault(fault.operator, []).append(fault)
    found: list[Edit] = []
    for turn in zip_longest(*by_operator.values()):
        for fault in turn:
            if fault is not None and len(found) < number and is_fault(fault, text):
                found.append(fault)
        if len(found) == number:
            break
    return found


def rank(fault: Edit, seed: int) -> str:
    return sha256(f"{seed}:{fault.key}".encode()).hexdigest()


def folder_of(file: str) -> str:
    """The folder of ``FOLDERS`` that a file is in, the innermost; that of specifications for the others."""
    inside = [folder for folder in FOLDERS if file.startswith(f"{folder}/")]
    return max(inside, key=len, default=SPECS)


def noticing_tests(file: str) -> str:
    """The folder below ``tests`` whose tests have to notice a fault in ``file``; empty where none has to."""
    return FOLDERS.get(folder_of(file), "")
