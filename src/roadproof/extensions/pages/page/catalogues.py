"""The template values of a test catalogue: tested situations, and what each test shows."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.catalogue.catalogue_data import (
    AbstractTestData,
    CatalogueData,
    ConcreteTestData,
    DecisionData,
    FactData,
    RequestData,
)
from roadproof.extensions.catalogue.concrete_claims import judged_name
from roadproof.extensions.catalogue.report import sheet_of
from roadproof.extensions.catalogue.settings import Catalogue
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.pages.command_lines import command_line
from roadproof.extensions.pages.page.page_context import PageContext, PageDrive
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.viewer_data import ShownFormula
from roadproof.extensions.traffic.scenario_parts import danger_comes
from roadproof.library.bind import values_with
from roadproof.library.scenarios import number_in, numbers_of, roles
from roadproof.library.specification import Specification, on_request
from roadproof.verdict import Verdict
from roadproof.world.units import UNITS

MOST_FORMULAS = 6


@dataclass(frozen=True)
class _Test:
    """A test with the facts about it.

    ``link``: its id on the page; ``row``: that of its row in the table, which is called as the file of its
    judgement. ``wrong``: why it is not what it claims.
    """

    data: ConcreteTestData | AbstractTestData
    facts: Sequence[FactData]
    link: str
    row: str
    wrong: Sequence[str] = ()

    @property
    def id(self) -> str:
        return self.data.id

    @property
    def is_abstract(self) -> bool:
        """Return whether the test is a formula."""
        return isinstance(self.data, AbstractTestData)

    @property
    def has_file(self) -> bool:
        """Return whether the file of its drive exists, relative to where the catalogue was made."""
        return isinstance(self.data, ConcreteTestData) and Path(self.data.file).is_file()

    @property
    def shown(self) -> set[str]:
        """The scenarios and classes that its drive shows."""
        return {x.what for x in self.data.shown} if isinstance(self.data, ConcreteTestData) else set()

    @property
    def claims(self) -> Sequence[str]:
        """The scenarios and classes that the test claims to show."""
        return self.data.claims

    @property
    def refuted(self) -> set[str]:
        """The claims that are known to be false unless the test shows them."""
        if isinstance(self.data, ConcreteTestData) or any(x.relation == "empty" for x in self.facts):
            return {*self.claims}
        return {*self.claims} & {x.other for x in self.facts if x.relation == "excludes"}


def catalogue(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return situations and tests, decisions of driver models, and how the answer was made."""
    data = read(CatalogueData, result.data, result.name)
    targets = (*data.targets, *data.gaps.targets)
    wrong: dict[str, list[str]] = {}
    for remark in (*data.faults, *data.contradictions):
        for name in remark.tests:
            wrong.setdefault(name, []).append(remark.told)
    set_name = data.set.partition(",")[0]
    tests = [
        _Test(
            x,
            [y for y in data.facts if y.test == x.id],
            f"test-{result.id}-{k}",
            judged_name(x.id, set_name),
            wrong.get(x.id, ()),
        )
        for k, x in enumerate(data.tests)
    ]
    known = {x.id for x in tests}
    missing = dict.fromkeys(data.not_tested, Verdict.GAPS)
    return {
        "answer": data,
        "targets": targets,
        "situations": sheet_of(targets, missing, any(x.possible for x in targets)),
        "tests": tests,
        "other_facts": [x for x in data.facts if x.test not in known],
        "drive_of": _drives(data, context),
        **_decisions(data.decisions),
        **_provenance(data, context),
    }


def _decisions(decisions: Sequence[DecisionData]) -> dict[str, object]:
    """Return decisions by test and scenario, then by model; ``symbols``: quantities of the
    states, by name.
    """
    rows: dict[tuple[str, str], dict[str, DecisionData]] = {}
    for x in decisions:
        rows.setdefault((x.test, x.scenario), {})[x.driver] = x
    quantities = {name: x for kind in MANOEUVRES.values() for name, x in kind.quantities.items()}
    names = {name for x in decisions for name in x.start if name not in ("length", "width")}
    return {
        "decisions": rows,
        "models": {name: x for name, x in MODELS.items() if any(y.driver == name for y in decisions)},
        "symbols": {name: x for name, x in quantities.items() if name in names},
        "worst_of": _worst_of,
        "least_left": _least_left,
        "reasons_of": _reasons_of,
        "own_drives": sum(_worst_of([*x.values()]) is not None for x in rows.values()),
    }


def _worst_of(decisions: Sequence[DecisionData]) -> DecisionData | None:
    """Return the decision with a drive that is worst: the hardest collision, else the least gap."""
    driven = [x for x in decisions if x.drive is not None]
    hits = [x for x in driven if x.speed is not None]
    return max(hits, key=lambda x: x.speed or 0.0, default=None) or min(
        (x for x in driven if x.gap is not None), key=lambda x: x.gap or 0.0, default=None
    )


def _least_left(decisions: Sequence[DecisionData]) -> str:
    """Return the least gap (m) that a driver leaves, 0 where one collides; empty where none is decided."""
    if any(x.instant is not None for x in decisions):
        return "0"
    gaps = [x.gap for x in decisions if x.gap is not None]
    return f"{min(gaps):.4g}" if gaps else ""


