"""The index and the journal of ``roadproof redundancy``: parts of scenarios replaced by true and false."""

from collections.abc import Iterator, Sequence

from roadproof.evidence.answers.entry import Common, Entry, one_of, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields
from roadproof.logic.formula import Formula
from roadproof.spec.compose import both, equivalence, implication, negation
from roadproof.spec.elaborate import read_claim
from roadproof.spec.query import Query
from roadproof.spec.scenarios import Scenario, applied, leaves_at_once, vehicles_of

SCHEMA = "roadproof/redundancy/1"
_ENTRY = ("scenario", "part", "where", "as", "changed", "redundant", "verdict", "assuming", "claim")
_ENTRY_MORE = ("certificate", "drive", "trace", "reason", "late")
_UNCHECKED = tuple(f"verdicts[].{x}" for x in ("part", "where", "as", "reason", "late"))


def read(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index or a kept answer. Raises ``InputError``."""
    common = background.at(background.said.text("set"))
    for number, content in enumerate(data.items("verdicts"), 1):
        line = Fields(content, f"{common.where}, change {number}", (*_ENTRY, *_ENTRY_MORE))
        yield _entry(line, common)


def _entry(line: Fields, common: Common) -> Entry:
    scenario = Scenario(line.whole("scenario"), common.set_name)
    claim, verdict = line.text("claim"), line.text("verdict")
    by_trace = line.has("trace")
    shows = shows_of(verdict, line.where, drive="counterexample" if by_trace else "drive")
    changed, part, assuming = line.text("changed"), line.text("part"), line.text("assuming")
    fault = ""
    redundant = line.flag("redundant") if line.has("redundant") else None
    if redundant != {"proof": True, "nothing": None}.get(shows, False):
        fault = f"{line.where}: redundant={redundant}, but {verdict}"
    elif shows != "nothing" and common.formula(claim) not in _expected(
        common, scenario, changed, assuming, shows
    ):
        fault = f"{line.where} is about scenario {scenario}, but its claim is not: {claim[:120]}"
    if assuming and not fault and common.formula(assuming) != both(*_moving(common, scenario)).formula:
        fault = f"{line.where}: what it assumes is not that vehicles do not jump: {assuming[:120]}"
    value, places = str(line.flag("as")).lower(), line.texts("where") or ("",)
    return Entry(
        common,
        line.where,
        (scenario, part, places, value, changed),
        verdict,
        f"scenario {scenario}: {part} in {places[-1]} as {value}",
        shows,
        claim,
        one_of(line, shows),
        line.content.get("trace"),
        unchecked=("that this part was changed, and no other",) if shows != "nothing" else (),
        fault=fault,
    )


def _expected(common: Common, scenario: Scenario, changed: str, assuming: str, shows: str) -> list[Formula]:
    """The claims that a change may, or may not, be made."""
    home = common.specification
    whole, other = applied(home, scenario), read_claim(home, changed)
    if shows == "drive":
        return [both(whole, negation(other)).formula, both(other, negation(whole)).formula]
    if shows == "proof" and assuming:
        moving = _moving(common, scenario)
        there, back = implication(_and(moving, whole), other), implication(_and(moving, other), whole)
        return [both(there, back).formula]
    return [equivalence(whole, other).formula]


def _moving(common: Common, scenario: Scenario) -> Sequence[Query]:
    """That each vehicle that leaves L has a first moment outside it."""
    home = common.specification
    return [leaves_at_once(home, vehicle) for vehicle in vehicles_of(home, scenario)]


def _and(moving: Sequence[Query], query: Query) -> Query:
    return both(*moving, query)


READER = Reader(
    SCHEMA,
    ("set", "options", "parameters", "specs"),
    ("view", "seconds", "verdicts"),
    read,
    ("scenario", "verdicts"),
    read,
    unchecked=("seconds", *_UNCHECKED),
    unchecked_kept=_UNCHECKED,
    file_name=lambda record: f"scenario-{record.whole('scenario'):02}",
)
