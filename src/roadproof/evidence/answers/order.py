"""The index and the journal of ``roadproof order``: which scenarios imply which."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import permutations
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.errors import InputError, TextError
from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import Common, Conjunctions, Entry, file_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.codec import Doc, Key, Rule
from roadproof.library.compose import implication
from roadproof.library.scenario_references import Application, application_in
from roadproof.library.scenarios import LANE, SUBJECT, Scenario, applied, vehicles_of
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import without_names
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/order/1"
_NODE = re.compile(r"([0-9]{1,6})@(\w+)", re.ASCII)
Position: TypeAlias = Annotated[int, Rule(minimum=1)]


@dataclass(frozen=True, kw_only=True)
class Implication:
    """That one scenario implies another."""

    above: Annotated[shared.ScenarioName, Key("from")]
    below: Annotated[shared.ScenarioName, Key("to")]

    @property
    def pair(self) -> tuple[str, str]:
        """The two names."""
        return self.above, self.below


@dataclass(frozen=True, kw_only=True)
class Edge(Implication):
    """A proof that one scenario implies another."""

    claim: shared.Formula
    certificate: shared.KeptCertificate = None

    def expected(self, common: Common) -> list[Formula]:
        """That the one implies the other, for all ways in which they share vehicles."""
        home = common.specification
        one, other = _node(self.above), _node(self.below)
        return [
            implication(applied(home, one, mine), applied(home, other, theirs)).formula
            for mine, theirs in _readings(common, one, other)
        ]


@dataclass(frozen=True, kw_only=True)
class Refutation:
    """A drive on which one scenario holds and others do not."""

    holds: shared.ScenarioName
    fails: Annotated[
        tuple[shared.ScenarioName, ...], Rule(least=1), Doc("The scenarios that are false on the drive.")
    ]
    drive: shared.KeptDrive = None

    def expected(self, common: Common) -> list[Conjunctions]:
        """That the one holds and no other does, for each choice of the vehicles that they share."""
        holds = _node(self.holds)
        ways = [(node, _readings(common, holds, node)) for node in map(_node, self.fails)]
        return [
            Conjunctions(((_formula(common, holds, mine),), *(_failures(common, mine, *x) for x in ways)))
            for mine in dict.fromkeys(above for _, pairs in ways for above, _ in pairs)
        ]


@dataclass(frozen=True, kw_only=True)
class OrderedEntry:
    """What has a place among all of its kind."""

    number: Position


@dataclass(frozen=True, kw_only=True)
class ListedRefutation(Refutation, OrderedEntry):
    """A drive on which one scenario holds and others do not, by number."""


@dataclass(frozen=True, kw_only=True)
class MissingImplication(Implication):
    """A pair of which the first scenario does not imply the second."""

    drives: Annotated[tuple[Position, ...], Rule(least=1), Doc("The numbers of drives that show so.")]


@dataclass(frozen=True, kw_only=True)
class Doubt(Implication):
    """An implication that is neither proved nor refuted."""

    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all implications."""

    sets: shared.SetNames
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """Which scenarios imply which."""

    schema: Literal["roadproof/order/1"] = SCHEMA
    view: shared.Dense = "dense"
    kinds: Annotated[
        tuple[Annotated[tuple[shared.ScenarioName, ...], Rule(least=1)], ...],
        Doc("Scenarios that are one formula; the first stands for all."),
    ]
    proved: tuple[Edge, ...]
    edges: Annotated[tuple[Edge, ...], Doc("Those proved that do not follow from others.")]
    missing: tuple[MissingImplication, ...]
    drives: tuple[ListedRefutation, ...]
    doubts: tuple[Doubt, ...]
    seconds: shared.Seconds = 0.0


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer: what was found about the scenarios of a family."""

    family: Annotated[str, Rule(least=1), Doc("The first scenario of those that were asked together.")]
    proved: tuple[Edge, ...]
    drives: tuple[Refutation, ...]
    doubts: tuple[Doubt, ...]


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    where, common = background.where, background.home
    for number, edge in enumerate(answer.proved, 1):
        yield _implication(edge, f"{where}, implication {number}", common)
    for number, drive in enumerate(answer.drives, 1):
        yield _refutation(drive, f"{where}, drive {number}", common)


def _implication(edge: Edge, where: str, common: Common) -> Entry:
    fault = ""
    if common.formula(edge.claim) not in edge.expected(common):
        fault = f"{where} says {edge.above} -> {edge.below}, but its claim is not that: {edge.claim[:120]}"
    return Entry(
        common,
        where,
        ("implication", edge.above, edge.below),
        "PROVED",
        f"{edge.above} -> {edge.below}",
        "proof",
        edge.claim,
        file_of(where, "proof", edge.certificate, None),
        fault=fault,
        expected=partial(edge.expected, common),
    )


def _refutation(said: Refutation, where: str, common: Common) -> Entry:
    return Entry(
        common,
        where,
        ("drive", said.drive),
        "WITNESSED",
        f"{said.holds} without {', '.join(said.fails)}",
        "drive",
        None,
        file_of(where, "drive", None, said.drive),
        fault_of=lambda formula: _misread(formula, said.holds, said.fails, common),
        expected=partial(said.expected, common),
    )


def _misread(formula: str, holds: str, fails: Sequence[str], common: Common) -> str:
    """Why a drive's formula is not that one scenario holds and the others do not; or nothing."""
    readings = readings_of(formula, common)
    told = {str(below.scenario) for _, below in readings}
    if not readings or str(readings[0][0].scenario) != holds or told != set(fails):
        return f"it says that {holds} holds without {', '.join(fails)}, but its drive: {formula[:120]}"
    return ""


