"""Drives for scenarios and formulas, or proofs that there are none."""

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Annotated, ClassVar, Final, Literal, TypeAlias

from roadproof.engines.search.looking import limits_of
from roadproof.engines.search.question import usual_road
from roadproof.errors import InputError
from roadproof.evidence.answer import Answer
from roadproof.evidence.answer_files import Undecided
from roadproof.evidence.answers import shared
from roadproof.evidence.certificate import Certificate, certificate_data
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.codec import LEFT_OUT, TIMED, Doc, Rule, read
from roadproof.evidence.json_schema import Whole
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.alike import like_of
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, applied
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula, Not
from roadproof.logic.parts import parts_of, texts_of
from roadproof.questions.basis import Basis
from roadproof.questions.place import Place, mode_of, place_of
from roadproof.questions.question import Answers, Steps, heading_of
from roadproof.questions.question import Place as Placing
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import Work
from roadproof.runtime.cost import NO_COST, Cost
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict
from roadproof.world.road import Road

SCHEMA: Final = "roadproof/witness/1"
NONE_WITHIN: Final = "none-within"


@dataclass(frozen=True, kw_only=True)
class Sought:
    """A formula that is to hold on a drive."""

    name: Annotated[str, Rule(pattern="^[A-Za-z0-9_-]{1,80}$"), Doc("How the names of its files begin.")]
    scenario: shared.OneScenario = None
    set: shared.SetName
    formula: shared.Formula
    within: Annotated[Place, Doc("How drives are looked for.")]
    count: Annotated[int, Rule(minimum=1), Doc("How many drives are looked for that differ clearly.")] = 1
    trees: Annotated[bool, Doc("Whether trees are looked for that show a NONE-WITHIN.")] = False


@dataclass(frozen=True, kw_only=True)
class SoughtDrives:
    """Formulas, each of which is to hold on some drives."""

    searches: Annotated[tuple[Sought, ...], Rule(least=1), Doc("The formulas, in the order of the answer.")]


@dataclass(frozen=True)
class SearchTask:
    """A formula in a spec set, for ``count`` drives of which are looked; ``scenario``: whose number it is.

    ``trees``: whether trees are looked for that show a NONE-WITHIN.
    """

    name: str
    specification: Specification
    query: Query
    scenario: int | None = None
    within: Exists = field(default_factory=Exists)
    count: int = 1
    trees: bool = False


@dataclass(frozen=True)
class SearchResult:
    """What is known of drives for a formula; ``answers``: in the order in which drives were looked for.

    ``cost`` in this run.
    """

    task: SearchTask
    answers: tuple[Answer, ...]
    cost: Cost = NO_COST

    @property
    def scenario(self) -> int | None:
        """The number of the scenario that was asked for."""
        return self.task.scenario

    @property
    def set_name(self) -> str:
        """The spec set in which the formula is read."""
        return self.task.specification.set_name

    @property
    def query(self) -> Query:
        """The formula."""
        return self.task.query

    @property
    def verdict(self) -> DriveVerdict:
        """WITNESSED where there is a drive, else what the first search came to."""
        match self.answers[0].verdict if self.answers else Verdict.UNKNOWN:
            case Verdict.WITNESSED | Verdict.IMPOSSIBLE | Verdict.NONE_WITHIN as found:
                return found
            case _:
                return Verdict.UNKNOWN

    @property
    def drives(self) -> tuple[JudgedDrive, ...]:
        """The drives that were found."""
        return tuple(x.drive for x in self.answers if x.drive is not None)

    @property
    def reason(self) -> Reason:
        """Why there are no drives, or fewer than were asked for."""
        if not self.answers:
            return NO_REASON
        found, last = len(self.drives), self.answers[-1].reason
        if 0 < found < self.task.count:
            return Why.FEWER_DRIVES(found, self.task.count, last)
        return self.answers[0].reason

    @property
    def road(self) -> str:
        """The name of the road on which was searched."""
        if self.drives:
            return self.drives[0].file.road.name
        return (self.task.within.road or usual_road(self.query.formula)).name

    @property
    def natural(self) -> bool:
        """Whether the first drive was found among natural ones."""
        return bool(self.drives) and bool(self.drives[0].natural)

    @property
    def certificate(self) -> Certificate | None:
        """The proof that there is no drive, if there is one."""
        return self.answers[0].certificate if self.answers else None

    @cached_property
    def core(self) -> tuple[Formula, ...]:
        """The parts that the proof shows to clash."""
        if self.certificate is None:
            return ()
        denied = read_claim(self.answers[0].claim.home, self.certificate.claim).formula
        return tuple(dict.fromkeys(parts_of(denied.body))) if isinstance(denied, Not) else ()

    @property
    def told(self) -> tuple[str, ...]:
        """The parts that clash as texts."""
        return texts_of(self.core)

    @property
    def told_without_options(self) -> str:
        """The reason, without the options of the command line that widen limits."""
        if self.limits is None:
            return self.reason
        return limits_of(self.answers[0].claim).text(())

    @property
    def limits(self) -> object:
        """Within what a NONE-WITHIN says that there is none."""
        found = self.answers[0].evidence if self.answers else None
        return found.limits if isinstance(found, Undecided) else None


