"""Refutations as plain data: a judged trace over points in time, or a judged drive."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any


def trace_data(
    instants: Sequence[tuple[Fraction, Mapping[str, Fraction], Mapping[str, bool]]],
    parameters: Mapping[str, Fraction],
    held: str,
) -> dict[str, Any]:
    """A countermodel: what holds at each instant; ``held`` tells which state lies between instants."""
    return {
        "kind": "trace",
        "between": f"the state of the instant {held}",
        "parameters": {name: str(value) for name, value in sorted(parameters.items())},
        "instants": [
            {
                "time": str(time),
                "true": sorted(name for name, true in atoms.items() if true),
                "values": {name: str(value) for name, value in sorted(values.items())},
            }
            for time, values, atoms in instants
        ],
    }


def drive_data(drive_file: Mapping[str, Any]) -> dict[str, Any]:
    """A drive on which the claim is false."""
    return {"kind": "drive", "drive": dict(drive_file)}