Reading = tuple[Application, Application]


def readings_of(formula: str, common: Common) -> list[Reading]:
    """``A and not B and not C`` as the pairs A, B and A, C; nothing where it is no such formula."""
    match _body(formula):
        case syntax.Chain("and", (above, *others)):
            below = [x.body for x in others if isinstance(x, syntax.Prefix) and x.op == "not"]
            return _fitting([(above, x) for x in below], common) if len(below) == len(others) else []
        case _:
            return []


def _body(written: str) -> syntax.Expression | None:
    """What a text says, None where it is no formula or declares names of its own."""
    try:
        claim = parse_claim(written)
    except TextError:
        return None
    return None if claim.given else claim.body


def _fitting(pairs: Sequence[tuple[syntax.Expression, syntax.Expression]], common: Common) -> list[Reading]:
    """Pairs of scenarios that speak of the same vehicles; nothing where one pair is no such."""
    found: list[Reading] = []
    for above, below in pairs:
        one, other = (application_in(common.specification, said) for said in (above, below))
        if one is None or other is None or not _fit(one.arguments, other.arguments):
            return []
        found.append((one, other))
    return found


def _fit(above: tuple[str, ...], below: tuple[str, ...]) -> bool:
    """Whether two scenarios are about one L and the same SV, and the fewer POVs are among the others."""
    fewer, more = sorted((above, below), key=len)
    if len(fewer) == len(more) and fewer != more:
        return False
    ends = (fewer[:1], fewer[-1:]) == (more[:1], more[-1:]) == ((SUBJECT,), (LANE,))
    return ends and set(fewer) <= set(more) and len(set(fewer)) == len(fewer)


