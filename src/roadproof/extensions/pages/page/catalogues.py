"""Values of the section of a catalogue: what is tested, and what each test shows."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.catalogue.kept import (
    AbstractTest,
    ConcreteTest,
    Index,
    KeptDecision,
    KeptFact,
    KeptRequest,
)
from roadproof.extensions.catalogue.report import sheet_of
from roadproof.extensions.catalogue.settings import Catalogue
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.pages.page.page_context import PageContext, ShownDrive
from roadproof.extensions.pages.page.results import Result, Words
from roadproof.extensions.pages.viewer_data import ShownFormula
from roadproof.frontends.settings.flags import command_line
from roadproof.library.bind import values_with
from roadproof.library.scenarios import danger_comes, number_in, numbers_of, roles
from roadproof.library.specification import Specification, on_request
from roadproof.verdict import Verdict
from roadproof.world.units import UNITS

MOST_FORMULAS = 6


@dataclass(frozen=True)
class _Test:
    """A test with the facts about it; ``link``: where it is on the page."""

    kept: ConcreteTest | AbstractTest
    facts: Sequence[KeptFact]
    link: str

    @property
    def id(self) -> str:
        return self.kept.id

    @property
    def is_abstract(self) -> bool:
        """Whether it is a formula."""
        return isinstance(self.kept, AbstractTest)

    @property
    def is_there(self) -> bool:
        """Whether the file of its drive is where the catalogue was asked for."""
        return isinstance(self.kept, ConcreteTest) and Path(self.kept.file).is_file()

    @property
    def shown(self) -> set[str]:
        """What its drive shows."""
        return {x.what for x in self.kept.shown} if isinstance(self.kept, ConcreteTest) else set()

    @property
    def claims(self) -> Sequence[str]:
        """What it says that it is."""
        return self.kept.claims

    @property
    def refuted(self) -> set[str]:
        """Claims of it that are known to be false, where it does not show them."""
        if isinstance(self.kept, ConcreteTest) or any(x.relation == "empty" for x in self.facts):
            return {*self.claims}
        return {*self.claims} & {x.other for x in self.facts if x.relation == "excludes"}


def catalogue(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Situations and tests, decisions of driver models, and how the answer was made."""
    data = read(Index, result.data, result.name)
    targets = (*data.targets, *data.gaps.targets)
    asked = targets if data.gaps.asked else data.targets
    tests = [
        _Test(x, [y for y in data.facts if y.test == x.id], f"test-{result.id}-{k}")
        for k, x in enumerate(data.tests)
    ]
    known = {x.id for x in tests}
    missing = dict.fromkeys(data.not_tested, Verdict.GAPS)
    return {
        "answer": data,
        "targets": targets,
        "situations": sheet_of(targets, missing, any(x.possible for x in targets)),
        "tests": tests,
        "asked": len(asked),
        "lacking": sum(x.name in data.not_tested for x in asked),
        "other_facts": [x for x in data.facts if x.test not in known],
        "drive_of": _drives(data, context),
        **_decisions(data.decisions),
        **_provenance(data, context),
    }


def _decisions(found: Sequence[KeptDecision]) -> dict[str, object]:
    """Decisions by test and scenario, then by model; ``symbols``: quantities of the states, by name."""
    rows: dict[tuple[str, str], dict[str, KeptDecision]] = {}
    for x in found:
        rows.setdefault((x.test, x.scenario), {})[x.driver] = x
    quantities = {name: x for kind in MANOEUVRES.values() for name, x in kind.quantities.items()}
    told = {name for x in found for name in x.start if name not in ("length", "width")}
    return {
        "decisions": rows,
        "models": {name: x for name, x in MODELS.items() if any(y.driver == name for y in found)},
        "symbols": {name: x for name, x in quantities.items() if name in told},
    }


def _provenance(data: Index, context: PageContext) -> dict[str, object]:
    """The command that made the answer, if it is known, and the tests with digests."""
    digests = [x for x in data.tests if isinstance(x, ConcreteTest) and x.sha256]
    if data.request is None:
        return {"command": None, "digests": digests}
    home = context.library.select(data.request.sets[0], data.options)
    values = {name: Fraction(value) for name, value in data.parameters.items()}
    asked = (as_settings(data.request), *_definitions(home, values, data.scenarios))
    return {"command": command_line("catalogue", data.request.paths, *asked), "digests": digests}


def as_settings(request: KeptRequest) -> Catalogue:
    """A request as the options of the command that asks it."""
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
    """The options that say in which definitions, and of which scenarios, a catalogue was asked."""
    library, restriction = home.library, restriction_of(home.options)
    if tuple(numbers) != numbers_of(home):
        yield Catalogue(among=",".join(map(str, numbers)))
    shipped, known = set[str](), dict[str, str]()
    if restriction is not None:
        shipped, known = {*map(str, on_request().values())}, dict(restriction.options)
        yield Catalogue.of({restriction.side: restriction.model})
    usual, declared = library.options, values_with(library, {})
    told = {k: x for k, x in home.options.items() if k not in known and x != usual[k].values[0]}
    units = {name: UNITS[x.unit][0] for name, x in library.parameters.items()}
    yield Catalogue(
        specs=tuple(x.name for x in library.files if x.name not in shipped),
        readings=told or None,
        params={name: x / units[name] for name, x in values.items() if x != declared[name]} or None,
    )


def _drives(data: Index, context: PageContext) -> Callable[[ConcreteTest], ShownDrive]:
    """What puts the drive of a test on the page with the scenarios that it is said to show, judged."""
    set_name = data.set.partition(",")[0]
    values = {name: Fraction(v) for name, v in data.parameters.items()}

    def drive_of(test: ConcreteTest) -> ShownDrive:
        scenarios = [y for y in test.shown if number_in(y.what) is not None][:MOST_FORMULAS]
        lanes = {y.lane: f"L{k}" for k, y in enumerate(scenarios)}

        def put(file: DriveFile) -> DriveFile:
            """The drive in the definitions and at the values of the catalogue."""
            named = {**file.lanes, **{v: k for k, v in lanes.items()}}
            return replace(file, set_name=set_name, options=data.options, values=values, lanes=named)

        asked = []
        for k, y in enumerate(scenarios):
            first, *others = y.vehicles
            group = others[0] if len(others) == 1 else f"{{{', '.join(others)}}}"
            asked.append(
                ShownFormula("watch" if k else "question", f"{y.what}({first}, {group}, {lanes[y.lane]})")
            )
        if not asked:
            danger = danger_comes(context.library.select(set_name), *roles(2)).text
            return context.drive(Path(test.file), put=put, asked=[ShownFormula("question", danger)], since=[])
        return context.drive(Path(test.file), put=put, asked=asked, since=[float(y.at) for y in scenarios])

    return drive_of
