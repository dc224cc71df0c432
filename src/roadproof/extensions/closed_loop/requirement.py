"""Requirements on a vehicle under test: ``G φ``, where φ is decided soon after each instant."""

import re
from collections.abc import Sequence
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula
from roadproof.logic.rewrite import bounds_of, with_values
from roadproof.runtime.records import dataclass

_ALWAYS = re.compile(r"\s*G\b(?!\s*\[)\s*(?P<body>.+)", re.DOTALL)
_POV = re.compile(r"\bPOV\b")


@dataclass(frozen=True)
class VehicleRequirement:
    """A requirement ``G body``; ``reach``: within how many seconds the body is decided."""

    text: str
    body: str
    reach: Fraction

    def broken(self, vehicles: Sequence[str], horizon: Fraction) -> str:
        """Return the formula that the requirement is broken while the controller drives.

        ``vehicles``: SV first; POV stands for each of the others.
        """
        end = seconds(max(horizon - self.reach, Fraction(0)))
        bodies = (
            [_POV.sub(name, self.body) for name in vehicles[1:]] if _POV.search(self.body) else [self.body]
        )
        return " or ".join(f"F[0 s, {end}] not ({x})" for x in bodies)


def seconds(value: Fraction) -> str:
    """Return a duration in the language, exactly."""
    return f"{value} s" if value.denominator == 1 else f"{value}*1 s"


def read_requirement(home: Specification, values: dict[str, Fraction], text: str) -> VehicleRequirement:
    """Return the requirement of a text about SV and POV. Raises ``UsageError``, ``TextError``."""
    query = read_claim(home, text, "--require")
    match, formula = _ALWAYS.fullmatch(text), query.formula
    if (
        match is None
        or not isinstance(formula, f.Always)
        or bounds_of(formula.interval) != (Fraction(0), None)
    ):
        raise UsageError(
            f"require={text!r}: a drive of some seconds can break G φ only; write one G (...) for each "
            "--require"
        )
    reach = _reach(with_values(formula.body, values))
    if reach is None:
        raise UsageError(
            f"require={text!r}: no drive of some seconds decides what is below G; give F, G and U in it an "
            "end, such as F[0, 3 s]"
        )
    return VehicleRequirement(text.strip(), match["body"].strip(), reach)


def _reach(formula: Formula) -> Fraction | None:
    """Return within how many seconds a formula is decided; None where there is no bound."""
    match formula:
        case f.Truth() | f.Compare() | f.Occupies():
            return Fraction(0)
        case f.Eventually(interval, _) | f.Always(interval, _) | f.Until(_, interval, _):
            _, high = bounds_of(interval)
            inner = [_reach(x) for x in f.children(formula)]
            return None if high is None or None in inner else high + max(x for x in inner if x is not None)
        case Application(_, _, body):
            return _reach(body)
        case _:  # open: all other formulas are decided with their parts
            reaches = [_reach(x) for x in f.children(formula)]
            return (
                None if None in reaches else max((x for x in reaches if x is not None), default=Fraction(0))
            )
