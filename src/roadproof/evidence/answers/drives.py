"""The answer of ``roadproof witness``, and its kept answers: drives, or proofs that there is none."""

from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from functools import partial
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import Common, Entry, evidence_name, fault_of_number, shows_of
from roadproof.evidence.answers.proofs import shown
from roadproof.evidence.answers.reader import Background, Reader, unchecked
from roadproof.evidence.codec import LEFT_OUT, TIMED, UNCHECKED, Doc, Rule
from roadproof.evidence.json_schema import File, Whole
from roadproof.evidence.strict import rational
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

SCHEMA: Final = "roadproof/witness/1"
Road: TypeAlias = Annotated[str, UNCHECKED, Doc("Name of the road on which was searched.")]
Natural: TypeAlias = Annotated[bool, UNCHECKED, Doc("Whether the first drive was found among natural ones.")]
Stages: TypeAlias = Annotated[
    Mapping[str, shared.Seconds],
    UNCHECKED,
    TIMED,
    Doc("By stage of the search, and all together, in s. Files of evidence leave it out."),
]
Sizes: TypeAlias = Annotated[
    Mapping[str, Annotated[int, Rule(minimum=0)]],
    UNCHECKED,
    Doc("Of the last problem that was solved: columns, rows, nodes, inequalities."),
]
Core: TypeAlias = Annotated[tuple[str, ...], UNCHECKED, Doc("Of an IMPOSSIBLE only: parts that clash.")]


@dataclass(frozen=True, kw_only=True)
class OutcomeRecord:
    """An outcome that a run has kept, with its evidence in files."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    parameters: shared.Parameters
    road: Road
    verdict: DriveVerdict
    reason: shared.Reason
    natural: Natural
    drives: tuple[shared.KeptFile, ...]
    certificate: Annotated[object, File(), Doc("Of an IMPOSSIBLE only.")]
    core: Core
    minimal: Annotated[bool, UNCHECKED, Doc("Whether no part of the core can be left out.")]
    seconds: Stages = field(default_factory=dict)
    sizes: Sizes

    def expected(self, common: Common) -> list[Formula]:
        """What holds on the drives, or the claim that it never does."""
        formula = common.formula(self.formula)
        return [f.negation(formula) if self.verdict is Verdict.IMPOSSIBLE else formula]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer."""

    name: Annotated[str, Rule(least=1), Doc("How the names of its files begin.")]
    outcome: OutcomeRecord
    asked: Annotated[
        str,
        UNCHECKED,
        Rule(pattern="^[0-9a-f]{16}$"),
        Doc("Fingerprint of formula, road, vehicles, limits and options of the search."),
    ]


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What is said once for all kept answers."""

    options: shared.Options
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What came of a search for drives."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    road: Road
    verdict: DriveVerdict
    view: Annotated[Literal["dense", "grid"], Doc("grid: on samples up to a horizon, within the limits.")]
    reason: shared.Reason
    natural: Natural
    drives: tuple[Annotated[object, Whole("drive.json")], ...]
    limits: Annotated[shared.KeptLimits | None, LEFT_OUT, Doc("Of a NONE-WITHIN only.")] = None
    core: Annotated[Core, LEFT_OUT] = ()
    certificate: Annotated[
        object,
        LEFT_OUT,
        Whole("certificate.json"),
        Doc("Of an IMPOSSIBLE only: that the formula never holds."),
    ] = None
    seconds: Stages = field(default_factory=dict)
    sizes: Sizes = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Answer(shared.OnRoad, shared.Heading):
    """Drives for scenarios and formulas."""

    schema: Literal["roadproof/witness/1"] = SCHEMA
    verdicts: tuple[Outcome, ...]


def _entries(answer: Preamble | Record, background: Background) -> Iterator[Entry]:
    """An entry for each drive, or one for the proof; there is no index."""
    if isinstance(answer, Preamble):
        return
    outcome, where = answer.outcome, f"{background.where}, outcome"
    common, verdict = background.at(outcome.set), outcome.verdict
    shows = shows_of(verdict, where, "impossibility", "drive")
    fault = fault_of_number(common, where, outcome.scenario, outcome.formula)
    drives = [evidence_name(where, "drive", x) for x in outcome.drives]
    proof = evidence_name(where, "certificate", outcome.certificate)
    if proof if shows == "drive" else drives:
        fault = f"{where}: {verdict} has evidence of another kind"
    label = shown(None if outcome.scenario is None else ("", "", outcome.scenario), common.set_name)
    for file in (drives if shows == "drive" else [proof]) or [None]:
        yield Entry(
            common,
            where,
            (outcome.set, " ".join(outcome.formula.split()), file),
            verdict,
            label,
            shows,
            outcome.formula,
            file,
            values={x: rational(y, f"{where}, parameters.{x}") for x, y in outcome.parameters.items()},
            fault=fault,
            expected=partial(outcome.expected, common),
        )


READER = replace(
    Reader.of(Preamble, Preamble, Record, _entries, file_name=lambda kept: kept.name, schema=SCHEMA),
    read_index=lambda data, background: (),
    alone=True,
    unchecked_kept=tuple(sorted(unchecked(Record), key=lambda path: path != "outcome.reason")),
)
