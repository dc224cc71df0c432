"""``make evidence`` and ``make evidence-check``: the answers that come with roadproof, in proofs/known.

Without options all are computed and written. With --check they are computed again and compared with those
that are there: verdicts, claims and evidence, all but the seconds. Exit code 0 where they agree.
"""

import argparse
import json
import os
import re
import sys
import time
from pathlib import Path
from typing import Any

from roadproof.analysis.study.frame import known_answer
from roadproof.analysis.study.known import KnownAnswers

from roadproof.frontends.api.questioned import QuestionAnswers
from roadproof.runtime.archives import SWITCH, archived, ship
from shipping.questions import QUESTIONS, Texts, texts_of

FOLDER = Path(__file__).parents[2] / "proofs/known"
CLOCK = "cut off by the clock"


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
        if isinstance(found, QuestionAnswers):
            found = texts_of(found.question, found.found.answers)
        if isinstance(found, Texts):
            wrong += _put(found, args.check, f"{name}:", begun)
            continue
        answers = answers_of(found)
        archive = archive_of(found)
        if args.check:
            there = archive.read(FOLDER)
            different = [x for x, y in answers.items() if _same(there.get(x)) != _same(y)]
            wrong += len(different)
            told = f"{len(different)} of {len(answers)} answers differ {' '.join(sorted(different)[:3])}"
        else:
            path = archive.ship(FOLDER, answers)
            told = f"{len(answers)} answers, {path.name} has {path.stat().st_size} bytes"
        print(f"{name}: {told}, {time.monotonic() - begun:.0f} s", flush=True)
    return 1 if wrong else 0


def _put(found: Texts, check: bool, told: str, begun: float) -> int:
    """Add the answers to a question to those of its kind, or compare them; the number that differ."""
    answers = found.texts
    there = archived(found.kind)
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


def archive_of(found: Any) -> KnownAnswers:
    """Where the answers to a question are."""
    question = found.study.question
    return KnownAnswers.to(question.schema, question.said, question.more)


def answers_of(found: Any) -> dict[str, dict[str, Any]]:
    """The answers by name and key, without those that the clock of this machine cut off."""
    made: dict[str, dict[str, Any]] = {}
    for name in found.study.wanted(found.found.answers):
        key = found.study.key(name)
        if key is not None and name in found.found.answers:
            content = known_answer(found.study, name, found.found.answers[name]).content
            if CLOCK in json.dumps(content):
                print(f"{name}: {CLOCK}, and left out", file=sys.stderr)
            else:
                made[KnownAnswers.entry(name, key)] = content
    return made


def _same(content: Any) -> Any:
    """An answer without what differs from run to run: seconds."""
    match content:
        case dict():
            return {name: _same(value) for name, value in content.items() if name != "seconds"}
        case list() | tuple():
            return [_same(item) for item in content]
        case str() if content.startswith(("{\n", '{"')):  # a file, not a set of times
            return _same(json.loads(content))
        case _:
            return content


if __name__ == "__main__":
    sys.exit(main())
