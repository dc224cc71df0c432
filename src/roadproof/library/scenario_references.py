"""Scenarios in text that a user writes: by number, by range, or by the name that ISO 34502 gives them.

A name has up to three parts: ``cut-in, lane change, merge zone``. Parts may be left out, so ``cut-in`` names
six scenarios, as ``1,5,9,13,17,21`` does. Upper and lower case are the same, and words in brackets may be
left out.
"""

import re
from difflib import get_close_matches

from roadproof.errors import InputError, UsageError
from roadproof.library import scenarios as s
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.specification import Query, Specification
from roadproof.library.words import called
from roadproof.logic import syntax
from roadproof.runtime.records import dataclass

_RANGE = re.compile(r"\s*(\d{1,4})\s*(?:-\s*(\d{1,4})\s*)?")
_WORDS = re.compile(r"\w[\w -]*(?:\([\w -]*\))?")
_BRACKETS = re.compile(r"\s*\([^()]*\)")


def read_numbers(specification: Specification, text: str) -> tuple[int, ...]:
    """The numbers of scenarios that a text names: ``1-8,12``, ``scenario_12``, ``cut-in``, ``cut-in,7``.

    Raises ``UsageError`` for text that names no scenario, ``InputError`` for unknown numbers.
    """
    numbers = set(numbers_called(specification, text))
    for piece in () if numbers else text.split(","):
        number = s.number_in(piece.strip())
        read = _RANGE.fullmatch(piece if number is None else str(number))
        if read is not None:
            numbers |= set(range(int(read[1]), int(read[2] or read[1]) + 1))
        elif found := numbers_called(specification, piece):
            numbers |= set(found)
        else:
            raise UsageError(f"'{piece[:40]}' is not a range of scenarios; write 1-8 or 1,3-8")
    for number in sorted(numbers):
        refuse_unknown(specification, number)
    return tuple(sorted(numbers))


def refuse_unknown(specification: Specification, number: int) -> None:
    """Raises ``InputError`` for the number of no scenario."""
    known = s.numbers_of(specification)
    if number not in known:
        raise InputError(f"there is no scenario {number}; {_listed(known)}")


def _listed(numbers: tuple[int, ...]) -> str:
    """The numbers of scenarios in a message, neighbours as a range."""
    if not numbers:
        return "the specification has no scenarios"
    starts = [n for n in numbers if n - 1 not in numbers]
    ends = [n for n in numbers if n + 1 not in numbers]
    ranges = [str(a) if a == b else f"{a}-{b}" for a, b in zip(starts, ends, strict=True)]
    return f"known scenarios: {', '.join(ranges[:8])}{', …' if len(ranges) > 8 else ''}"


def numbers_called(specification: Specification, text: str) -> tuple[int, ...]:
    """The scenarios whose names have every part of a text such as ``cut-in, merge zone``; often none.

    An identifier is never a name: it may be that of a definition.
    """
    asked = {_plain(part) for part in text.split(",")}
    if text.strip().isidentifier() or "" in asked or s.are_numbers(text):
        return ()
    names = {number: x.name for number, x in called(specification).items()}
    return tuple(number for number, name in names.items() if asked <= _parts(name))


def refuse_half_name(specification: Specification, text: str) -> None:
    """Raises ``UsageError`` for text like ``cut-in, merge``: only one part is of a scenario's name.

    Also where each part is of a name, but no scenario has them all. ``text``: one for which
    ``numbers_called`` finds no scenario.
    """
    if text.strip().isidentifier():
        return
    asked = [_plain(part) for part in text.split(",")]
    known = {part: None for x in called(specification).values() for part in map(str.strip, x.name.split(","))}
    strange = [part for part in asked if part not in {y for x in known for y in _parts(x)}]
    if len(strange) == len(asked) or not all(map(_WORDS.fullmatch, asked)):
        return
    near = get_close_matches(strange[0], known, 1, 0.5) if strange else []
    hint = f"; did you mean '{near[0]}'?" if near else ""
    reason = f"'{strange[0][:40]}' is no part of a name" if strange else "no scenario has all these parts"
    raise UsageError(f"'{text}' names no scenario: {reason}{hint}\nparts of names: {', '.join(known)}")


