"""Filters of the templates: how verdicts, numbers, findings and long values are written."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from roadproof.evidence.finding import NO_EVIDENCE, Finding
from roadproof.frontends.report.explore import show


class Sign(NamedTuple):
    """How a verdict is drawn: a sign that needs no colour, and the class of its colour."""

    text: str
    colour: str


_UNKNOWN = Sign("?", "doubt")
SIGNS: Mapping[str, Sign] = {
    "WITNESSED": Sign("■", "drive"),
    "IMPOSSIBLE": Sign("·", "none"),
    "PROVED": Sign("✓", "proof"),
    "VACUOUS": Sign("∅", "doubt"),
    "REFUTED": Sign("✗", "against"),
    "PROVED-BOUNDED": Sign("✓", "doubt"),
    "NONE-WITHIN": Sign("○", "doubt"),
    "COVERED": Sign("✓", "proof"),
    "GAPS": Sign("■", "drive"),
    "UNKNOWN": _UNKNOWN,
}


def sign(verdict: object) -> Sign:
    """The sign of a verdict."""
    return SIGNS.get(str(verdict), _UNKNOWN)


def counted(verdicts: Iterable[object]) -> list[tuple[str, int]]:
    """How often each verdict occurs."""
    return [*Counter(map(str, verdicts)).items()]


def in_unit(value: str, unit: str = "") -> str:
    """A rational as a decimal, with its unit."""
    return f"{show(Fraction(value))} {unit if unit != 'unitless' else ''}".rstrip()


def notes(finding: Finding) -> str:
    """What was checked of evidence, and what was not."""
    if finding.kind == NO_EVIDENCE:
        return "there is no evidence for it"
    unchecked = f"not checked: {', '.join(finding.unchecked)}" if finding.unchecked else ""
    return "; ".join([*finding.checked, *([unchecked] if unchecked else [])])


def short(value: object, most: int = 400) -> str:
    """A value in a line."""
    if isinstance(value, Mapping):
        told = ", ".join(f"{k}={short(x, 80)}" for k, x in value.items())
    elif isinstance(value, Sequence) and not isinstance(value, str):
        told = ", ".join(short(x, 80) for x in value)
    else:
        told = "" if value is None else str(value)
    return told if len(told) <= most else told[: most - 1] + "…"
