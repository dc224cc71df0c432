"""The index and the journal of ``roadproof coverage``: classes of gaps, and claims that there are none."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Annotated, ClassVar, Final, Literal, TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import PROOFS, Common, Entry, evidence_name, shows_of, shows_of_claim
from roadproof.evidence.answers.gaps import claims_of, fault_of_gap
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader, unchecked
from roadproof.evidence.codec import LEFT_OUT, UNCHECKED, Doc, Rule
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.scenarios import numbers_of
from roadproof.logic.formula import Formula
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict

SCHEMA: Final = "roadproof/coverage/1"
ClassVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.UNKNOWN]
CountedVerdict: TypeAlias = Literal[
    Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.UNKNOWN, Verdict.CROSSCHECK_FAILED
]
NeedVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.PROVED, Verdict.UNKNOWN]
SetVerdict: TypeAlias = Literal[Verdict.COVERED, Verdict.GAPS, Verdict.UNKNOWN, Verdict.CROSSCHECK_FAILED]
Names: TypeAlias = tuple[str, ...]
Road: TypeAlias = Annotated[str, Doc("Name of the road.")]
Position: TypeAlias = Annotated[int, Rule(minimum=1)]


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One of the claims that together say that there is no gap."""

    claim: shared.Formula
    verdict: ProofVerdict
    certificate: shared.KeptCertificate = None
    reason: shared.Reason = NO_REASON

    def expected(self, common: Common, numbers: Sequence[int]) -> list[Formula]:
        """All claims that together say that there is no gap of the scenarios ``numbers``."""
        return claims_of(common.specification, numbers)


@dataclass(frozen=True, kw_only=True)
class Gap:
    """A drive that the set misses, near to the scenario of a class."""

    road: Road
    formula: shared.Formula
    first: Annotated[
        str, UNCHECKED, Doc("The first of the wider sets that catches it; empty where none does.")
    ]
    caught_by: Annotated[
        tuple[Names, ...], UNCHECKED, Doc("The smallest choices of definitions of that set which catch it.")
    ]
    classes: Annotated[Names, UNCHECKED, Doc("The parts for which it is a near miss.")]
    drive: shared.KeptDrive = None
    elsewhere: Annotated[
        Mapping[str, shared.KeptDrive], Doc("The same motions as gaps on other roads, by road.")
    ]

    def expected(self, common: Common, numbers: Sequence[int]) -> list[Formula]:
        """Its formula, where that says that none of the scenarios ``numbers`` holds between two vehicles."""
        return [] if fault_of_gap(common, numbers, self.formula) else [common.formula(self.formula)]


@dataclass(frozen=True, kw_only=True)
class OrderedEntry:
    """What has a place among all of its kind."""

    number: Annotated[Position, UNCHECKED, Doc("Its place among all gaps.")]


@dataclass(frozen=True, kw_only=True)
class NumberedGap(Gap, OrderedEntry):
    """A drive that the set misses, by number."""


@dataclass(frozen=True, kw_only=True)
class GapClass:
    """A class of gaps, by what of a scenario is false."""

    scenario: Annotated[shared.OneScenario, UNCHECKED]
    component: Annotated[
        str,
        UNCHECKED,
        Doc("The definition of the scenario that is false; empty where no single condition is to blame."),
    ]
    description: Annotated[str, UNCHECKED, Doc("The component in words.")]
    condition: Annotated[str, UNCHECKED, Doc("The condition of the component; empty where it is the whole.")]
    verdict: CountedVerdict
    gaps: tuple[Gap | int, ...]
    claim: Annotated[str, Doc("Of an IMPOSSIBLE: that the class is empty.")] = ""
    certificate: shared.KeptCertificate = None
    reason: shared.Reason = NO_REASON
    none_for: Annotated[
        Names, UNCHECKED, Doc("Wider sets for which no gap was found that they catch first.")
    ] = ()

    def expected(self, common: Common) -> list[Formula]:
        """The claim as it is read; that it says that the class is empty, ``check`` lists as not compared."""
        return [common.formula(self.claim)]


@dataclass(frozen=True, kw_only=True)
class KeptClass(GapClass):
    """A class of gaps in a kept answer, which holds its gaps."""

    verdict: ClassVerdict
    gaps: Annotated[tuple[Gap, ...], Doc("Its gaps.")]


@dataclass(frozen=True, kw_only=True)
class CountedClass(GapClass):
    """A class of gaps in an index, which numbers its gaps."""

    gaps: Annotated[tuple[Position, ...], Doc("Numbers of its gaps.")]
    in_traffic: Annotated[
        shared.Count | None, UNCHECKED, LEFT_OUT, Doc("With --on: disturbances of the class in recordings.")
    ] = None
    trace: Annotated[
        str, Rule(least=1), UNCHECKED, LEFT_OUT, Doc("With --on: where the first of these is.")
    ] = ""