@dataclass(frozen=True)
class WitnessView:
    """The results in the order in which they were asked."""

    results: tuple[SearchResult, ...]


@dataclass(frozen=True)
class WitnessQuestion:
    """The question for drives of some formulas."""

    kind: ClassVar[str] = "witness"
    basis: Basis
    tasks: tuple[SearchTask, ...]

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, proof=0.0, alone=True)

    @property
    def asked(self) -> SoughtDrives:
        """What is asked as data."""
        return SoughtDrives(searches=tuple(map(_sought, self.named.values())))

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "WitnessQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        data = read(SoughtDrives, asked, where)
        tasks = tuple(_task(basis.specification.in_set(x.set), x, where) for x in data.searches)
        return cls(basis, tasks)

    def beside(self, former: "WitnessQuestion") -> "WitnessQuestion":
        """Return the question about former formulas, too: a folder of drives grows."""
        return replace(self, tasks=tuple({**former.named, **self.named}.values()))

    def displaced(self, former: "WitnessQuestion") -> list[str]:
        """Return the names of answers to former searches in whose place there is another now."""
        others = [x for x in former.named if x in self.named and not self._is_asked_by(former, x)]
        return [y for x in others for y in (*former.claim_names(x), f"{NONE_WITHIN}-{x}")]

    def _is_asked_by(self, other: "WitnessQuestion", name: str) -> bool:
        """Whether another question has this search under this name, too."""
        is_same = self.named[name].count == other.named[name].count
        return is_same and self.claim(name) == other.claim(name)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of the searches, in order; names of files begin so."""
        return tuple(x.name for x in self.tasks)

    @cached_property
    def named(self) -> dict[str, SearchTask]:
        """The searches by name; what is asked twice is there once."""
        return {x.name: x for x in self.tasks}

    def claim_names(self, name: str) -> list[str]:
        """Return the names of the claims of a search, one for each drive."""
        count = self.named[name].count
        return [name] if count == 1 else [f"{name}-{k}" for k in range(1, count + 1)]

    def search_named(self, claim: str) -> str:
        """Return the name of the search to which a claim belongs."""
        plain = claim.removeprefix(f"{NONE_WITHIN}-")
        return plain if plain in self.named else plain.rpartition("-")[0]

    def is_last(self, claim: str, answer: Answer) -> bool:
        """Return whether nothing more is asked of a search once a claim of it has this answer."""
        name = self.search_named(claim)
        if claim not in self.claim_names(name):
            return True
        if claim == self.claim_names(name)[0] and self.wants_trees(name, answer):
            return False
        return answer.drive is None or claim == self.claim_names(name)[-1]

    def wants_trees(self, name: str, first: Answer) -> bool:
        """Return whether trees are looked for where the first search came to this answer."""
        return self.named[name].trees and first.verdict is Verdict.NONE_WITHIN

    def claim(self, name: str, before: Sequence[Answer] = ()) -> Claim:
        """Return the claim that there is a drive, which is unlike those ``before``."""
        task = self.named[name]
        unlike = tuple(x.drive.file.drive for x in before if x.drive is not None)
        mode = replace(task.within, unlike=unlike)
        return claim_of(task.specification, task.query, mode, self.basis.values)

    def batches(self, known: Answers) -> list["SearchBatch"]:
        """A batch for scenarios of which one search may answer several."""
        groups: dict[object, list[str]] = {}
        for name, task in self.named.items():
            number = task.scenario
            group = name if number is None else like_of(task.specification, number)
            groups.setdefault(group, []).append(name)
        return [SearchBatch(self, tuple(names)) for names in groups.values()]

    def label(self, name: str) -> str:
        """Return which scenario the claim of a name is about."""
        task = self.named[self.search_named(name)]
        scenario = "" if task.scenario is None else f"scenario {task.scenario} "
        return f"{scenario}{task.specification.set_name}"

    def view(self, known: Answers) -> WitnessView:
        """Return what was found for each formula."""
        return WitnessView(tuple(self.result(name, known) for name in self.names))

    def result(self, name: str, known: Answers) -> SearchResult:
        """Return what is known of drives for a formula."""
        return SearchResult(self.named[name], tuple(known[x] for x in self.claim_names(name) if x in known))

    def data(self, view: WitnessView, place: Placing, seconds: float) -> "WitnessData":
        """Return the view as ``--json`` prints it."""
        return WitnessData(
            **heading_of(SCHEMA, self.basis),
            **WitnessData.of_road(self.road),
            verdicts=tuple(map(result_data, view.results)),
        )

    @property
    def road(self) -> Road | None:
        """The road on which drives are looked for, where one was chosen."""
        return self.tasks[0].within.road


@dataclass(frozen=True)
class SearchBatch:
    """The searches of some formulas."""

    question: WitnessQuestion
    names: tuple[str, ...]

    @property
    def name(self) -> str:
        """The name of the first search."""
        return self.names[0]

    def steps(self) -> Steps:
        """Yield a claim for each drive, until there is none, and for trees of a NONE-WITHIN."""
        for name in self.names:
            found: list[Answer] = []
            for claim_name in self.question.claim_names(name):
                found.append((yield claim_name, self.question.claim(name, found)))
                if found[-1].drive is None:
                    break
            if self.question.wants_trees(name, found[0]):
                within = self.question.named[name].within
                claim = self.question.claim(name)
                yield f"{NONE_WITHIN}-{name}", replace(claim, mode=replace(within, trees=True))


def _task(home: Specification, sought: Sought, where: str) -> SearchTask:
    """Return a search as data say it. Raises ``InputError``."""
    query = read_claim(home, sought.formula)
    if sought.scenario is not None:
        scenario = applied(home, Scenario(sought.scenario, home.set_name))
        if scenario.formula != query.formula:
            raise InputError(f"{where}: {sought.formula[:80]} is not scenario {sought.scenario}")
    within = mode_of(sought.within, where)
    return SearchTask(sought.name, home, query, sought.scenario, within, sought.count, sought.trees)


def _sought(task: SearchTask) -> Sought:
    return Sought(
        name=task.name,
        scenario=task.scenario,
        set=task.specification.set_name,
        formula=task.query.text,
        within=place_of(task.within),
        count=task.count,
        trees=task.trees,
    )


def name_of(number: int, scenario: int | None, set_name: str) -> str:
    """Return the name of the ``number``-th search."""
    what = f"formula-{number:02d}" if scenario is None else f"scenario-{scenario:02d}"
    return f"{what}-{set_name}"


# --- as data -----------------------------------------------------------------------------------------

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
    """What came of a search for drives."""

    scenario: shared.OneScenario
    set: shared.SetName
    formula: shared.Formula
    road: Annotated[str, Doc("Name of the road on which was searched.")]
    verdict: DriveVerdict
    view: Annotated[Literal["dense", "grid"], Doc("grid: on samples up to a horizon, within the limits.")]
    reason: shared.Reason
    natural: Annotated[bool, Doc("Whether the first drive was found among natural ones.")]
    drives: tuple[Annotated[object, Whole("drive.json")], ...]
    limits: Annotated[shared.KeptLimits | None, LEFT_OUT, Doc("Of a NONE-WITHIN only.")] = None
    core: Annotated[tuple[str, ...], LEFT_OUT, Doc("Of an IMPOSSIBLE only: parts that clash.")] = ()
    certificate: Annotated[
        object,
        LEFT_OUT,
        Whole("certificate.json"),
        Doc("Of an IMPOSSIBLE only: that these parts never hold together."),
    ] = None
    seconds: Stages = field(default_factory=dict)
    sizes: Sizes = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class WitnessData(shared.OnRoad, shared.Heading):
    """Drives for scenarios and formulas."""

    schema: Literal["roadproof/witness/1"] = SCHEMA
    verdicts: tuple[ResultData, ...]


def result_data(x: SearchResult) -> ResultData:
    """Return what came of a search as ``--json`` prints it."""
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
        limits=x.limits,
        core=x.told,
        certificate=None if proof is None else certificate_data(replace(proof, tableau=None)),
        seconds={stage: round(value, 4) for stage, value in stages.items()},
        sizes=dict(x.cost.sizes),
    )
