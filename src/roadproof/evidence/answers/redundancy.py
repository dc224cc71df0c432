"""The index and the journal of ``roadproof redundancy``: parts of scenarios replaced by true and false."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.drive import KeptTrace
from roadproof.evidence.answers.entry import Common, Entry, file_of, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.codec import UNCHECKED, Doc, Key
from roadproof.library.compose import both, equivalence, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, applied, leaves_at_once, vehicles_of
from roadproof.library.specification import Query
from roadproof.logic.formula import Formula
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

SCHEMA: Final = "roadproof/redundancy/1"
Word: TypeAlias = Literal[Verdict.PROVED, Verdict.REFUTED, Verdict.UNKNOWN]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What becomes of a scenario where one occurrence of a part is replaced by a truth value."""

    scenario: shared.Number
    part: Annotated[str, UNCHECKED, Doc("The part that is replaced by a truth value.")]
    where: Annotated[tuple[str, ...], UNCHECKED, Doc("The definitions around it, from the outside in.")]
    value: Annotated[bool, Key("as"), UNCHECKED, Doc("The truth value.")]
    changed: Annotated[str, Doc("The scenario with that put in place of the part.")]
    redundant: Annotated[bool | None, Doc("Whether the part could be left out; null in doubt.")]
    verdict: Word
    assuming: Annotated[
        str, Doc("Of motion: that a vehicle which leaves L has a first moment outside it; else empty.")
    ]
    claim: Annotated[shared.Formula, Doc("That the scenario stays what it is.")]
    certificate: shared.KeptCertificate = None
    drive: shared.KeptDrive = None
    trace: KeptTrace | None = None
    reason: shared.Reason = NO_REASON
    late: Annotated[
        bool, UNCHECKED, Doc("Whether the clock cut it off, so that the next run asks again.")
    ] = False

    def expected(self, common: Common) -> list[Formula]:
        """The claims that the change may be made; or what a drive shows that tells the two apart."""
        home = common.specification
        whole, other = applied(home, Scenario(self.scenario, common.set_name)), read_claim(home, self.changed)
        if self.verdict is Verdict.REFUTED and self.trace is None:
            return [both(whole, negation(other)).formula, both(other, negation(whole)).formula]
        if self.verdict is Verdict.PROVED and self.assuming:
            moving = self.moving(common)
            there = implication(both(*moving, whole), other)
            back = implication(both(*moving, other), whole)
            return [both(there, back).formula]
        return [equivalence(whole, other).formula]

    def moving(self, common: Common) -> Sequence[Query]:
        """That each vehicle that leaves L has a first moment outside it."""
        home = common.specification
        vehicles = vehicles_of(home, Scenario(self.scenario, common.set_name))
        return [leaves_at_once(home, vehicle) for vehicle in vehicles]


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all changes."""

    set: shared.SetName
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """Which parts of scenarios could be left out."""

    schema: Literal["roadproof/redundancy/1"] = SCHEMA
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[Finding, ...]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer: the findings on a scenario."""

    scenario: shared.Number
    verdicts: tuple[Finding, ...]


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    for number, finding in enumerate(answer.verdicts, 1):
        yield _entry(finding, f"{background.where}, change {number}", background.home)


def _entry(said: Finding, where: str, common: Common) -> Entry:
    scenario = Scenario(said.scenario, common.set_name)
    shows = shows_of(said.verdict, where, drive="drive" if said.trace is None else "counterexample")
    fault = ""
    if said.redundant != {"proof": True, "nothing": None}.get(shows, False):
        fault = f"{where}: redundant={said.redundant}, but {said.verdict}"
    elif shows != "nothing" and common.formula(said.claim) not in said.expected(common):
        fault = f"{where} is about scenario {scenario}, but its claim is not: {said.claim[:120]}"
    elif said.assuming and common.formula(said.assuming) != both(*said.moving(common)).formula:
        fault = f"{where}: what it assumes is not that vehicles do not jump: {said.assuming[:120]}"
    value, places = str(said.value).lower(), said.where or ("",)
    return Entry(
        common,
        where,
        (scenario, said.part, places, value, said.changed),
        said.verdict,
        f"scenario {scenario}: {said.part} in {places[-1]} as {value}",
        shows,
        said.claim,
        file_of(where, shows, said.certificate, said.drive),
        said.trace,
        unchecked=("that this part was changed, and no other",) if shows != "nothing" else (),
        fault=fault,
        expected=partial(said.expected, common),
    )


READER = Reader.of(Index, Preamble, Record, _entries, file_name=lambda kept: f"scenario-{kept.scenario:02}")