@dataclass(frozen=True, kw_only=True)
class Need:
    """Whether a set that covers needs one of its definitions."""

    definition: Annotated[str, Doc("The name of the definition.")]
    extends: Annotated[str, Doc("The set whose definition stands in its place in the formula.")]
    verdict: Annotated[NeedVerdict, Doc("PROVED: without the definition the set covers as much.")]
    road: Road
    formula: Annotated[str, Doc("What holds on the drive; empty where there is none.")]
    drive: shared.KeptDrive = None

    def expected(self, common: Common) -> list[Formula]:
        """The formula as it is read; whether the set without the definition misses it is not compared."""
        return [common.formula(self.formula)]


@dataclass(frozen=True, kw_only=True)
class MissedTrace:
    """A disturbance of a recording that the set misses."""

    recording: Annotated[str, Doc("The name of the recording.")]
    pair: Annotated[str, Doc("Ids of two vehicles, and frames, in words.")]
    classes: Annotated[Names, Doc("The parts for which it is a near miss; empty where there is none.")]


@dataclass(frozen=True, kw_only=True)
class Traffic:
    """What recordings hold."""

    recordings: Annotated[str, Doc("Their folder.")]
    view: Literal["recorded"] = "recorded"
    disturbances: Annotated[shared.Count, Doc("Disturbances between two vehicles.")]
    repeats: Annotated[shared.Count, Doc("Disturbances that an earlier window has shown already.")] = 0
    missed: Annotated[tuple[MissedTrace, ...], Doc("Those that the set misses.")]


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all classes."""

    set: shared.SetName
    wider: Annotated[Names, UNCHECKED, Doc("Wider sets, from the next to the widest.")]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """Which disturbances a set misses."""

    schema: Literal["roadproof/coverage/1"] = SCHEMA
    view: shared.Dense = "dense"
    verdict: SetVerdict
    claims: Annotated[tuple[Claim, ...], Doc("Together they say that there is no gap.")]
    classes: Annotated[tuple[CountedClass, ...], Doc("Classes of gaps, by what of a scenario is false.")]
    gaps: tuple[NumberedGap, ...]
    needs: Annotated[
        tuple[Need, ...],
        Doc("With --needed, of a set that covers: a drive for each definition that it needs."),
    ] = ()
    traffic: Annotated[Traffic | None, UNCHECKED, Doc("With --on: what recordings hold.")] = None
    left_out: shared.LeftOutParts = ()
    seconds: shared.Seconds = 0.0


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer: to a claim, on a definition, or on the classes of a component."""

    ALTERNATIVES: ClassVar = (("claim",), ("need",), ("group", "classes"))
    claim: Annotated[Claim | None, LEFT_OUT] = None
    need: Annotated[Need | None, LEFT_OUT] = None
    group: Annotated[str | None, LEFT_OUT, Doc("The component that the classes are of.")] = None
    classes: Annotated[tuple[KeptClass, ...], LEFT_OUT] = ()


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    where, common = background.where, background.at(background.said.text("set"))
    entries = Entries(common, numbers_of(common.specification))
    if isinstance(answer, Record):
        if [answer.claim, answer.need, answer.group].count(None) != 2:
            raise InputError(f"{where}: it has to be about one claim, one definition or one group")
        yield from entries.of_claims([x for x in [answer.claim] if x is not None])
        yield from entries.of_needs([x for x in [answer.need] if x is not None])
        yield from entries.of_classes(answer.classes)
        return
    yield from entries.of_claims(answer.claims)
    yield from entries.of_needs(answer.needs)
    told, count = [n for x in answer.classes for n in x.gaps], len(answer.gaps)
    if told != [*range(1, count + 1)]:
        raise InputError(f"{where}: its classes name the gaps {str(told)[:60]}, but it has 1 to {count}")
    yield from entries.of_classes(answer.classes)
    yield from entries.of_gaps(answer.gaps, where)


