"""The same answer every time: 30 command lines, on an idle machine and under load, with 1 and 2 processes.

    .venv/bin/python benchmarks/same_answers.py [--only PATTERN] [--quick] [--out FOLDER]

Each line is run with ``--json -`` under every condition. Exit code, complaints and all of the JSON but for
seconds have to be the same: verdicts, counts, reasons, drives and certificates. What was run is kept in
FOLDER, so that a run that was broken off goes on; remove the folder to begin anew. Exit code 1 where two
answers differ. The load is N processes at any time, which compete for every core: as many of the command
lines at once as there are left, and busy loops for the rest of N.
"""

import argparse
import contextlib
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

CLOSER = "scenario_4@ext(SV,POV,L) and not scenario_4@extA(SV,POV,L)"
LINES: tuple[tuple[str, ...], ...] = (
    ("witness", "--all", "--set", "base,extA,ext"),
    ("witness", "scenario_5(SV,POV,L) and not scenario_1(SV,POV,L)"),
    ("witness", "scenario_1(SV,POV,L) and F scenario_3(SV,POV,L)", "--horizon", "9", "--effort", "400"),
    ("witness", CLOSER, "--road", "main-2", "--effort", "150"),
    ("witness", "4", "--engine", "smt", "--horizon", "9/5"),
    ("witness", "4", "--param", "rho=2.5"),
    ("witness", "1", "--objective", "severe", "--count", "3"),
    ("prove",),
    ("prove", "scenario_4(SV,POV,L) and scenario_6(SV,POV,L) -> scenario_8(SV,POV,L)"),
    ("prove", "dangerArises(SV,POV) -> F aheadOf(SV,POV)", "--engine", "smt", "--horizon", "3"),
    ("check", "proofs"),
    ("compare", "1", "4"),
    ("compare", "4", "4", "--set", "base", "--set", "ext"),
    ("overlap", "--among", "1-8"),
    ("overlap", "--among", "1,4", "--start", "any"),
    ("overlap", "--among", "4,12,20"),
    ("overlap", "--among", "1-8", "--lanes", "any", "--roles", "any"),
    ("order", "--set", "base", "--set", "ext", "--among", "1-8"),
    ("redundancy", "--among", "1,5,6,8"),
    ("redundancy", "--among", "2"),
    ("redundancy", "--among", "7"),
    ("coverage", "--set", "complete", "--needed"),
    ("coverage", "--set", "ext"),
    ("classify", "--among", "1-8"),
    ("explore", "4", "--vary", "rho=0:3"),
    ("explore", "4", "--vary", "minDanger=0:3", "--vary", "rho=0:2"),
    ("explore", "4", "--vary", "POV.a_lon.min=-6:0"),
    ("explore", "3", "--vary", "vehicle.a_lon.max=0:3"),
    ("explore", "1", "6", "--least", "v_lon(SV) - v_lon(POV)", "--greatest", "v_lon(SV) - v_lon(POV)"),
    ("explore", "4", "--greatest", "s(POV) - s(SV)", "--when", "danger(SV,POV)", "--precision", "2"),
)
QUICK = (1, 4, 8, 9, 11, 15, 20, 24)  # places in LINES; a few minutes under every condition
ALONE = ("compare",)  # commands of one process
TIMES = re.compile(r"seconds?$")


def main() -> int:
    parser = argparse.ArgumentParser(description="The same answer every time.")
    parser.add_argument("--only", metavar="PATTERN", default="", help="lines in which this is found")
    parser.add_argument("--quick", action="store_true", help="a few short lines")
    parser.add_argument("--out", type=Path, metavar="FOLDER", default=Path("out/same-answers"))
    parser.add_argument("--load", type=int, metavar="N", default=12, help="processes at once (12; 0: none)")
    options = parser.parse_args()
    numbers = QUICK if options.quick else range(len(LINES))
    chosen = [n for n in numbers if re.search(options.only, " ".join(LINES[n]))]
    options.out.mkdir(parents=True, exist_ok=True)
    for load in (0, options.load):
        runs = [(n, jobs) for n in chosen for jobs in (1, 2) if not kept(options.out, n, load, jobs).exists()]
        with ThreadPoolExecutor(max(load, 1)) as pool, busy(load - len(runs)) as fill:
            started = [pool.submit(run, options.out, number, load, jobs) for number, jobs in runs]
            for done, ended in enumerate(as_completed(started), 1):
                ended.result()
                fill(load - len(runs) + done)
    if not options.load:
        return 0
    same = [report(options.out, number, options.load) for number in chosen]
    print(f"{sum(same)} of {len(same)} command lines answer the same every time")
    return 0 if all(same) else 1


