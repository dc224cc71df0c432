"""Writes the problems of searches: a file and a table of its rows for each assignment of lanes."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import assert_never

from roadproof.engines.setting import Search, SearchOptions
from roadproof.engines.solve.highs import model_text
from roadproof.errors import UsageError
from roadproof.extensions.encoding.kinds import Drives, Target
from roadproof.extensions.encoding.naming import Naming, QuestionPart
from roadproof.extensions.encoding.posed import PosedSearch, posed_searches
from roadproof.extensions.encoding.row_table import RowDescriber
from roadproof.extensions.encoding.smt_file import smt_file
from roadproof.frontends.api.definitions import Definitions, What
from roadproof.frontends.api.settings import setting
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.sheet import aligned
from roadproof.frontends.settings.groups import SearchPlace
from roadproof.runtime.files import lock_folder, write_atomic
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road

ROWS = ".rows.csv"


@dataclass(frozen=True)
class ProblemFile:
    """A problem as text, with the part of the question that each row or assertion encodes."""

    name: str
    naming: Naming
    target: Target
    text: str
    rows: Sequence[tuple[str, QuestionPart]]

    @property
    def files(self) -> Mapping[str, str]:
        """The texts of the problem and of the table of its rows, by the name of their file."""
        table = RowDescriber(self.naming.posed).table(self.rows)
        return {f"{self.name}.{self.target}": self.text, f"{self.name}{ROWS}": table}


@dataclass(frozen=True, repr=False)
class CompiledProblems(Table):
    """The problems of searches as files; ``folder``: where they are, None where in none."""

    problems: tuple[ProblemFile, ...]
    folder: Path | None = None

    @property
    def road(self) -> Road:
        """The road of the searches."""
        return self.problems[0].naming.posed.question.road

    @property
    def files(self) -> Mapping[str, str]:
        """The texts of all files by name."""
        return {name: text for x in self.problems for name, text in x.files.items()}

    def rows(self) -> list[Row]:
        """A row for each problem: its lanes, sizes, and what its solutions are."""
        return [self._row(x) for x in self.problems]

    def _row(self, file: ProblemFile) -> Row:
        posed = file.naming.posed
        unknowns = len(posed.problem.columns)
        choices = 0 if file.target == "smt2" else len(posed.program.program.binaries)
        return {
            "file": f"{file.name}.{file.target}",
            "lanes": ", ".join(f"{name}={lane}" for name, lane in posed.lanes.items()),
            "drives": posed.drives,
            "unknowns": unknowns,
            "choices": choices,
            "rows": len(file.rows),
            "steps": posed.question.grid.steps,
            "dt": float(posed.question.grid.dt),
        }

    def __str__(self) -> str:
        rows = self.rows()
        head = tuple(rows[0])
        body = [tuple("" if x is None else str(x) for x in row.values()) for row in rows]
        lines = aligned(
            [head, *body], [name in ("unknowns", "choices", "rows", "steps", "dt") for name in head]
        )
        if self.folder is not None:
            lines.append(f"written to {self.folder}, each with a table of its rows (NAME{ROWS})")
        return "\n".join(line.rstrip() for line in lines)

    def __repr__(self) -> str:
        return f"<Problems of searches: {', '.join(x.name for x in self.problems)}>"


def compile_problems(
    home: Definitions, formulas: Mapping[str, What], target: Target, place: SearchPlace, drives: Drives
) -> CompiledProblems:
    """Return the problems of some formulas by label, one for each assignment of lanes.

    Raises ``InputError``, ``TextError``, ``UsageError``.
    """
    return CompiledProblems(
        tuple(
            x for label, what in formulas.items() for x in _problems(home, label, what, target, place, drives)
        )
    )


def _problems(
    home: Definitions, label: str, what: What, target: Target, place: SearchPlace, drives: Drives
) -> Iterator[ProblemFile]:
    for posed in pose_formula(home, what, place, drives):
        naming = Naming(posed)
        text, rows = problem_text(naming, target)
        yield ProblemFile(f"{label}{posed.suffix}", naming, target, text, rows)


def pose_formula(
    home: Definitions, what: What, place: SearchPlace, drives: Drives
) -> tuple[PosedSearch, ...]:
    """Return the problems of a formula. Raises as ``compile_problems``."""
    number, query = home.numbered(what)
    search = Search(home.specification, query, setting(home, place), SearchOptions(), scenario=number)
    if drives != "natural":
        search = replace(search, setting=replace(search.setting, natural=False))
    return posed_searches(search, drives)


def problem_text(naming: Naming, target: Target) -> tuple[str, Sequence[tuple[str, QuestionPart]]]:
    """Return a problem as text, and the part that each row or assertion encodes. Raises ``UsageError``."""
    match target:
        case "smt2":
            file = smt_file(naming)
            return file.text, file.assertions
        case "mps" | "lp":
            columns = naming.columns
            unreadable = [x for x in columns if x[0] in "eE"] if target == "lp" else []
            if unreadable:
                raise UsageError(f"to=lp: readers of LP take '{unreadable[0]}' for a number; write mps")
            names = [name for name, _ in naming.rows]
            return model_text(naming.posed.program.program, columns, names, target), naming.rows
        case _:
            assert_never(target)


def write_problems(problems: CompiledProblems, folder: Path) -> CompiledProblems:
    """Write all files of problems into a folder. Raises ``InputError`` where it cannot be written."""
    with lock_folder(folder):
        for name, text in problems.files.items():
            write_atomic(folder / name, text.encode())
    return replace(problems, folder=folder)
