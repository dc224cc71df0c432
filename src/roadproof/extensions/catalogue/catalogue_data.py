"""The answer of ``roadproof catalogue`` as data: tests, the targets that they show, and missing targets."""

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.extensions.surveys.coverage import schema as coverage
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

SCHEMA: Final = "roadproof/catalogue/1"
Name: TypeAlias = Annotated[
    str, Rule(least=1), Doc("The definition of a scenario or a class, or the id of a test.")
]
Names: TypeAlias = tuple[Name, ...]
Vehicles: TypeAlias = Annotated[tuple[str, ...], Doc("In the order of the roles.")]
Lane: TypeAlias = Annotated[str, Doc("What L stands for.")]
Time: TypeAlias = Annotated[float, Rule(minimum=0)]
Bounds: TypeAlias = tuple[float, float]
Kind: TypeAlias = Literal["scenarios", "classes", "classes of gaps"]
FixedOrAny: TypeAlias = Literal["fixed", "any"]
Relation: TypeAlias = Literal["implies", "excludes", "shows", "runs", "empty", "reaches", "open"]
FactVerdict: TypeAlias = Literal[Verdict.PROVED, Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.UNKNOWN]
VERDICTS: Mapping[Relation, FactVerdict] = {
    "implies": Verdict.PROVED,
    "excludes": Verdict.PROVED,
    "shows": Verdict.WITNESSED,
    "runs": Verdict.WITNESSED,
    "empty": Verdict.IMPOSSIBLE,
    "reaches": Verdict.WITNESSED,
    "open": Verdict.UNKNOWN,
}


@dataclass(frozen=True, kw_only=True)
class RequestData:
    """The request of a catalogue as data."""

    paths: Annotated[tuple[str, ...], Rule(least=1), Doc("Folders of tests, and tests, as they were named.")]
    sets: Annotated[tuple[str, ...], Rule(least=1)]
    classes: bool
    gaps: bool
    explore: bool
    roles: FixedOrAny
    lanes: FixedOrAny
    start: FixedOrAny
    near: Annotated[float, Rule(minimum=0), Doc("In m and m/s.")]
    drivers: tuple[str, ...]
    strict: Annotated[
        bool, LEFT_OUT, Doc("Whether tests are faults of whose files vehicles or parts would be left out.")
    ] = False


@dataclass(frozen=True)
class ShownTarget:
    """A target that a test shows, with the first instant.

    ``vehicles`` are called what the test calls them.
    """

    what: Annotated[
        Name,
        Doc(
            "A scenario, a class, dangerArises (safe at first, then danger), gap (danger that no scenario "
            "covers), or a class of gaps."
        ),
    ]
    vehicles: Vehicles
    lane: Lane
    at: Annotated[Time, Doc("From when on, in s: the first instant.")]


@dataclass(frozen=True)
class NearestScenario:
    """The nearest scenario to a test that shows none, and its first false part."""

    nearest: Annotated[Name, Doc("The scenario most parts of which hold.")]
    vehicles: Vehicles
    lane: Lane
    at: Annotated[Time, Doc("When its first false part fails, in s.")]
    lacks: Annotated[str, Doc("The definition that fails; empty where none surrounds the comparison.")]
    told: Annotated[str, Doc("The part, the values there and the change that makes it true.")]
    sets: Annotated[Mapping[str, Names], Doc("Scenarios that hold in other spec sets.")]

    def __str__(self) -> str:
        where = f"nearest is {self.nearest}({', '.join((*self.vehicles, self.lane))}): {self.told}"
        others = "; ".join(f"set {name} counts it as {', '.join(x)}" for name, x in self.sets.items())
        return f"{where}{'; ' if others else ''}{others}"


