"""The index and the journal of ``roadproof overlap``: which pairs of scenarios hold together."""

from collections.abc import Iterator, Sequence
from itertools import combinations, permutations

from roadproof.errors import InputError
from roadproof.evidence.answers.entry import Common, Entry, one_of, shows_of
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.spec.compose import both, eventually
from roadproof.spec.query import Query
from roadproof.spec.scenarios import LANE, Scenario, applied, vehicles_of

SCHEMA = "roadproof/overlap/1"
_ENTRY = ("a", "b", "set_a", "set_b", "verdict", "formula", "core", "cores", "certificate", "drive")
_ENTRY_MORE = ("reason", "seconds")
_UNCHECKED = ("core", "cores", "reason", "seconds")


def read_index(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index. Raises ``InputError``."""
    return _entries(background, data.items("verdicts"))


def read_record(record: Fields, background: Background) -> Iterator[Entry]:
    """The entry of a kept answer. Raises ``InputError``."""
    return _entries(background, [record.get("verdict")])


def _entries(background: Background, records: Sequence[object]) -> Iterator[Entry]:
    common = background.home
    choices = {name: background.said.text(name) for name in ("lanes", "roles", "start")}
    for name, choice in choices.items():
        if choice not in ("same", "any"):
            raise InputError(f"{common.where}: {name}='{choice[:40]}' must be same or any")
    for number, content in enumerate(records, 1):
        line = Fields(content, f"{common.where}, pair {number}", (*_ENTRY, *_ENTRY_MORE))
        yield _entry(line, common, choices)


def _entry(line: Fields, common: Common, choices: dict[str, str]) -> Entry:
    one = Scenario(line.whole("a"), line.text("set_a"))
    other = Scenario(line.whole("b"), line.text("set_b"))
    claim, verdict = line.text("formula"), line.text("verdict")
    shows = shows_of(verdict, line.where, "proof", "drive")
    fault = ""
    if shows != "nothing" and common.formula(claim) not in _expected(
        common, one, other, choices, shows == "drive"
    ):
        fault = f"{line.where} is about scenarios {one} and {other}, but its formula is not: {claim[:120]}"
    unchecked = ("that the core alone clashes",) if line.items("core") else ()
    return Entry(
        common,
        line.where,
        ("pair", *sorted((str(one), str(other)))),
        verdict,
        f"scenarios {one} and {other}",
        shows,
        claim,
        one_of(line, shows),
        unchecked=(*unchecked_of(verdict), *unchecked),
        fault=fault,
    )


def _expected(
    common: Common, one: Scenario, other: Scenario, choices: dict[str, str], together: bool
) -> list[Formula]:
    """What a drive of both satisfies; or the claims that say that no such conjunction ever holds."""
    orders = [_conjunctions(common, a, b, choices) for a, b in ((one, other), (other, one))]
    if together:
        return [query.formula for queries in orders for query in queries]
    return [f.conjunction(*(f.negation(query.formula) for query in queries)) for queries in orders]


def _conjunctions(common: Common, one: Scenario, other: Scenario, choices: dict[str, str]) -> list[Query]:
    """The formulas of which one has to hold for two scenarios to hold together."""
    home = common.specification
    mine, theirs = vehicles_of(home, one), vehicles_of(home, other)
    swapped = len(theirs) > len(mine)
    most, fewer = (theirs, mine) if swapped else (mine, theirs)
    found: list[Query] = []
    for roles in _assignments(most, len(fewer), choices["roles"]):
        first = applied(home, one, roles if swapped else most)
        second = applied(
            home, other, most if swapped else roles, f"{LANE}2" if choices["lanes"] == "any" else LANE
        )
        if choices["start"] == "same":
            found.append(both(first, second))
        else:
            found += [both(first, eventually(second)), both(second, eventually(first))]
    return found


def _assignments(vehicles: Sequence[str], count: int, roles: str) -> list[tuple[str, ...]]:
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]


READER = Reader(
    SCHEMA,
    ("set", "lanes", "roles", "start", "options", "parameters", "specs"),
    ("view", "seconds", "verdicts"),
    read_index,
    ("verdict",),
    read_record,
    unchecked=("seconds", *(f"verdicts[].{x}" for x in _UNCHECKED)),
    unchecked_kept=tuple(f"verdict.{x}" for x in _UNCHECKED),
)
