"""``make evidence`` and ``make evidence-check``: the answers that come with roadproof, in proofs/known.

Without options all are computed and written. With --check they are computed again and compared with those
that are there, byte for byte. Exit code 0 where they agree.
"""

import argparse
import os
import re
import sys
import time
from pathlib import Path

from roadproof.runtime.archives import SWITCH, shipped_answers
from shipping.archive import ship
from shipping.questions import QUESTIONS, Texts, texts_of

FOLDER = Path(__file__).parents[2] / "proofs/known"


def main() -> int:
    parser = argparse.ArgumentParser(prog="make evidence", description=__doc__.partition("\n")[0])
    parser.add_argument("--only", metavar="PATTERN", default="", help="questions that match this")
    parser.add_argument("--check", action="store_true", help="compute again and compare, write nothing")
    parser.add_argument("--jobs", type=int, default=None, help="processes")
    args = parser.parse_args()
    os.environ[SWITCH] = "off"
    wrong = 0
    for name, ask in QUESTIONS.items():
        if not re.search(args.only, name):
            continue
        begun = time.monotonic()
        found = ask(jobs=args.jobs)
        if not isinstance(found, Texts):
            found = texts_of(found.question, found.found.answers)
        wrong += _put(found, args.check, f"{name}:", begun)
    return 1 if wrong else 0


def _put(found: Texts, check: bool, told: str, begun: float) -> int:
    """Add the answers to a question to those of its kind, or compare them; the number that differ."""
    answers = found.texts
    there = shipped_answers(found.kind)
    wrong = [key for key, text in answers.items() if there.get(key) != text] if check else []
    if check:
        print(
            f"{told} {len(wrong)} of {len(answers)} answers differ, {time.monotonic() - begun:.0f} s",
            flush=True,
        )
    else:
        path = ship(FOLDER, found.kind, {**there, **answers})
        size = path.stat().st_size
        print(
            f"{told} {len(answers)} answers, {path.name} has {size} bytes, {time.monotonic() - begun:.0f} s",
            flush=True,
        )
    return len(wrong)


if __name__ == "__main__":
    sys.exit(main())