@dataclass(frozen=True, kw_only=True)
class ConcreteTestData:
    """A test that is a drive or a recording."""

    id: Name
    title: str
    file: Annotated[
        str,
        Rule(least=1),
        Doc(
            "Its file, or vehicles of a recording; of a test that cannot be read and names no file, the "
            "catalogue.toml."
        ),
    ]
    sha256: Annotated[
        str,
        Rule(pattern="^([0-9a-f]{64})?$"),
        Doc(
            "Of its file when it was judged; of several files, of their digests one after the other; empty "
            "where one cannot be read."
        ),
    ] = ""
    copy_of: Annotated[str, Doc("The test of which it is the same in another format; empty for none.")]
    roles: Annotated[
        Mapping[str, str],
        Doc(
            "What the test calls the vehicle of each role, where that is not the role: as it says, or by "
            "usual names."
        ),
    ] = field(default_factory=dict)
    claims: Names
    dense: Annotated[bool, Doc("Judged in dense time; else monitored on samples.")]
    shown: tuple[ShownTarget, ...]
    begins: Annotated[Mapping[str, float], Doc("How it begins: numbers by term, in m and m/s.")]
    fault: Annotated[
        str,
        Doc(
            "Why the test cannot be read, its file or its entry in a catalogue.toml, with or without a "
            "formula; empty where it can."
        ),
    ]
    why: Annotated[
        NearestScenario | None,
        Doc("Why no scenario holds; null where one does, or where no comparison at an instant is to blame."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class AbstractTestData:
    """A test that is a formula."""

    id: Name
    title: str
    formula: Annotated[shared.Formula, Doc("With its ranges.")]
    claims: Names


@dataclass(frozen=True)
class TargetData:
    """A scenario or a class that tests may show."""

    name: Name
    words: str
    sector: Annotated[str, Doc("Where it happens; empty where scenarios are not divided by it.")]
    tested: Annotated[Names, Doc("Tests that show it, and abstract ones that imply it and can be run.")]
    possible: Annotated[Names, Doc("Abstract tests some drives of which show it.")]
    covered: Annotated[
        Mapping[str, Bounds],
        Doc("How the concrete tests that show it begin: least and greatest value by term."),
    ]


@dataclass(frozen=True, kw_only=True)
class GapsData:
    """The classes of gaps: those that tests show or claim; with --gaps all of them."""

    asked: Annotated[bool, Doc("Whether each is to be tested: --gaps.")]
    classes_in_all: Annotated[shared.Count, Doc("0 where no test shows one and none is asked for.")]
    targets: Annotated[tuple[TargetData, ...], Doc("Those that are not proved empty.")]
    empty: Annotated[Names, Doc("Those that are proved empty.")]
    open: Annotated[Mapping[str, str], Doc("Those of which it is not known, and why.")]
    claims: Annotated[
        tuple[coverage.CoverageClaimData, ...], Doc("With --gaps: that there is no gap at all.")
    ]
    classes: Annotated[
        tuple[coverage.GapClassDetail, ...],
        Doc("With --gaps: what was found for each class that no test shows, and for those settled with it."),
    ]


@dataclass(frozen=True)
class Figure:
    """The numbers of tested and of all targets of one kind, in all or in a road sector."""

    set_name: shared.SetName
    kind: Kind
    sector: Annotated[str, Doc("Empty for all.")]
    tested: shared.Count
    total: shared.Count


@dataclass(frozen=True, kw_only=True)
class _OfTest:
    test: Name


@dataclass(frozen=True, kw_only=True)
class DecisionData(DriverVerdict, _OfTest):
    """The outcome of a scenario of a test under a driver model."""

    drive: Annotated[
        shared.DriveField,
        Doc("The drive in which the model drives SV; null of samples and formulas, and where none begins."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class RangeData:
    """The range (m, m/s) of an initial value of drives that show a target, with --explore."""

    target: Name
    term: Annotated[str, Rule(least=1)]
    tested: Annotated[Bounds, Doc("From the least to the greatest of its concrete tests.")]
    reached: Annotated[Bounds, Doc("Least and greatest of drives that were looked for, and of tests.")]
    untested: Annotated[
        tuple[Bounds, ...], Doc("What of it no test is in or between; the facts have a drive at each end.")
    ]
    share: Annotated[float, Rule(minimum=0), Doc("How much of it that is, from 0 to 1.")]
    beyond: Annotated[tuple[str, str], Doc("What is known of lower and of higher values.")]


@dataclass(frozen=True, kw_only=True)
class FactData:
    """A relation of an abstract test to a scenario, a class or a test; other is empty for the test alone."""

    test: Annotated[str, Doc("Empty where it is about no test: reaches.")]
    other: str
    relation: Relation
    premise: Annotated[shared.Formula, Doc("The formula of the test; of reaches that of the other.")]
    conclusion: Annotated[str | None, Doc("That of the other.")]
    formula: Annotated[shared.Formula, Doc("What the evidence is about.")]
    verdict: FactVerdict
    reason: shared.Reason
    certificate: shared.CertificateField = None
    drive: shared.DriveField = None
    also: Annotated[Names, Doc("All that the drive shows.")]
    term: Annotated[str, Doc("Of reaches: the number at the start that is least or greatest.")] = ""
    sense: Literal["", "least", "greatest"] = ""
    at: Annotated[str | None, Doc("Its value, in SI units, as a fraction.")] = None


@dataclass(frozen=True)
class Remark:
    """A remark on one test, or on two."""

    tests: Names
    told: Annotated[str, Rule(least=1)]


Remarks: TypeAlias = tuple[Remark, ...]


@dataclass(frozen=True, kw_only=True)
class CatalogueHeading:
    """The head of the answer, for all tests."""

    set: shared.SetName
    scenarios: Annotated[tuple[shared.Number, ...], Doc("Numbers of the scenarios that were asked about.")]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class CatalogueData(CatalogueHeading, headings.AnswerHeading):
    """The answer about a catalogue as data."""

    schema: Literal["roadproof/catalogue/1"] = SCHEMA
    view: Annotated[shared.Dense, Doc("Of what is proved, and of drives; samples are monitored.")] = "dense"
    request: Annotated[RequestData | None, Doc("What was asked; check asks it again.")] = None
    tests: tuple[ConcreteTestData | AbstractTestData, ...]
    targets: tuple[TargetData, ...]
    gaps: GapsData
    not_tested: Annotated[
        Names, Doc("Scenarios and classes that no test shows or implies; with --gaps classes of gaps too.")
    ]
    figures: Annotated[tuple[Figure, ...], Doc("How much is tested.")]
    decisions: Annotated[
        tuple[DecisionData, ...],
        Doc("What becomes of the scenarios that tests show under each driver model."),
    ] = ()
    ranges: tuple[RangeData, ...]
    facts: tuple[FactData, ...]
    faults: Annotated[Remarks, Doc("Tests that are not what they claim, show nothing or cannot be read.")]
    doubts: Annotated[Remarks, Doc("Whether an abstract test can be run, or can show what it claims.")]
    alike: Annotated[Remarks, Doc("Tests with the same verdicts and the same start.")]
    contradictions: Annotated[Remarks, Doc("What was seen although it is proved never to be.")]
    notes: tuple[str, ...]
    left_out: headings.LeftOutParts = ()
    seconds: shared.Seconds = 0.0