@dataclass(frozen=True)
class Entries:
    """The entries of an answer about gaps of the scenarios ``numbers``."""

    common: Common
    numbers: Sequence[int]

    def of_claims(self, claims: Sequence[Claim]) -> Iterator[Entry]:
        """That there is no gap."""
        for number, said in enumerate(claims, 1):
            where = f"{self.common.where}, claim {number}"
            yield Entry(
                self.common,
                where,
                ("claim", said.claim),
                said.verdict,
                self.common.set_name,
                shows_of_claim(said.verdict, where),
                said.claim,
                evidence_name(where, "certificate", said.certificate),
                unchecked=unchecked_of(said.verdict),
                expected=partial(said.expected, self.common, self.numbers),
            )

    def of_needs(self, needs: Sequence[Need]) -> Iterator[Entry]:
        """Definitions that are needed for there to be no gap."""
        for number, said in enumerate(needs, 1):
            where, drive = f"{self.common.where}, need {number}", said.verdict is Verdict.WITNESSED
            parent = self.common.library.sets[self.common.set_name].parent
            fault = f"{where}: its set extends '{parent}', not '{said.extends[:40]}'"
            yield Entry(
                self.common,
                where,
                ("need", said.definition),
                said.verdict,
                f"{said.definition} of {self.common.set_name}",
                "drive" if drive else "nothing",
                said.formula if drive else said.definition,
                evidence_name(where, "drive", said.drive),
                unchecked=("that the formula is the set without the definition",) if drive else (),
                fault=fault if said.extends != parent else "",
                fault_of_drive=partial(_on_other_road, said.road),
                expected=partial(said.expected, self.common),
            )

    def of_classes(self, classes: Sequence[GapClass]) -> Iterator[Entry]:
        """Classes of gaps. One that is witnessed is so by its gaps, which are entries of their own."""
        for number, said in enumerate(classes, 1):
            where = f"{self.common.where}, class {number}"
            shows = shows_of(said.verdict, where, "proof", "drive")
            words = [x for x in (said.component, said.condition) if x] or ["no single condition"]
            fault = ""
            if shows == "drive" and (said.claim or said.certificate is not None):
                fault = f"{where}: {said.verdict} with a claim or a certificate that there is no gap"
            elif bool(said.gaps) != (shows == "drive"):
                fault = f"{where}: {said.verdict} with {len(said.gaps)} gaps"
            if shows != "drive" or fault:
                yield Entry(
                    self.common,
                    where,
                    ("class", said.scenario, *words),
                    said.verdict,
                    f"class {', '.join(words)}",
                    "nothing" if shows == "drive" else shows,
                    said.claim,
                    evidence_name(where, "certificate", said.certificate),
                    unchecked=("that the claim says that the class is empty",) if shows == "proof" else (),
                    fault=fault,
                    expected=partial(said.expected, self.common),
                )
            yield from self.of_gaps([x for x in said.gaps if isinstance(x, Gap)], where)

    def of_gaps(self, gaps: Sequence[Gap], where: str) -> Iterator[Entry]:
        """Drives that the set misses, each also on other roads."""
        not_compared = ("which wider set catches it", "to which classes it belongs")
        for number, said in enumerate(gaps, 1):
            here = f"{where}, gap {number}"
            entry = Entry(
                self.common,
                here,
                ("gap", said.drive),
                "WITNESSED",
                f"gap on {said.road}",
                "drive",
                said.formula,
                evidence_name(here, "drive", said.drive),
                unchecked=not_compared,
                fault_of_drive=partial(_on_other_road, said.road),
                expected=partial(said.expected, self.common, self.numbers),
            )
            yield entry
            for road, other in said.elsewhere.items():
                file = evidence_name(f"{here}, elsewhere", road, other)
                yield replace(
                    entry,
                    key=("gap", file),
                    label=f"gap on {road}",
                    claim=None,
                    file=file,
                    unchecked=(*not_compared, "that its formula is that of the gap elsewhere"),
                    fault_of=partial(fault_of_gap, self.common, self.numbers),
                    fault_of_drive=partial(_on_other_road, road),
                    expected=lambda: None,
                )


def stem_of(group: str) -> str:
    """Under which name the answer on the classes of a component is kept."""
    return group.replace(" ", "-")


def _on_other_road(road: str, file: DriveFile) -> str:
    """Why a drive is not on a road, or nothing."""
    return "" if file.road.name == road else f"its road is {road[:40]}, but that of its file {file.road.name}"


def _faults(index: Index, background: Background, formulas: Mapping[str, str]) -> Iterator[str]:
    """What the verdict on the set says beyond what its entries show."""
    common = background.at(background.said.text("set"))
    if [common.formula(x.claim) for x in index.claims] != claims_of(common.specification):
        yield "its claims are not those that together say that there is no gap"
    if index.verdict is Verdict.COVERED and not all(x.verdict in PROOFS for x in index.claims):
        yield "COVERED, but its claims are not all proved"
    if index.verdict is Verdict.GAPS and not index.gaps:
        yield "GAPS, but it has none"


def record_faults(kept: Record, background: Background) -> Iterator[str]:
    """Where the claim of a kept answer is none of those that together say that there is no gap."""
    said, common = kept.claim, background.at(background.said.text("set"))
    if said is not None and common.formula(said.claim) not in claims_of(common.specification):
        yield f"{background.where}: coverage does not rest on this claim: {said.claim[:120]}"


UNCHECKED_KEPT = unchecked(Record)
READER = replace(
    Reader.of(
        Index,
        Preamble,
        Record,
        _entries,
        faults=_faults,
        file_name=lambda kept: kept.group and stem_of(kept.group),
        record_faults=record_faults,
    ),
    unchecked_kept=("said.wider", *UNCHECKED_KEPT),
)
