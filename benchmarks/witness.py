"""A judged drive for every scenario: seconds by stage, and plain z3 on the exact encoding beside it.

Run: ``.venv/bin/python benchmarks/witness.py [--sets base,extA,ext] [--z3 LIMIT]``. Everything runs in
one process, so that the seconds are those of one core; ``--z3 0`` leaves the comparison out.
"""

import argparse
import resource
import statistics
import time
from dataclasses import replace
from fractions import Fraction

from roadproof.engines.encode.build import NO_MARGIN, assemble_problem, encode_formula
from roadproof.engines.encode.motion import ColumnLayout, custom_signal_ranges
from roadproof.engines.search.drive_search import search_drive
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.search.question import pose
from roadproof.engines.setting import Search
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import preload_solvers
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario, apply_scenario
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

STAGES = ("encode", "solve", "shape", "judge", "all")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sets", default="base")
    parser.add_argument("--z3", type=float, default=60.0, metavar="LIMIT", help="seconds for z3, 0 for none")
    args = parser.parse_args()
    preload_solvers()
    library = bundled_library()
    rows, answers = [], {}
    print(f"{'set':5} {'row':>3}  verdict      " + "".join(f"{s:>8}" for s in STAGES) + "   z3 exact")
    for set_name in args.sets.split(","):
        for number in range(1, 25):
            specification = library.select(set_name)
            query = apply_scenario(specification, Scenario(number, set_name))
            asked = Search(specification, query, scenario=number)
            outcome = search_drive(asked)
            rows.append(outcome)
            shown = "".join(f"{outcome.seconds.get(s, 0.0):8.3f}" for s in STAGES)
            beside = ""
            if args.z3 > 0 and lanes_of(outcome):
                seconds, status = plainly(asked, lanes_of(outcome), args.z3)
                answers.setdefault(status, []).append(seconds)
                beside = f"   {seconds:7.2f} {status}"
            print(f"{set_name:5} {number:3}  {outcome.verdict:11}  {shown}{beside}", flush=True)
    totals = [row.seconds["all"] for row in rows]
    found = sum(row.verdict is Verdict.WITNESSED for row in rows)
    print(f"{found} of {len(rows)} witnessed, {sum(row.natural for row in rows)} natural")
    print(
        f"seconds: median {statistics.median(totals):.2f}, greatest {max(totals):.2f}, sum {sum(totals):.1f}"
    )
    for status, seconds in answers.items():
        print(f"plain z3, exact encoding: {len(seconds)} {status}, sum {sum(seconds):.1f} s")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory {peak:.0f} MiB")


def lanes_of(outcome: SearchOutcome) -> dict[str, str]:
    """The lane that the drive was judged with."""
    return dict(outcome.drives[0].file.lanes) if outcome.drives else {}


def plainly(search: Search, lanes: dict[str, str], limit: float) -> tuple[float, str]:
    """Seconds and answer of z3 on the exact encoding of the same question, on the same grid."""
    question = pose(search.specification.library, search.query, search.setting)
    assumptions = replace(question.assumptions.plain(), margin=NO_MARGIN, inside=Fraction(0))
    grid = question.grid
    begun = time.perf_counter()
    formula, vehicles = question.bound(lanes), question.vehicles
    layout = ColumnLayout(tuple(vehicles), grid, custom_signal_ranges(formula))
    wanted = encode_formula(formula, vehicles, layout, assumptions)
    problem = assemble_problem(wanted, question.road, vehicles, layout, assumptions)
    status = solve_exactly(problem, Effort(limit).meter()).status
    return time.perf_counter() - begun, {"found": "sat", "infeasible": "unsat"}.get(status, "gave up")


if __name__ == "__main__":
    main()
