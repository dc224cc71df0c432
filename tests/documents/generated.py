"""Files of the repository that programs make from the source: ``make generated`` makes all of them again.

With ``--check`` nothing is written: each file that differs is named, and the exit code is 1. ``--list``
prints the paths. Figures that take long to compute have commands of their own: ``make findings``,
``make evidence``, ``make mutants``, ``make fuzz`` and ``python -m tally``.
"""

import argparse
import os
import runpy
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple, TypeAlias

import tally
from documents import drawings, keywords_file, reference, rooms, schemas, stub, trusted
from extensions.encoding import solver_runs
from extensions.kernel import extract
from roadproof.extensions.pages.studio.gallery import SHIPPED, make_shipped_cards
from roadproof.runtime.archives import SWITCH

ROOT = Path(__file__).parents[2]
SHIPPED_CARDS = ROOT / "src/roadproof/extensions/pages/studio" / SHIPPED
Contents: TypeAlias = Mapping[Path, bytes]
"""The content of each file by its path."""


class Generator(NamedTuple):
    """A function that makes files; without ``program`` on the path they stay as they are."""

    title: str
    make: Callable[[], Contents]
    program: str = ""

    @property
    def is_ready(self) -> bool:
        """Whether all that makes the files is installed."""
        return not self.program or shutil.which(self.program) is not None


def _keywords() -> Contents:
    return {path: keywords_file.text(homes).encode() for path, homes in keywords_file.modules().items()}


def _stub() -> Contents:
    return {stub.FILE: stub.text().encode()}


def _schemas() -> Contents:
    folder = ROOT / "docs/schema"
    return {folder / name: schemas.as_text(content).encode() for name, content in schemas.schemas()}


def _exit_codes() -> Contents:
    return {ROOT / "docs" / name: make().encode() for name, make in reference.CHECKED_IN.items()}


def _drawings() -> Contents:
    return {drawings.FOLDER / name: draw().encode() for name, draw in drawings.DRAWINGS.items()}


def _tables_of_tests() -> Contents:
    return {
        tally.FOLDER / f"{name}.csv": tally.text(table()).encode() for name, table in tally.TABLES.items()
    }


def _solvers() -> Contents:
    return {solver_runs.TABLE: tally.text(solver_runs.table(solver_runs.read_runs())).encode()}


def _requirements() -> Contents:
    script = ROOT / "examples/assurance/make_requirements.py"
    tables: Iterable[str] = runpy.run_path(str(script))["tables"]()
    return {script.with_name("requirements.toml"): "\n".join(tables).encode()}


def _rooms() -> Contents:
    known = rooms.lines_in(rooms.TABLE.read_text("utf-8"))
    return {rooms.TABLE: rooms.table(known).encode()}


def _trusted() -> Contents:
    return {trusted.PAGE: trusted.counted(trusted.PAGE.read_text("utf-8")).encode()}


def _cards() -> Contents:
    before = os.environ.pop(SWITCH, None)
    try:
        return {SHIPPED_CARDS: make_shipped_cards().encode()}
    finally:
        if before is not None:
            os.environ[SWITCH] = before


def _extracted() -> Contents:
    return {extract.CHECKER: extract.extracted()}


GENERATORS = (
    Generator("keyword arguments of questions", _keywords),
    Generator("the stub of public names", _stub),
    Generator("JSON Schemas", _schemas),
    Generator("the page of exit codes", _exit_codes),
    Generator("drawings", _drawings),
    Generator("tables about the tests", _tables_of_tests),
    Generator("the table of solvers", _solvers),
    Generator("requirements of an example", _requirements),
    Generator("cards of the studio's gallery", _cards),
    Generator("the table of folders", _rooms),
    Generator("the tables of the code to trust", _trusted),
    Generator("the program that Coq extracts", _extracted, program="coqc"),
)
"""All generators; those that count lines come after those that write Python files."""


def differences(contents: Contents) -> Iterator[Path]:
    """Yield the files that are missing or have another content."""
    for path, content in contents.items():
        if not path.is_file() or path.read_bytes() != content:
            yield path


def run(generators: Iterable[Generator], write: bool) -> list[Path]:
    """Return the files that differ from those that the generators make; with ``write``, write them."""
    different: list[Path] = []
    for generator in generators:
        if not generator.is_ready:
            print(
                f"{generator.title}: left as they are, {generator.program} is not installed", file=sys.stderr
            )
            continue
        contents = generator.make()
        changed = [*differences(contents)]
        for path in changed if write else ():
            path.write_bytes(contents[path])
        different += changed
    return different


def main(words: list[str]) -> int:
    """Run the command; return its exit code."""
    parser = argparse.ArgumentParser(prog="make generated", description=__doc__.partition("\n")[0])
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument("--check", action="store_true", help="name the files that differ, and write nothing")
    choice.add_argument("--list", action="store_true", help="print the paths of all files, and write nothing")
    args = parser.parse_args(words)
    if args.list:
        for path in (path for x in GENERATORS if x.is_ready for path in x.make()):
            print(path.relative_to(ROOT))
        return 0
    different = run(GENERATORS, write=not args.check)
    for path in different:
        name = path.relative_to(ROOT)
        print(f"{name} differs; run: make generated" if args.check else f"{name} is written")
    return 1 if args.check and different else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
