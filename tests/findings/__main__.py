"""``make findings``: every figure, session and picture of the documents, made again and compared.

Each command is run once; what it did is kept under out/findings, so a run that was broken off goes on
where it was. Exit code 0 where text and output agree, 1 where they differ or could not be compared.
"""

import argparse
import re
import signal
import sys
import time
from pathlib import Path

from findings.checking import Item, Sessions, Wrong, check_picture, check_sessions, check_statement
from findings.figures import Picture, Statement
from findings.results import ROOT, Results
from findings.statements import PICTURES, SESSIONS, STATEMENTS


def main() -> int:
    parser = argparse.ArgumentParser(prog="make findings", description=__doc__.partition("\n")[0])
    parser.add_argument("--only", metavar="PATTERN", default="", help="commands or pages that match this")
    parser.add_argument("--sample", action="store_true", help="the quick ones, as the tests do")
    parser.add_argument("--kept", action="store_true", help="run nothing: compare with what was kept")
    parser.add_argument("--update", action="store_true", help="write what came out into pages and pictures")
    parser.add_argument("--out", type=Path, default=ROOT / "out/findings", help="where results are kept")
    args = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # what runs is ended with this
    results = Results(args.out)
    items: list[Item] = [
        item
        for item in (*SESSIONS, *STATEMENTS, *PICTURES)
        if re.search(args.only, name_of(item)) and (not args.sample or is_quick(item))
    ]
    wrong, missing = 0, 0
    for number, item in enumerate(items, start=1):
        print(f"[{number}/{len(items)}] {name_of(item)}", file=sys.stderr, flush=True)
        if results.lacks_data(item.commands) or (args.kept and not is_kept(item, results)):
            print(f"not compared: {name_of(item)}")
            missing += 1
            continue
        begun = time.monotonic()
        found = check(item, results, args.update)
        print("\n".join(map(str, found)), end="\n" if found else "", flush=True)
        print(f"    {len(found)} differ, {time.monotonic() - begun:.0f} s", file=sys.stderr, flush=True)
        wrong += len(found)
    done = ", put right where a figure was found" if args.update and wrong else ""
    print(f"{len(items) - missing} compared, {wrong} differences{done}, {missing} not compared")
    return 1 if wrong or missing else 0


def check(item: Item, results: Results, update: bool) -> list[Wrong]:
    match item:
        case Sessions():
            return check_sessions(item, results, update)
        case Statement():
            return check_statement(item, results, update)
        case Picture():
            return check_picture(item, results, update)


def name_of(item: Item) -> str:
    match item:
        case Sessions():
            return f"{item.page}: its sessions"
        case Statement():
            return f"{item.page}: {'; '.join(item.commands)}"
        case Picture():
            return f"{item.file}: {'; '.join(item.commands)}"


def is_kept(item: Item, results: Results) -> bool:
    return results.has_session(item.commands) if isinstance(item, Sessions) else results.has(item.commands)


def is_quick(item: Item) -> bool:
    return isinstance(item, Statement) and item.quick


if __name__ == "__main__":
    sys.exit(main())
