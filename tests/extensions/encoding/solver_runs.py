"""``make solvers``: the searches for drives of all scenarios, as files, put to solvers of others.

The problems are those of the 24 scenarios in base and ext: of each the first assignment of its lane for which
the search's own solver finds a solution, and those for which it finds that no drive exists. Every solution is
read back and judged as ``witness --solution`` does. runs.csv keeps one line for each solver and problem, and
docs/data/solvers.csv counts them. ``--solver NAME`` asks one solver; ``--every K`` asks about each K-th
problem, and about all without a drive. A verdict that contradicts ends the run.
"""

import argparse
import csv
import functools
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import Literal, TypeAlias

import roadproof as rp
from extensions.encoding.outside import SOLVERS, Solver, Status
from roadproof.engines.solve.milp import column_box, solve_mixed
from roadproof.errors import InputError
from roadproof.extensions.encoding.encode import Encoding
from roadproof.extensions.encoding.judging import NoWitnessError, columns_of, judged
from roadproof.extensions.encoding.naming import Naming
from roadproof.extensions.encoding.solutions import read_solution
from tally import Table, rows

ROOT = Path(__file__).parents[3]
RUNS = Path(__file__).with_name("runs.csv")
TABLE = ROOT / "docs/data/solvers.csv"
SETS = ("base", "ext")
GRIDS = ("0.6", "0.3", "0.15")
"""Steps in s; for mixed-integer solvers a finer one where a solution is no witness between samples."""
Reading: TypeAlias = Literal["witness", "no witness", "irrational", ""]
"""What the judge says of a solution; empty where a solver gave none."""


@dataclass(frozen=True)
class Problem:
    """A scenario of a set under one assignment of its lane, and whether a drive exists."""

    home: str
    number: int
    lane: str
    expected: Status

    def encoding(self, dt: str) -> Encoding:
        """Return its problem on a grid."""
        return rp.encode(self.number, using=rp.load(self.home), lanes={"L": self.lane}, dt=dt)

    @property
    def key(self) -> tuple[str, str, str]:
        return self.home, str(self.number), self.lane


@dataclass(frozen=True)
class Run:
    """A line of runs.csv: what a solver says of a problem on the coarsest grid, and of finer ones."""

    solver: str
    version: str
    home: str
    number: str
    lane: str
    expected: str
    verdict: str
    reading: str
    finer: str
    """The step in s of the grid on which a solution is a witness, if it is not the coarsest."""

    @property
    def key(self) -> tuple[str, str, str]:
        return self.home, self.number, self.lane


def solved_here(encoding: Encoding) -> Status:
    """The status of the search's own solver."""
    posed = encoding.posed
    side, pieces = ("outer", 2) if posed.drives == "outer" else ("inner", 1)
    status = solve_mixed(posed.problem, column_box(posed.problem), side, pieces).status
    named: dict[str, Status] = {"found": "solved", "infeasible": "infeasible", "unknown": "open"}
    return named[status]


def solve_and_judge(folder: Path, encoding: Encoding, solver: Solver) -> tuple[Status, Reading]:
    """Return the status of a solver, and what the judge says of its solution.

    Raises ``InputError`` for a solution that breaks a row.
    """
    model, solution = folder / f"model.{solver.suffix}", folder / "solution"
    solution.unlink(missing_ok=True)
    model.write_text(encoding.text(solver.suffix))
    status = solver.solve(model, solution)
    if status != "solved" or encoding.posed.drives == "outer":
        return status, ""
    try:
        values = columns_of(Naming(encoding.posed), read_solution(solution))
        judged(encoding.posed, values, solver.name)
    except NoWitnessError:
        return status, "no witness"
    except InputError as error:
        if "irrational value" in str(error):
            return status, "irrational"
        raise
    return status, "witness"


@functools.cache
def problems() -> tuple[Problem, ...]:
    """All problems, in the order of sets and scenarios."""
    return tuple(x for home in SETS for number in range(1, 25) for x in problems_of(home, number))


def sample(every: int) -> Iterator[Problem]:
    """Yield each so many-th problem, and all without a drive."""
    for k, problem in enumerate(problems()):
        if k % every == 0 or problem.expected == "infeasible":
            yield problem


