"""The index and the journal of ``roadproof overlap``: which pairs of scenarios hold together."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import combinations, permutations
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import Common, Entry, file_of, shows_of
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.codec import UNCHECKED, Doc, Rule
from roadproof.evidence.json_schema import Shared
from roadproof.library.compose import both, eventually
from roadproof.library.scenarios import LANE, Scenario, applied, vehicles_of
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

SCHEMA: Final = "roadproof/overlap/1"
Choice: TypeAlias = Annotated[
    Literal["same", "any"], Doc("Whether both have the same, or each its own."), Shared("choice")
]


@dataclass(frozen=True, kw_only=True)
class Clash:
    """Parts of a conjunction that contradict each other."""

    formula: shared.Formula
    parts: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Whether two scenarios can hold together."""

    a: shared.Number
    b: shared.Number
    set_a: shared.SetName
    set_b: shared.SetName
    verdict: DriveVerdict
    formula: Annotated[
        str,
        Doc(
            "Of a WITNESSED what holds on the drive; of an IMPOSSIBLE what is proved; empty where nothing is "
            "known."
        ),
    ]
    core: Annotated[tuple[str, ...], UNCHECKED, Doc("Parts that clash, of all cores.")]
    cores: Annotated[
        tuple[Clash, ...], UNCHECKED, Doc("For each way in which the two can meet, parts that clash.")
    ]
    certificate: shared.KeptCertificate
    drive: shared.KeptDrive
    reason: shared.Reason = NO_REASON
    seconds: shared.Seconds = 0.0

    @property
    def scenarios(self) -> tuple[Scenario, Scenario]:
        """The two, in their sets."""
        return Scenario(self.a, self.set_a), Scenario(self.b, self.set_b)

    def expected(self, common: Common, said: "Preamble") -> list[Formula]:
        """What a drive of both satisfies; or the claims that say that no such conjunction ever holds."""
        one, other = self.scenarios
        orders = [_conjunctions(common, a, b, said) for a, b in ((one, other), (other, one))]
        if self.verdict is Verdict.WITNESSED:
            return [query.formula for queries in orders for query in queries]
        return [f.conjunction(*(f.negation(query.formula) for query in queries)) for queries in orders]


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all pairs."""

    set: Annotated[str, Rule(least=1), Doc("The spec set, or two with a comma between.")]
    lanes: Annotated[Choice, Doc("Whether both speak of one lane, or each of its own.")]
    roles: Annotated[Choice, Doc("Whether vehicles play the same parts in both.")]
    start: Annotated[Choice, Doc("Whether both start at 0, or one then or later.")]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """Which pairs of scenarios can hold together."""

    schema: Literal["roadproof/overlap/1"] = SCHEMA
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[Pair, ...]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer."""

    verdict: Pair


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    said = background.once(Preamble)
    for number, pair in enumerate(answer.verdicts if isinstance(answer, Index) else [answer.verdict], 1):
        yield _entry(pair, f"{background.where}, pair {number}", background.home, said)


def _entry(pair: Pair, where: str, common: Common, said: Preamble) -> Entry:
    one, other = pair.scenarios
    shows = shows_of(pair.verdict, where, "proof", "drive")
    fault = ""
    if shows != "nothing" and common.formula(pair.formula) not in pair.expected(common, said):
        fault = f"{where} is about scenarios {one} and {other}, but its formula is not: {pair.formula[:120]}"
    unchecked = ("that the core alone clashes",) if pair.core else ()
    return Entry(
        common,
        where,
        ("pair", *sorted((str(one), str(other)))),
        pair.verdict,
        f"scenarios {one} and {other}",
        shows,
        pair.formula,
        file_of(where, shows, pair.certificate, pair.drive),
        unchecked=(*unchecked_of(pair.verdict), *unchecked),
        fault=fault,
        expected=partial(pair.expected, common, said),
    )


def _conjunctions(common: Common, one: Scenario, other: Scenario, said: Preamble) -> list[Query]:
    """The formulas of which one has to hold for two scenarios to hold together."""
    home = common.specification
    mine, theirs = vehicles_of(home, one), vehicles_of(home, other)
    swapped = len(theirs) > len(mine)
    most, fewer = (theirs, mine) if swapped else (mine, theirs)
    found: list[Query] = []
    for roles in _assignments(most, len(fewer), said.roles):
        first = applied(home, one, roles if swapped else most)
        second = applied(home, other, most if swapped else roles, f"{LANE}2" if said.lanes == "any" else LANE)
        if said.start == "same":
            found.append(both(first, second))
        else:
            found += [both(first, eventually(second)), both(second, eventually(first))]
    return found


def _assignments(vehicles: Sequence[str], count: int, roles: str) -> list[tuple[str, ...]]:
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]


READER = Reader.of(Index, Preamble, Record, _entries)
