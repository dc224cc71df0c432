"""What a page asks, as values: every field is read strictly, since anything may be sent."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from roadproof.errors import UsageError
from roadproof.evidence.strict import Fields
from roadproof.frontends.api.drafting import BEFORE, EDIT, Draft

LONGEST_TEXT = 200_000
LATEST = 3600


def draft_of(ask: Mapping[str, Any]) -> Draft:
    """The definitions that a job is about: ``draft`` with base, text, before, options, params."""
    data = Fields(ask.get("draft", {}), "draft", ("base", "text", "before", "options", "params"))
    before = None if data.content.get("before") is None else _text(data.text("before"), "before")
    return Draft(
        data.text("base"),
        _text(data.text("text"), "text"),
        before,
        data.named_texts("options"),
        data.named_texts("params"),
    )


def text_of(ask: Mapping[str, Any], name: str) -> str:
    """A text. Raises ``UsageError``, ``InputError``."""
    return _text(Fields(ask, "question").text(name), name)


def set_of(ask: Mapping[str, Any], name: str = "set") -> str:
    """The spec set that is asked about: edit, before, or the one below them."""
    found = text_of(ask, name)
    return found if found in (EDIT, BEFORE) else draft_of(ask).base


def count_of(ask: Mapping[str, Any], name: str, most: int) -> int:
    """A whole number from 1 to ``most``."""
    value = ask.get(name, 1)
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= most:
        raise UsageError(f"{name}={str(value)[:40]}: ask for 1 to {most}")
    return value


def explain_of(ask: Mapping[str, Any]) -> tuple[int, Fraction] | None:
    """A part by its place and an instant in seconds, where something is to be explained."""
    if ask.get("explain") is None:
        return None
    data = Fields(ask["explain"], "explain", ("part", "at"))
    at = data.get("at")
    if not isinstance(at, int | float) or isinstance(at, bool) or not 0 <= at <= LATEST:
        raise UsageError(f"at={str(at)[:40]}: explain an instant from 0 to {LATEST} s")
    return data.whole("part"), Fraction(at).limit_denominator(10**6)


def _text(value: str, name: str) -> str:
    if len(value) > LONGEST_TEXT:
        raise UsageError(f"{name} has {len(value)} characters: at most {LONGEST_TEXT} are read")
    return value
