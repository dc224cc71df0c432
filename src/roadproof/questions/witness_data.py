"""The data of searches for drives, as ``witness --json`` prints them and ``question.json`` has them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, TIMED, Doc, Rule
from roadproof.evidence.schema_notes import EvidenceSchema
from roadproof.questions.drive_search_data import DriveSearchData, search_data
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict

if TYPE_CHECKING:
    from roadproof.questions.witness import SearchResult, SearchTask

SCHEMA: Final = "roadproof/witness/1"
Stages: TypeAlias = Annotated[
    Mapping[str, shared.Seconds],
    TIMED,
    Doc("By stage of the search, and all together, in s. Files of evidence leave it out."),
]
Sizes: TypeAlias = Annotated[
    Mapping[str, Annotated[int, Rule(minimum=0)]],
    Doc("Of the last problem that was solved: columns, rows, nodes, inequalities."),
]


@dataclass(frozen=True, kw_only=True)
class ResultData:
    """The result of a search for drives."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    road: Annotated[str, Doc("Name of the road on which was searched.")]
    verdict: DriveVerdict
    view: Annotated[Literal["dense", "grid"], Doc("grid: on samples up to a horizon, within the limits.")]
    reason: shared.Reason
    natural: Annotated[bool, Doc("Whether the first drive was found among natural ones.")]
    drives: tuple[Annotated[object, EvidenceSchema("drive.json")], ...]
    wishes: Annotated[
        Mapping[str, tuple[bool, ...]],
        LEFT_OUT,
        Doc("Of the objective typical only: wishes by name, and for each drive whether it fulfils them."),
    ] = field(default_factory=dict)
    limits: Annotated[shared.LimitsField | None, LEFT_OUT, Doc("Of a NONE-WITHIN only.")] = None
    core: Annotated[tuple[str, ...], LEFT_OUT, Doc("Of an IMPOSSIBLE only: parts that clash.")] = ()
    certificate: Annotated[
        object,
        LEFT_OUT,
        EvidenceSchema("certificate.json"),
        Doc("Of an IMPOSSIBLE only: that these parts never hold together."),
    ] = None
    seconds: Stages = field(default_factory=dict)
    sizes: Sizes = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class WitnessData(headings.OnRoad, headings.AnswerHeading):
    """Drives for scenarios and formulas."""

    schema: Literal["roadproof/witness/1"] = SCHEMA
    verdicts: tuple[ResultData, ...]


@dataclass(frozen=True, kw_only=True)
class DriveRequest:
    """A formula that is to hold on a drive."""

    name: Annotated[str, Rule(pattern="^[A-Za-z0-9_-]{1,80}$"), Doc("How the names of its files begin.")]
    scenario: shared.OneScenario = None
    set: shared.SetName
    formula: shared.Formula
    within: Annotated[DriveSearchData, Doc("How drives are looked for.")]
    count: Annotated[int, Rule(minimum=1), Doc("How many drives are looked for that differ clearly.")] = 1
    trees: Annotated[bool, Doc("Whether trees are looked for that show a NONE-WITHIN.")] = False


@dataclass(frozen=True, kw_only=True)
class DriveRequests:
    """Formulas, each of which is to hold on some drives."""

    searches: Annotated[
        tuple[DriveRequest, ...], Rule(least=1), Doc("The formulas, in the order of the answer.")
    ]


def task_data(task: SearchTask) -> DriveRequest:
    """Return a search as data."""
    return DriveRequest(
        name=task.name,
        scenario=task.scenario,
        set=task.specification.set_name,
        formula=task.query.text,
        within=search_data(task.within),
        count=task.count,
        trees=task.trees,
    )


def result_data(x: SearchResult) -> ResultData:
    """Return what came of a search as ``--json`` prints it."""
    from roadproof.evidence.certificate_file import certificate_data  # here: few have a certificate

    proof = x.certificate
    stages = {**x.cost.stages, "all": x.cost.seconds} if x.cost.seconds else {}
    return ResultData(
        scenario=x.scenario,
        set=x.set_name,
        formula=x.query.text,
        road=x.road,
        verdict=x.verdict,
        view="dense" if x.limits is None else "grid",
        reason=x.reason,
        natural=x.natural,
        drives=tuple(judged.as_data() for judged in x.drives),
        wishes=x.wishes,
        limits=x.limits,
        core=x.core_texts,
        certificate=None if proof is None else certificate_data(replace(proof, tableau=None)),
        seconds={stage: round(value, 4) for stage, value in stages.items()},
        sizes=dict(x.cost.sizes),
    )