def names_scenarios(specification: Specification, text: str) -> bool:
    """Whether ``read_numbers`` reads a text: as numbers, or as a name that scenarios have."""
    return s.are_numbers(text) or bool(numbers_called(specification, text))


def one_called(specification: Specification, text: str) -> int | None:
    """The scenario of that name; None where no scenario has it.

    Raises ``UsageError``, which lists the scenarios, where several have it, and as ``refuse_half_name`` does.
    """
    numbers = numbers_called(specification, text)
    if len(numbers) > 1:
        words = called(specification, numbers)
        choices = "".join(f"\n  {number}: {x.name}" for number, x in words.items())
        raise UsageError(f"'{text}' names {len(numbers)} scenarios; write one of their numbers:{choices}")
    if not numbers:
        refuse_half_name(specification, text)
    return numbers[0] if numbers else None


def read_query(specification: Specification, text: str, source: str = "claim") -> tuple[int | None, Query]:
    """A scenario by ``4``, ``scenario_4`` or its name, applied to its own arguments, or else a formula.

    The number comes first, None for a formula. Raises ``TextError``; ``InputError`` for an unknown number;
    ``UsageError`` for a name that several scenarios have.
    """
    word = text.strip()
    number = int(word) if word.isdecimal() and word.isascii() and len(word) < 7 else s.number_in(word)
    if number is None:
        number = one_called(specification, word)
    if number is None:
        return None, read_claim(specification, text, source)
    refuse_unknown(specification, number)
    return number, apply_definition(specification, s.name_of(number))


@dataclass(frozen=True)
class Application:
    """A scenario applied to the names of vehicles and a lane."""

    scenario: s.Scenario
    arguments: tuple[str, ...]


def application_in(specification: Specification, said: syntax.Expression) -> Application | None:
    """The scenario that an expression applies to names; None where it is anything else."""
    if not isinstance(said, syntax.Call):
        return None
    name, _, set_name = said.name.partition("@")
    number = s.number_in(name)
    arguments = tuple(x.name for x in said.arguments if isinstance(x, syntax.Name))
    if number is None or len(arguments) < len(said.arguments):
        return None
    return Application(s.Scenario(number, set_name or specification.set_name), arguments)


def own_names(specification: Specification, claim: syntax.Claim, scenario: s.Scenario) -> dict[str, str]:
    """The vehicle of each role, where a claim is a scenario for L and for vehicles that it declares.

    Empty for every other claim, and where some of the vehicles are called as roles.
    """
    found, known = application_in(specification, claim.body), s.vehicles_of(specification, scenario)
    if found is None or found.scenario != scenario or found.arguments[len(known) :] != (s.LANE,):
        return {}
    vehicles = found.arguments[: len(known)]
    is_own = {x.name for x in claim.given} == {*vehicles} and len({*vehicles} - {*known}) == len(known)
    return dict(zip(known, vehicles, strict=True)) if is_own else {}


def claimed(specification: Specification, said: int | str, where: str) -> str:
    """The definition that a test is said to show: a scenario by number or name, or a name as it is.

    Raises ``InputError`` for an unknown scenario, for several, and for text that is no name.
    """
    text = str(said).strip()
    numbers = numbers_called(specification, text)
    if numbers or s.are_numbers(text):
        numbers = numbers or read_numbers(specification, text)
        if len(numbers) != 1:
            raise InputError(f"{where}: '{text}' names {len(numbers)} scenarios; name each by itself")
        return s.name_of(numbers[0])
    if not text.isidentifier():
        raise InputError(f"{where}: '{text[:40]}' is no number of a scenario and no name")
    return text


def _parts(name: str) -> set[str]:
    """The parts of a scenario's name, each as it is and without words in brackets."""
    return {_plain(x) for part in name.split(",") for x in (part, _BRACKETS.sub("", part))}


def _plain(part: str) -> str:
    return " ".join(part.lower().split())
