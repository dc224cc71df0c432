"""``python -m core.alone FOLDER``: the core without its extensions, in a tree and with packages of its own.

FOLDER gets the package without ``extensions``, and links to the packages that the core needs, to no others.
There the core proves the template properties, finds a drive for each scenario, decides all pairs, and checks
all of it; its tests run, too, with ``--tests``.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("z3-solver", "numpy", "scipy", "highspy", "clarabel", "cvxpy", "sympy", "lark")
"""What the core is installed with, and what these need."""
FOR_TESTS = ("pytest", "hypothesis", "jsonschema", "cvc5")
TESTING = {"PYTHONDONTWRITEBYTECODE": "1"}
_EXTENSION = re.compile(r"^\s*(?:from|import) (?:(?:roadproof\.)?extensions|cli|documents)\b", re.M)
FOLDERS = (
    "encode",
    "evidence",
    "judge",
    "logic",
    "proving",
    "questions",
    "searching",
    "solve",
    "spec",
    "world",
)
"""The folders of tests that are about the core."""
COMMANDS = (
    "prove --out proofs",
    "witness --all --out drives",
    "overlap --no-pictures --out pairs",
    "compare 'scenario_1(SV,POV,L)' 'scenario_4(SV,POV,L)'",
    "list",
    "show 4",
    "check proofs drives pairs",
)

NOTES = {"witness --all --out drives": "no pictures of drives: no installed extension draws them"}
"""What commands say on stderr, as extensions are missing."""


def needed(names: tuple[str, ...]) -> set[str]:
    """The distributions that some need, themselves among them; what is not installed is left out."""
    found: set[str] = set()
    waiting = [*names]
    while waiting:
        name = re.sub(r"[-_.]+", "-", waiting.pop()).lower()
        try:
            requires = distribution(name).requires or []
        except PackageNotFoundError:
            continue
        if name not in found:
            found.add(name)
            waiting += [re.split(r"[\s;<>=!~\[(]", x)[0] for x in requires if "extra ==" not in x]
    return found


def make(folder: Path, more: tuple[str, ...] = ()) -> dict[str, str]:
    """Make the tree; return the environment in which the core alone is found."""
    skipped = shutil.ignore_patterns("extensions", "__pycache__")
    shutil.copytree(ROOT / "src/roadproof", folder / "src/roadproof", ignore=skipped)
    for name in ("proofs", "models"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("kernel"))
    site = folder / "site"
    site.mkdir()
    for name in needed((*PACKAGES, *more)):
        for file in distribution(name).files or ():
            top = file.parts[0]
            target = Path(str(distribution(name).locate_file(top)))
            if top not in ("..", "__pycache__") and target.exists() and not (site / top).exists():
                (site / top).symlink_to(target)
    paths = os.pathsep.join([str(folder / "src"), str(site)])
    return {
        **os.environ,
        "PYTHONPATH": paths,
        "PYTHONNOUSERSITE": "1",
        "XDG_CACHE_HOME": str(folder / "cache"),
    }


def add_tests(folder: Path) -> list[str]:
    """Add the tests of the core with their helpers; return the paths of those that need no extension."""
    skipped = shutil.ignore_patterns("extensions", "__pycache__", "documents", "cli", "attacks", "findings")
    shutil.copytree(ROOT / "tests", folder / "tests", ignore=skipped)
    for name in ("pyproject.toml", "examples", "docs"):
        source, target = ROOT / name, folder / name
        shutil.copytree(source, target) if source.is_dir() else shutil.copy(source, target)
    files = (x for name in FOLDERS for x in sorted((folder / "tests" / name).glob("test_*.py")))
    return [str(x.relative_to(folder)) for x in files if not _needs_extension(x)]


def _needs_extension(test: Path) -> bool:
    """Return whether a file of tests, or a helper beside it that it imports, needs an extension."""
    text = test.read_text("utf-8")
    beside = re.findall(rf"^from {test.parent.name}\.(\w+) import", text, re.M)
    helpers = (test.with_name(f"{x}.py") for x in beside)
    return any(_EXTENSION.search(x) for x in (text, *(y.read_text("utf-8") for y in helpers)))


def run(folder: Path, environment: dict[str, str], *words: str) -> subprocess.CompletedProcess[str]:
    """Run Python without the packages of this environment."""
    command = [sys.executable, "-S", *words]
    return subprocess.run(command, cwd=folder, env=environment, text=True, capture_output=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tests", action="store_true", help="run the tests of the core, too")
    args = parser.parse_args()
    folder = args.folder.resolve()
    environment = make(folder, FOR_TESTS if args.tests else ())
    wrong = 0
    for words in COMMANDS:
        done = run(folder, environment, "-m", "roadproof", *shell_words(words))
        last = (done.stdout.strip().splitlines() or done.stderr.strip().splitlines() or [""])[-1]
        print(f"{done.returncode}  roadproof {words}: {last}", flush=True)
        wrong += done.returncode != 0 or NOTES.get(words, "") not in done.stderr
    if args.tests:
        files = add_tests(folder)
        done = run(folder, environment | TESTING, "-m", "pytest", "-q", "-m", "not long", *files)
        print(f"{done.returncode}  {len(files)} files of tests: {done.stdout.strip().splitlines()[-1]}")
        if done.returncode:
            print(done.stdout[-6000:], done.stderr[-2000:], file=sys.stderr)
        wrong += done.returncode != 0
    loaded = run(folder, environment, "-c", "import roadproof as rp; print(rp.coverage)")
    print(f"{loaded.returncode}  rp.coverage: {loaded.stderr.strip().splitlines()[-1]}")
    wrong += "has no attribute 'coverage'" not in loaded.stderr
    return 1 if wrong else 0


def shell_words(text: str) -> list[str]:
    """A command line in words."""
    import shlex

    return shlex.split(text)


if __name__ == "__main__":
    sys.exit(main())
