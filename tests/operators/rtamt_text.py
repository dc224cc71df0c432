"""Formulas in the language of rtamt, and its verdicts, from an interpreter that has it."""

import json
import os
import subprocess
from collections.abc import Sequence
from fractions import Fraction
from typing import assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of

PYTHON = os.environ.get("ROADPROOF_RTAMT_PYTHON", "")
"""An interpreter with the package rtamt (0.4.10 was tried)."""
_PROGRAM = """
import json, logging, sys, warnings
warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)
import rtamt
for line in sys.stdin:
    text, data = json.loads(line)
    specification = rtamt.StlDiscreteTimeSpecification()
    for name in (*data, "out"):
        specification.declare_var(name, "float")
    specification.spec = "out = " + text
    specification.parse()
    found = specification.evaluate({"time": list(range(len(data["P"]))), **data})
    print(json.dumps([value > 0 for _, value in found]), flush=True)
"""


class NoTextError(Exception):
    """The error of a formula that rtamt reads otherwise: until and since that do not begin now."""


def rtamt_text(formula: Formula) -> str:
    """Return a formula for rtamt. Raises ``NoTextError``."""
    match formula:
        case f.Compare(left, _, _):
            return f"({left.vehicle} > 0)"  # type: ignore[attr-defined]
        case f.Not(body):
            return f"(not {rtamt_text(body)})"
        case f.And(parts):
            return "(" + " and ".join(map(rtamt_text, parts)) + ")"
        case f.Or(parts):
            return "(" + " or ".join(map(rtamt_text, parts)) + ")"
        case f.Eventually(interval, body):
            return _timed("eventually", interval, rtamt_text(body))
        case f.Always(interval, body):
            return _timed("always", interval, rtamt_text(body))
        case f.Since(f.Truth(True), interval, body):
            return _timed("once", interval, rtamt_text(body))
        case f.Until(left, interval, right) | f.Since(left, interval, right):
            low, high = bounds_of(interval)
            if low != 0:
                raise NoTextError
            word = "until" if isinstance(formula, f.Until) else "since"
            bounds = "" if high is None else f"[0,{high}]"
            return f"({rtamt_text(left)} {word}{bounds} {rtamt_text(right)})"
        case f.Truth() | f.Occupies() | f.Some() | f.Every() | f.Application():
            raise NoTextError
        case _:
            assert_never(formula)


def _timed(word: str, interval: f.Interval, body: str) -> str:
    low, high = bounds_of(interval)
    if high is not None:
        return f"{word}[{low},{high}] {body}"
    endless = f"({word} {body})"
    return endless if low == Fraction(0) else f"({word}[{low},{low}] {endless})"


def verdicts(cases: Sequence[tuple[str, dict[str, list[float]]]]) -> list[list[bool]]:
    """Return the verdicts of rtamt at each sample of each case."""
    lines = "".join(json.dumps(x) + "\n" for x in cases)
    done = subprocess.run([PYTHON, "-c", _PROGRAM], input=lines, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]