def _reasons_of(decisions: Mapping[str, DecisionData]) -> list[tuple[list[str], str]]:
    """Return each reason with the models that it is of."""
    reasons: dict[str, list[str]] = {}
    for name, x in decisions.items():
        if x.reason:
            reasons.setdefault(x.reason, []).append(name)
    return [(names, reason) for reason, names in reasons.items()]


def _provenance(data: CatalogueData, context: PageContext) -> dict[str, object]:
    """Return the command that made the answer, if it is known, and the tests with digests."""
    digests = [x for x in data.tests if isinstance(x, ConcreteTestData) and x.sha256]
    if data.request is None:
        return {"command": None, "digests": digests}
    home = context.library.select(data.request.sets[0], data.options)
    values = {name: Fraction(value) for name, value in data.parameters.items()}
    settings = (as_settings(data.request), *_definitions(home, values, data.scenarios))
    return {"command": command_line("catalogue", data.request.paths, *settings), "digests": digests}


def as_settings(request: RequestData) -> Catalogue:
    """Return the options of the command that makes a request."""
    return Catalogue(
        sets=(",".join(request.sets),),
        classes=request.classes,
        gaps=request.gaps,
        explore=request.explore,
        roles=request.roles,
        lanes=request.lanes,
        start=request.start,
        near=request.near,
        strict=request.strict,
        drivers=None if request.drivers == (*MODELS,) else request.drivers,
    )


def _definitions(
    home: Specification, values: Mapping[str, Fraction], numbers: Sequence[int]
) -> Iterator[Catalogue]:
    """Yield the options for the definitions, values and scenarios of a catalogue."""
    library, restriction = home.library, restriction_of(home.options)
    if tuple(numbers) != numbers_of(home):
        yield Catalogue(among=",".join(map(str, numbers)))
    shipped, known = set[str](), dict[str, str]()
    if restriction is not None:
        shipped, known = {*map(str, on_request().values())}, dict(restriction.options)
        yield Catalogue.of({restriction.side: restriction.model})
    usual, declared = library.options, values_with(library, {})
    readings = {k: x for k, x in home.options.items() if k not in known and x != usual[k].values[0]}
    units = {name: UNITS[x.unit][0] for name, x in library.parameters.items()}
    yield Catalogue(
        specs=tuple(x.name for x in library.files if x.name not in shipped),
        readings=readings or None,
        params={name: x / units[name] for name, x in values.items() if x != declared[name]} or None,
    )


def _drives(data: CatalogueData, context: PageContext) -> Callable[[ConcreteTestData], PageDrive]:
    """Return a function that puts the drive of a test on the page, judged for the scenarios it shows."""
    set_name = data.set.partition(",")[0]
    values = {name: Fraction(v) for name, v in data.parameters.items()}

    def drive_of(test: ConcreteTestData) -> PageDrive:
        scenarios = [y for y in test.shown if number_in(y.what) is not None][:MOST_FORMULAS]
        lanes = {y.lane: f"L{k}" for k, y in enumerate(scenarios)}
        failing = [*_failing(test, {y.what for y in scenarios}, lanes)]

        def as_tested(file: DriveFile) -> DriveFile:
            """The drive in the definitions and at the values of the catalogue."""
            named = {**file.lanes, **{v: k for k, v in lanes.items()}}
            return replace(file, set_name=set_name, options=data.options, values=values, lanes=named)

        texts = [_applied(y.what, y.vehicles, lanes[y.lane]) for y in scenarios]
        formulas = [ShownFormula("question", x, explain=(0, Fraction(0))) for x in failing]
        formulas += [ShownFormula("watch" if k or failing else "question", x) for k, x in enumerate(texts)]
        if not formulas:
            danger = danger_comes(context.library.select(set_name), *roles(2)).text
            return context.drive(
                Path(test.file), adapt=as_tested, formulas=[ShownFormula("question", danger)], hold_at=[]
            )
        return context.drive(
            Path(test.file),
            adapt=as_tested,
            formulas=formulas,
            hold_at=[*(None for _ in failing), *(float(y.at) for y in scenarios)],
        )

    return drive_of


def _applied(name: str, vehicles: Sequence[str], lane: str) -> str:
    """Return a scenario of vehicles in a lane, as text."""
    first, *others = vehicles
    group = others[0] if len(others) == 1 else f"{{{', '.join(others)}}}"
    return f"{name}({first}, {group}, {lane})"


def _failing(test: ConcreteTestData, shown: Collection[str], lanes: dict[str, str]) -> Iterator[str]:
    """Yield the scenario that a picture of the test shows to fail: the first that it claims, or the nearest.

    ``lanes``: the name of each lane in formulas; that of the nearest scenario is added.
    """
    claimed = [x for x in test.claims if number_in(x) is not None and x not in shown]
    if claimed:
        yield str(number_in(claimed[0]))
    elif test.why is not None:
        name = lanes.setdefault(test.why.lane, f"L{len(lanes)}")
        yield _applied(test.why.nearest, test.why.vehicles, name)