def kept(folder: Path, number: int, load: int, jobs: int) -> Path:
    """Where the answer under one condition is kept."""
    return folder / f"{number + 1:02}-load-{load}-jobs-{jobs}.json"


@contextlib.contextmanager
def busy(count: int) -> Iterator[Callable[[int], None]]:
    """Processes that do nothing, as fast as they can; what is given says how many there should be."""
    processes: list[subprocess.Popen[bytes]] = []

    def fill(wanted: int) -> None:
        while len(processes) < wanted:
            processes.append(subprocess.Popen([sys.executable, "-c", "while True: pass"]))

    try:
        fill(count)
        yield fill
    finally:
        for process in processes:
            process.kill()
            process.wait()


def run(folder: Path, number: int, load: int, jobs: int) -> None:
    """Run one line under one condition, and keep its answer."""
    path = kept(folder, number, load, jobs)
    line = [*LINES[number], "--json", "-"]
    line += [] if line[0] in ALONE else ["--jobs", str(jobs)]
    begun = time.monotonic()
    # Another seed for the order of sets each time, as users have it.
    environment = {**os.environ, "PYTHONHASHSEED": str(1 + 2 * load + jobs)}
    done = subprocess.run(
        [sys.executable, "-m", "roadproof.frontends.cli.main", *line],
        capture_output=True,
        text=True,
        env=environment,
    )
    seconds = time.monotonic() - begun
    said = "" if done.returncode in (0, 10, 20) else done.stderr  # else it only says how far it is
    answer = {"code": done.returncode, "said": said, "answer": parsed(done.stdout), "took": seconds}
    part = path.with_suffix(".part")
    part.write_text(json.dumps(answer), "utf-8")
    part.replace(path)
    print(f"load {load:2}, jobs {jobs}, {seconds:6.1f} s, exit {done.returncode}: {shown(line)}", flush=True)


def parsed(text: str) -> Any:
    """The JSON that a command printed, or its text."""
    try:
        return json.loads(text)
    except ValueError:
        return text


def report(folder: Path, number: int, load: int) -> bool:
    """Say whether one line answers the same under all conditions, and else where the first difference is."""
    conditions = [(idle, jobs) for idle in (0, load) for jobs in (1, 2)]
    answers = [json.loads(kept(folder, number, *x).read_text("utf-8")) for x in conditions]
    first = without_times(answers[0])
    found = [(x, difference(first, without_times(y))) for x, y in zip(conditions, answers, strict=True)]
    different = [(x, where) for x, where in found if where]
    took = " ".join(f"{x['took']:7.1f}" for x in answers)
    ruling = f"{'DIFFERS' if different else 'same':8} exit {answers[0]['code']:3}"
    print(f"{ruling} {took} s  {shown(LINES[number])}")
    for (busy_processes, jobs), where in different:
        print(f"         load {busy_processes}, jobs {jobs}: {where}")
    return not different


def without_times(value: Any) -> Any:
    """``value`` without what says how long something took."""
    match value:
        case dict():
            return {k: without_times(v) for k, v in value.items() if not TIMES.search(k) and k != "took"}
        case list():
            return [without_times(v) for v in value]
        case _:
            return value


def difference(one: Any, other: Any, path: str = "") -> str:
    """The first place in which two answers differ, or empty."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return next((x for k in one if (x := difference(one[k], other[k], f"{path}/{k}"))), "")
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        pairs = enumerate(zip(one, other, strict=True))
        return next((x for k, (a, b) in pairs if (x := difference(a, b, f"{path}/{k}"))), "")
    return "" if one == other else f"{path}: {str(one)[:120]!r} and {str(other)[:120]!r}"


def shown(line: Sequence[str]) -> str:
    """A command line as it would be typed."""
    return " ".join(f"'{x}'" if re.search(r"[ ()]", x) else x for x in line)


if __name__ == "__main__":
    sys.exit(main())
