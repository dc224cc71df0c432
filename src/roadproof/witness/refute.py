"""Drives against claims: a drive on a reference road on which a claim is false."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roadproof.effort import Effort
from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import text
from roadproof.spec.bind import default_values
from roadproof.spec.library import load_library
from roadproof.witness.ask import Request, ask
from roadproof.witness.question import Means


def refuting_drive(
    claim: str, set_name: str, options: Mapping[str, str], specs: tuple[Path, ...], effort: Effort
) -> Mapping[str, Any] | None:
    """The file of a judged drive on which ``claim`` is false at time 0, or None where none was found.

    Looked for on the usual road at declared parameter values. Raises ``InputError`` and
    ``UsageError`` for claims that are not about drives, and ``Late``.
    """
    means = Means("smooth", effort=effort, explain=False)
    values = default_values(load_library(specs))
    outcome = ask(Request(negated(claim), set_name, options, specs, values, means=means))
    return outcome.drives[0] if outcome.drives else None


def negated(claim: str) -> str:
    """The text of the negation of a claim, its ``given`` kept in front. Raises ``TextError``."""
    parsed = parse_claim(claim)
    return text(syntax.Claim(parsed.given, syntax.Prefix("not", parsed.body)))
