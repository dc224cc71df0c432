"""Scenarios in a user's text: by number, by range, or by the name that ISO 34502 gives them.

A name has up to three parts: ``cut-in, lane change, merge zone``. Parts may be left out, so ``cut-in`` names
six scenarios, as ``1,5,9,13,17,21`` does. Case is ignored, and words in brackets may be left out.
"""

import re
from difflib import get_close_matches

from roadproof.errors import InputError, UsageError
from roadproof.library import scenarios
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.specification import Query, Specification
from roadproof.library.words import words_by_number
from roadproof.logic import syntax
from roadproof.runtime.records import dataclass

_RANGE = re.compile(r"\s*(\d{1,4})\s*(?:-\s*(\d{1,4})\s*)?")
_WORDS = re.compile(r"\w[\w -]*(?:\([\w -]*\))?")
_BRACKETS = re.compile(r"\s*\([^()]*\)")


def read_numbers(specification: Specification, text: str) -> tuple[int, ...]:
    """Return the numbers of the scenarios in a text: ``1-8,12``, ``scenario_12``, ``cut-in``, ``cut-in,7``.

    Raises ``UsageError`` for text that names no scenario, ``InputError`` for unknown numbers.
    """
    numbers = set(numbers_by_name(specification, text))
    for piece in () if numbers else text.split(","):
        number = scenarios.number_in(piece.strip())
        read = _RANGE.fullmatch(piece if number is None else str(number))
        if read is not None:
            numbers |= set(range(int(read[1]), int(read[2] or read[1]) + 1))
        elif named := numbers_by_name(specification, piece):
            numbers |= set(named)
        else:
            raise UsageError(f"'{piece[:40]}' is not a range of scenarios; write 1-8 or 1,3-8")
    for number in sorted(numbers):
        refuse_unknown(specification, number)
    return tuple(sorted(numbers))


def refuse_unknown(specification: Specification, number: int) -> None:
    """Raise ``InputError`` if no scenario has this number."""
    known = scenarios.numbers_of(specification)
    if number not in known:
        raise InputError(f"there is no scenario {number}; {_known_numbers(known)}")


def _known_numbers(numbers: tuple[int, ...]) -> str:
    """Return the known numbers for a message, with neighbours as a range."""
    if not numbers:
        return "the specification has no scenarios"
    starts = [n for n in numbers if n - 1 not in numbers]
    ends = [n for n in numbers if n + 1 not in numbers]
    ranges = [str(a) if a == b else f"{a}-{b}" for a, b in zip(starts, ends, strict=True)]
    return f"known scenarios: {', '.join(ranges[:8])}{', …' if len(ranges) > 8 else ''}"


def numbers_by_name(specification: Specification, text: str) -> tuple[int, ...]:
    """Return the scenarios whose names have every part of a text such as ``cut-in, merge zone``; often none.

    An identifier is never read as a name: it may be that of a definition.
    """
    parts = {_normalised(part) for part in text.split(",")}
    if text.strip().isidentifier() or "" in parts or scenarios.are_numbers(text):
        return ()
    names = {number: x.name for number, x in words_by_number(specification).items()}
    return tuple(number for number, name in names.items() if parts <= _parts(name))


def refuse_partial_name(specification: Specification, text: str) -> None:
    """Raise ``UsageError`` for text such as ``cut-in, merge``, of which only a part is in a scenario's name.

    It is also raised if all parts are in names, but no scenario has them all. ``text``: one for which
    ``numbers_by_name`` returns none.
    """
    if text.strip().isidentifier():
        return
    parts = [_normalised(part) for part in text.split(",")]
    names = (x.name for x in words_by_number(specification).values())
    known = dict.fromkeys(part.strip() for name in names for part in name.split(","))
    unknown = [part for part in parts if part not in {y for x in known for y in _parts(x)}]
    if len(unknown) == len(parts) or not all(map(_WORDS.fullmatch, parts)):
        return
    near = get_close_matches(unknown[0], known, 1, 0.5) if unknown else []
    hint = f"; did you mean '{near[0]}'?" if near else ""
    reason = f"'{unknown[0][:40]}' is no part of a name" if unknown else "no scenario has all these parts"
    raise UsageError(f"'{text}' names no scenario: {reason}{hint}\nparts of names: {', '.join(known)}")


def names_scenarios(specification: Specification, text: str) -> bool:
    """Return whether ``read_numbers`` accepts a text, as numbers or as a name of scenarios."""
    return scenarios.are_numbers(text) or bool(numbers_by_name(specification, text))


def number_by_name(specification: Specification, text: str) -> int | None:
    """Return the scenario of that name, else None.

    Raises ``UsageError``, which lists the scenarios, if several have it, and as ``refuse_partial_name`` does.
    """
    numbers = numbers_by_name(specification, text)
    if len(numbers) > 1:
        words = words_by_number(specification, numbers)
        choices = "".join(f"\n  {number}: {x.name}" for number, x in words.items())
        raise UsageError(f"'{text}' names {len(numbers)} scenarios; write one of their numbers:{choices}")
    if not numbers:
        refuse_partial_name(specification, text)
    return numbers[0] if numbers else None


def read_query(specification: Specification, text: str, source: str = "claim") -> tuple[int | None, Query]:
    """Return a scenario by ``4``, ``scenario_4`` or its name, applied to its own arguments, else a formula.

    The number comes first, None for a formula. Raises ``TextError``; ``InputError`` for an unknown number;
    ``UsageError`` for a name that several scenarios have.
    """
    word = text.strip()
    number = int(word) if word.isdecimal() and word.isascii() and len(word) < 7 else scenarios.number_in(word)
    if number is None:
        number = number_by_name(specification, word)
    if number is None:
        return None, read_claim(specification, text, source)
    refuse_unknown(specification, number)
    return number, apply_definition(specification, scenarios.name_of(number))


@dataclass(frozen=True)
class ScenarioApplication:
    """A scenario applied to names of vehicles and a lane."""

    scenario: scenarios.Scenario
    arguments: tuple[str, ...]


def application_in(specification: Specification, expression: syntax.Expression) -> ScenarioApplication | None:
    """Return the scenario that an expression applies to names; None for any other expression."""
    if not isinstance(expression, syntax.Call):
        return None
    name, _, set_name = expression.name.partition("@")
    number = scenarios.number_in(name)
    arguments = tuple(x.name for x in expression.arguments if isinstance(x, syntax.Name))
    if number is None or len(arguments) < len(expression.arguments):
        return None
    return ScenarioApplication(scenarios.Scenario(number, set_name or specification.set_name), arguments)


def vehicles_by_role(
    specification: Specification, claim: syntax.Claim, scenario: scenarios.Scenario
) -> dict[str, str]:
    """Return the vehicle of each role, if a claim is a scenario for L and for vehicles that it declares.

    Empty for every other claim, and if some of the vehicles have names of roles.
    """
    roles, call = scenarios.vehicles_of(specification, scenario), application_in(specification, claim.body)
    if call is None or call.scenario != scenario or call.arguments[len(roles) :] != (scenarios.LANE,):
        return {}
    vehicles = call.arguments[: len(roles)]
    is_own = {x.name for x in claim.given} == {*vehicles} and len({*vehicles} - {*roles}) == len(roles)
    return dict(zip(roles, vehicles, strict=True)) if is_own else {}


def _parts(name: str) -> set[str]:
    """Return the parts of a scenario's name, each with and without words in brackets."""
    return {_normalised(x) for part in name.split(",") for x in (part, _BRACKETS.sub("", part))}


def _normalised(part: str) -> str:
    return " ".join(part.lower().split())
