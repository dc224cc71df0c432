"""Catalogues of drives: a drive of every class, one of them taken away, and a thousand.

``python benchmarks/catalogue.py [FOLDER]``; FOLDER is where the drives are, or will be, made (``classes``).
Prints what came out, seconds and memory; fails where a class that was taken away is not the one that is
missing, or where the thousand show something else than each by itself.
"""

import resource
import shutil
import sys
import tempfile
import time
from pathlib import Path

import roadproof as rp
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.judge_test import judge_test

THOUSAND = 1000


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "classes")
    if not (folder / "index.json").exists():
        rp.classify(shares=False, out=folder)
    drives = sorted((folder / "drives").glob("*.json"))
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        all_of_them = put(place / "all", drives)
        found = told("a drive of every class", all_of_them)
        assert not found.missing, found.missing
        assert len(drives) == len(found.tested.targets) - 24
        (all_of_them / drives[40].name).unlink()
        found = told("one taken away", all_of_them)
        assert found.missing == (drives[40].stem,), found.missing
        made = found.complete(place / "more")
        print(f"  {made}".replace(name, ""))
        found = catalogued(all_of_them, place / "more")
        assert not found.missing
        thousand = put(place / "thousand", drives, THOUSAND)
        found = told(f"{THOUSAND} drives", thousand)
        formulas = found.view.formulas
        alone = {path.stem: judge_test(ConcreteTest("", str(path)), formulas, Freedom()) for path in drives}
        for x in found.concrete:
            assert x.names == alone[x.entry.id.rpartition("~")[0]].names
        print(f"  each shows what it shows by itself; {len(found.tested.alike)} groups say the same")


def put(folder: Path, drives: list[Path], count: int = 0) -> Path:
    """Copies of drives: each once, or in turns until there are so many."""
    folder.mkdir()
    for k in range(count or len(drives)):
        path = drives[k % len(drives)]
        shutil.copy(path, folder / (f"{path.stem}~{k}.json" if count else path.name))
    return folder


def catalogued(*folders: Path) -> CatalogueAnswer:
    return rp.catalogue(*folders)


def told(what: str, folder: Path) -> CatalogueAnswer:
    begun = time.monotonic()
    found = catalogued(folder)
    seconds = time.monotonic() - begun
    peak = max(resource.getrusage(x).ru_maxrss for x in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    missing = ", ".join(found.missing) or "nothing"
    print(
        f"{what}: {seconds:.1f} s, {peak / 1024:.0f} MiB the largest process; missing: {missing}", flush=True
    )
    return found


if __name__ == "__main__":
    main()
