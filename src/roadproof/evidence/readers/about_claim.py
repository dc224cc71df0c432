"""Requires that a file is about the claim that it is named after."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.errors import InputError
from roadproof.evidence.answer import assumed_by, value_mismatch

if TYPE_CHECKING:
    from roadproof.evidence.answer_files import AboutClaim
    from roadproof.evidence.claim import Claim


def require_about(claim: Claim, file: AboutClaim, where: str) -> None:
    """Raise ``InputError`` unless a file has the set, options, assumptions and formula of a claim."""
    require_options(claim, file.set, file.options, where)
    require(file.assuming == assumed_by(claim), where, f"it assumes {', '.join(file.assuming) or 'nothing'}")
    require(
        claim.read(file.claim) == claim.formula,
        where,
        f"it is about {shortened(file.claim)}",
    )


def require_options(claim: Claim, set_name: str, options: Mapping[str, str], where: str) -> None:
    """Raise ``InputError`` unless a file was read with the set and options of a claim."""
    home = claim.home
    require(set_name == home.set_name, where, f"it is about set {set_name}")
    require(home.library.select(set_name, options) is home, where, "it was read with other options")


def require_values(claim: Claim, values: Mapping[str, Fraction], where: str) -> None:
    """Raise ``InputError`` unless a file has the parameter values of a claim."""
    other = value_mismatch(claim, values)
    require(not other, where, other)


def require(holds: bool, where: str, otherwise: str) -> None:
    """Raise ``InputError`` with ``otherwise`` unless the file is about the claim that it is named after."""
    if not holds:
        raise InputError(f"{where} is no answer to its claim: {otherwise}")


def shortened(text: str) -> str:
    """Return the beginning of a text in one line."""
    return " ".join(text.split())[:120]