def _faults(index: Index, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """What a whole index says that its entries do not show; ``formulas`` are those of accepted drives."""
    common = background.home
    proved = {x.pair for x in index.proved}
    for edge in index.edges:
        if edge not in index.proved:
            yield f"an edge is not among what is proved: {edge.above} -> {edge.below}, {edge.claim[:80]}"
    drawn = {x.pair for x in index.edges}
    for one, other in sorted(proved):
        if other not in _reached(one, drawn):
            yield f"{one} -> {other} is proved, but does not follow from the edges"
    yield from _unshown(index, common, formulas)
    for kind in index.kinds:
        meanings = {without_names(applied(common.specification, _node(name)).formula) for name in kind}
        if len(meanings) != 1:
            yield f"{', '.join(kind)} are not one formula"
    known = {name for kind in index.kinds for name in kind}
    asked = {_node(name).set_name for name in known}
    if asked != {*index.sets}:
        yield f"its sets are not those of its scenarios: {', '.join(sorted(asked))}"
    told = {x.pair for x in (*index.missing, *index.doubts)}
    spoken = {name for names in (proved | told) for name in names}
    spoken |= {name for x in index.drives for name in (x.holds, *x.fails)}
    if spoken - known:
        yield f"it says something of {', '.join(sorted(spoken - known))}, but no kind has it"
    yield from _unanswered([kind[0] for kind in index.kinds], proved, told)


def _unshown(index: Index, common: Common, formulas: Mapping[str, str]) -> Iterator[str]:
    """Missing implications that the drives of the index do not show."""
    refuted: dict[tuple[str, str], set[Reading]] = {}
    numbers: dict[tuple[str, str], set[int]] = {}
    for drive in index.drives:
        for above, below in readings_of(formulas.get(str(drive.drive), ""), common):
            shown = str(above.scenario), str(below.scenario)
            refuted.setdefault(shown, set()).add((above, below))
            numbers.setdefault(shown, set()).add(drive.number)
    for line in index.missing:
        above_name, below_name = line.pair
        ways = _readings(common, _node(above_name), _node(below_name))
        if len(refuted.get(line.pair, ())) < len(ways):
            yield f"that {above_name} does not imply {below_name} is not shown by its drives"
        elif set(line.drives) != numbers[line.pair]:
            yield f"the drives against {above_name} -> {below_name} are not those that it names"


def _unanswered(
    names: Sequence[str], proved: Collection[tuple[str, str]], told: Collection[tuple[str, str]]
) -> Iterator[str]:
    """Pairs of which nothing is said: neither implied, nor missing, nor in doubt."""
    for above in names:
        reached = _reached(above, proved)
        for below in names:
            if below not in reached and (above, below) not in told:
                yield f"nothing is said of {above} -> {below}"


def _reached(above: str, steps: Collection[tuple[str, str]]) -> set[str]:
    """What follows from ``above`` by steps, itself included."""
    reached, waiting = {above}, [above]
    while waiting:
        current = waiting.pop()
        new = {b for a, b in steps if a == current} - reached
        reached |= new
        waiting += new
    return reached


Ways: TypeAlias = list[tuple[tuple[str, ...], tuple[str, ...]]]


def _readings(common: Common, one: Scenario, other: Scenario) -> Ways:
    """The ways in which two scenarios share vehicles: the fewer POVs are any of the others."""
    mine, theirs = (vehicles_of(common.specification, x) for x in (one, other))
    if len(mine) == len(theirs):
        return [(mine, theirs)]
    most, fewer = max(mine, theirs, key=len), min(mine, theirs, key=len)
    found = [(most[0], *rest) for rest in permutations(most[1:], len(fewer) - 1)]
    return [(x, most) if len(mine) < len(theirs) else (most, x) for x in found]


def _formula(common: Common, node: Scenario, vehicles: tuple[str, ...]) -> Formula:
    return applied(common.specification, node, vehicles).formula


def _failures(common: Common, mine: tuple[str, ...], node: Scenario, ways: Ways) -> tuple[Formula, ...]:
    """That a scenario is false, for each way in which it shares vehicles with one that has ``mine``."""
    return tuple(f.negation(_formula(common, node, below)) for above, below in ways if above == mine)


def _node(name: str) -> Scenario:
    read = _NODE.fullmatch(name)
    if read is None:
        raise InputError(f"'{name[:40]}' is no scenario: write 4@base")
    return Scenario(int(read[1]), read[2])


READER = replace(
    Reader.of(Index, Preamble, Record, _entries, faults=_faults, file_name=lambda kept: kept.family),
    unchecked_kept=("doubts", "said.sets"),
)
