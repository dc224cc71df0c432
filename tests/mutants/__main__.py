"""``python -m mutants``: make small faults in roadproof and see which test fails (docs/explanation/tests.md).

``record`` which tests run which lines, ``run`` the faults, ``report`` what came out. A run goes on where
it stopped: what was tried is in ``results.jsonl``, and is tried again where the function has changed, or
where it survived and some test has. ``prune`` drops what was tried on another source. ``--only`` takes some
folders of the package, ``--tests`` some test files. ``by-hand`` plants the faults of ``by_hand.toml`` and
``rim/``.
"""

import argparse
import os
import queue
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutants import journal
from mutants.by_hand import listed, plant, read_results, write_results
from mutants.choose import choose
from mutants.edits import Edit
from mutants.journal import Line
from mutants.selection import Records, load_records, record_name
from mutants.trial import Bench, copy_project

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src/roadproof"
OUT = ROOT / "out/mutants"
SEED, NUMBER = 1, 1000


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m mutants", description=__doc__)
    parser.add_argument("action", choices=["record", "run", "prune", "report", "list", "by-hand"])
    parser.add_argument("--number", type=int, default=NUMBER, help="faults to choose (about)")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--only", default="", help="folders or files of the package, such as judge/,kernel/")
    parser.add_argument(
        "--tests", default="", help="folders or files of tests to record, such as tests/extensions/kernel/"
    )
    parser.add_argument("--most", type=int, default=None, help="stop after so many faults")
    parser.add_argument("--jobs", type=int, default=2)
    asked = parser.parse_args()
    records = load_records(OUT / "records", ROOT)
    chosen = choose(PACKAGE, asked.number, asked.seed, asked.only)
    match asked.action:
        case "record":
            record(within(records.missing, asked.tests), asked.jobs)
        case "run":
            if records.missing:
                told = ", ".join(str(path.relative_to(ROOT)) for path in records.missing[:3])
                print(
                    f"{len(records.missing)} test files have no record and are not run: {told}, …", flush=True
                )
            run(chosen, records, asked.jobs, asked.most)
        case "prune":
            journal.write(journal.of_present_source(journal.read().values(), PACKAGE))
        case "by-hand":
            by_hand(asked.only)
        case "list":
            for edit in chosen:
                print(show(edit))
        case _:
            report(chosen)
    return 0


def within(paths: list[Path], named: str) -> list[Path]:
    """Those of ``paths`` in one of the folders or files that ``named`` lists with commas; all without any."""
    return [path for path in paths if str(path.relative_to(ROOT)).startswith(tuple(named.split(",")))]


def record(paths: list[Path], jobs: int) -> None:
    """Run test files that have no record, on the code as it stands."""

    def one(path: Path) -> None:
        environment = {**os.environ, "MUTANTS_RECORD": str(OUT / "records" / record_name(path, ROOT))}
        options = ["-p", "mutants.recording", "-p", "no:xdist", "-q"]
        command = [sys.executable, "-m", "pytest", str(path), *options]
        done = subprocess.run(command, cwd=ROOT, env=environment, stdout=subprocess.PIPE)
        print(path.relative_to(ROOT), done.stdout.decode().strip().rpartition("\n")[2], flush=True)

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, paths))


def run(chosen: list[Edit], records: Records, jobs: int, most: int | None) -> None:
    """Try the faults that have no current result."""
    known, among = journal.read(), journal.tests_digest(ROOT)
    left = [
        edit
        for edit in chosen
        if edit.key not in known or not journal.is_current(known[edit.key], edit, PACKAGE, among)
    ][:most]
    clean = OUT / "clean"
    copy_project(ROOT, clean)
    benches: queue.SimpleQueue[Bench] = queue.SimpleQueue()
    for i in range(jobs):
        benches.put(Bench(ROOT, OUT / f"bench-{i}", clean))

    def one(edit: Edit) -> Line:
        bench = benches.get()
        try:
            tests = records.tests_for(edit, PACKAGE)
            outcome = bench.try_fault(edit, tests, records.seconds)
        finally:
            benches.put(bench)
        line = journal.line_of(edit, outcome, PACKAGE, among)
        journal.append(line)
        print(f"{outcome.verdict:9} {outcome.seconds:6.1f} s {show(edit)} {outcome.by}", flush=True)
        return line

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, left))
    journal.write(journal.of_present_source(journal.read().values(), PACKAGE))


def by_hand(only: str) -> None:
    """Plant the faults that were thought of and not caught yet; count for each room what came out."""
    every, results = listed(), read_results()
    results = {fault.key: results[fault.key] for fault in every if fault.key in results}
    faults = [fault for fault in every if fault.file.startswith(tuple(only.split(",")))]
    left = [fault for fault in faults if results.get(fault.key, "survived") == "survived"]
    for fault, verdict in plant(left, ROOT, OUT / "by-hand"):
        print(f"{verdict:9} {fault.file}: {fault.before} => {fault.after}", flush=True)
        results[fault.key] = verdict
        write_results(results.items())
    rooms: dict[str, Counter[str]] = {}
    for fault in faults:
        rooms.setdefault(fault.room, Counter())[results[fault.key]] += 1
    for room, counted in {**rooms, "all": sum(rooms.values(), Counter())}.items():
        print(f"{room:12} {counted.total():4}  " + ", ".join(f"{n} {v}" for v, n in counted.most_common()))


def report(chosen: list[Edit]) -> None:
    """Counts by folder, and what survived."""
    known, equivalent = journal.read(), journal.equivalents()
    verdicts: dict[str, Counter[str]] = {}
    for edit in chosen:
        verdict = known[edit.key].verdict if edit.key in known else "not tried"
        if edit.key in equivalent:
            verdict = "equivalent"
        verdicts.setdefault(edit.file.split("/")[0], Counter())[verdict] += 1
        if verdict in ("survived", "unreached", "broken"):
            print(f"{verdict:9} {show(edit)}")
    for folder, counted in verdicts.items():
        print(f"{folder:10} {counted.total():4}  " + ", ".join(f"{n} {v}" for v, n in counted.most_common()))
    total = sum(verdicts.values(), Counter())
    print(f"{'all':10} {total.total():4}  " + ", ".join(f"{n} {v}" for v, n in total.most_common()))


def show(edit: Edit) -> str:
    before, after = (" ".join(text.split()) for text in (edit.before, edit.after))
    return f"{edit.key} {edit.file}:{edit.lines[0]} {edit.operator}: {before} => {after or '(nothing)'}"


if __name__ == "__main__":
    raise SystemExit(main())
