"""What came out, one JSON line a fault, kept by its key: a run that stopped goes on where it was."""

import ast
import json
import tomllib
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path

from mutants.choose import faults_of
from mutants.edits import Edit
from mutants.places import functions_of
from mutants.trial import Outcome

HERE = Path(__file__).parent
RESULTS = HERE / "results.jsonl"
EQUIVALENT = HERE / "equivalent.toml"


@dataclass(frozen=True)
class Line:
    """An outcome with the fault it belongs to. ``of`` and ``among``: digests of the function that was
    changed and of all tests, by which a result that is out of date is known.
    """

    key: str
    file: str
    line: int
    operator: str
    context: str
    before: str
    after: str
    verdict: str
    by: str
    tests: int
    seconds: float
    of: str
    among: str


def line_of(edit: Edit, outcome: Outcome, package: Path, among: str) -> Line:
    """The line of the journal for a fault."""
    words = (edit.operator, edit.context, edit.before, edit.after)
    told = (outcome.verdict, outcome.by, outcome.tests, outcome.seconds)
    return Line(edit.key, edit.file, edit.lines[0], *words, *told, function_digest(edit, package), among)


def function_digest(edit: Edit, package: Path) -> str:
    """Of the function around a fault; of its statement where there is none."""
    name = edit.context.partition("|")[0]
    text = (package / edit.file).read_text("utf-8")
    content = edit.context
    if edit.file.endswith(".py"):
        content = next((ast.unparse(x) for n, x in functions_of(ast.parse(text)) if n == name), content)
    return _digest(content)


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:12]


def tests_digest(root: Path) -> str:
    """Of every test file and what stands beside it, the faults' own results left out."""
    digest = sha256()
    for path in sorted(x for x in (root / "tests").rglob("*.*") if x.suffix in (".py", ".toml")):
        digest.update(str(path.relative_to(root)).encode() + path.read_bytes())
    return digest.hexdigest()[:12]


def read(path: Path = RESULTS) -> dict[str, Line]:
    """The lines by key; the last of a key counts."""
    if not path.exists():
        return {}
    lines = [Line(**json.loads(line)) for line in path.read_text("utf-8").splitlines()]
    return {line.key: line for line in lines}


def is_current(line: Line, edit: Edit, package: Path, among: str) -> bool:
    """Whether the fault need not be tried again: what was caught stays caught, what survived may not.

    What nobody could see survives whatever the tests are.
    """
    if line.of != function_digest(edit, package):
        return False
    settled = line.verdict in ("caught", "hung") or line.key in equivalents()
    return settled or line.among == among


def of_present_source(lines: Iterable[Line], package: Path) -> list[Line]:
    """The lines of faults that can still be made in a function that is as it was when they were tried.

    Of equivalent faults the function may have changed: an argument speaks for them, which a test keeps.
    """
    equivalent = equivalents()
    return [x for x in lines if x.key in equivalent or is_of_present_source(x, package)]


def is_of_present_source(line: Line, package: Path) -> bool:
    """Whether the function of a fault is as it was; without a function, whether the fault can be made."""
    function, path = line.context.partition("|")[0], package / line.file
    if not path.is_file():
        return False
    if not function or path.suffix != ".py":
        return any(edit.key == line.key for edit in faults_of(package, Path(line.file)))
    named = dict(functions_of(ast.parse(path.read_text("utf-8"))))
    return function in named and line.of == _digest(ast.unparse(named[function]))


def write(lines: Iterable[Line], path: Path = RESULTS) -> None:
    """All lines, in the order of file and line."""
    ordered = sorted(lines, key=lambda x: (x.file, x.line, x.key))
    shown = [json.dumps(asdict(line), ensure_ascii=False) for line in ordered]
    path.write_text("\n".join(shown) + "\n", "utf-8")


def append(line: Line, path: Path = RESULTS) -> None:
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(line), ensure_ascii=False) + "\n")


def equivalents(path: Path = EQUIVALENT) -> dict[str, str]:
    """Key of a fault that changes nothing anybody could see, to the argument why."""
    return {key: entry["why"] for key, entry in tomllib.loads(path.read_text("utf-8")).items()}