def problems_of(home: str, number: int) -> Iterator[Problem]:
    """Yield the problem of the first assignment that has a witness, and those without a drive."""
    first = rp.encode(number, using=rp.load(home))
    has_witness = False
    for posed in (first.posed, *first.others):
        status = solved_here(Encoding(posed))
        if status == "infeasible" or not has_witness:
            yield Problem(home, number, posed.lanes["L"], status)
        has_witness = has_witness or status == "solved"


def run(problem: Problem, solver: Solver, version: str) -> Run:
    """Return what a solver says of a problem. Raises ``ValueError`` where it contradicts the search."""
    with tempfile.TemporaryDirectory() as folder:
        status, reading = solve_and_judge(Path(folder), problem.encoding(GRIDS[0]), solver)
        if contradicts(status, problem.expected):
            raise ValueError(f"{solver.name} says {status} of {problem}")
        finer = ""
        is_tried_again = reading == "no witness" and solver.suffix == "mps"
        for dt in GRIDS[1:] if is_tried_again else ():
            if solve_and_judge(Path(folder), problem.encoding(dt), solver)[1] == "witness":
                finer = dt
                break
    return Run(solver.name, version, *problem.key, problem.expected, status, reading, finer)


def contradicts(one: str, other: str) -> bool:
    """Whether two statuses are different verdicts; one that a limit or the clock ended is none."""
    return {one, other} == {"solved", "infeasible"}


def read_runs(path: Path = RUNS) -> tuple[Run, ...]:
    """Return the runs that are kept."""
    with path.open(encoding="utf-8", newline="") as file:
        return tuple(Run(**line) for line in csv.DictReader(file))


def write_runs(runs: Iterable[Run]) -> None:
    """Write runs in the order of solvers and problems."""
    order = {x.key: k for k, x in enumerate(problems())}
    names = [*SOLVERS]
    kept = sorted(runs, key=lambda x: (names.index(x.solver), order[x.key]))
    with RUNS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(x.name for x in fields(Run))
        writer.writerows(astuple(x) for x in kept)


def table(runs: Sequence[Run]) -> Table:
    """Return the table of the page: a row for each solver."""
    head = ("solver", "file", "limit", "problems", "same verdict", "limit reached")
    head += (
        "ended by the clock",
        "judged witnesses",
        "no witness between samples",
        "of these, one on a finer grid",
    )
    body = []
    for solver in SOLVERS.values():
        of_it = [x for x in runs if x.solver == solver.name]
        if of_it:
            body.append(_row(solver, of_it))
    return rows(head, body)


def _row(solver: Solver, runs: Sequence[Run]) -> tuple[object, ...]:
    """Return the row of one solver."""
    versions = ", ".join(sorted({x.version for x in runs}))
    return (
        f"{solver.title} {versions}",
        solver.suffix,
        f"`{solver.limit}`",
        len(runs),
        sum(x.verdict == x.expected for x in runs),
        sum(x.verdict == "open" for x in runs),
        sum(x.verdict == "clock" for x in runs),
        sum(x.reading == "witness" for x in runs),
        sum(x.reading == "no witness" for x in runs),
        sum(bool(x.finer) for x in runs),
    )


def main(words: list[str]) -> int:
    """Ask solvers about the problems; return the exit code."""
    parser = argparse.ArgumentParser(prog="make solvers", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--solver", choices=[*SOLVERS], action="append", help="ask only this one")
    parser.add_argument("--every", type=int, default=1, metavar="K", help="ask about each K-th problem (1)")
    args = parser.parse_args(words)
    runs = list(read_runs()) if RUNS.is_file() else []
    for name in args.solver or SOLVERS:
        solver = SOLVERS[name]
        if not solver.is_installed():
            print(f"{name}: not installed, its lines are left as they are", file=sys.stderr)
            continue
        runs = [x for x in runs if x.solver != name]
        version = solver.version()
        for problem in sample(args.every):
            runs.append(run(problem, solver, version))
            print(*astuple(runs[-1]), flush=True)
        write_runs(runs)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
