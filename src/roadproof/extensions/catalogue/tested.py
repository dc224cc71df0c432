"""What a catalogue tests and what it misses, which tests are not what they claim, and which say the same."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from roadproof.extensions.catalogue.asked import NOWHERE, Questions
from roadproof.extensions.catalogue.entries import Abstract, Freedom
from roadproof.extensions.catalogue.fact import Fact
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.kept import Figure, Kind, Remark, Target
from roadproof.extensions.catalogue.showing import ENDANGERED, GAP, ConcreteAnswer, why_not
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.library.scenarios import name_of, number_in, numbers_of
from roadproof.library.words import called
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class TestedGaps:
    """Classes of gaps: the ``targets`` that are not ``empty``, which is proved, in order.

    ``asked``: whether gaps are to be tested too, so that it was asked which are empty; ``open``: the names of
    those of which neither a drive nor a proof was found, with the reason. Without it there are the classes
    that tests show, and ``total`` of all.
    """

    asked: bool = False
    targets: tuple[Target, ...] = ()
    empty: tuple[Target, ...] = ()
    open: Mapping[str, str] = field(default_factory=dict)
    total: int = 0

    @property
    def missing(self) -> tuple[Target, ...]:
        """Those that are asked for, that there are, and that no test shows."""
        return tuple(x for x in self.targets if self.asked and not x.tested and x.name not in self.open)


@dataclass(frozen=True)
class Targets:
    """The targets in order, and what is remarked: ``faults`` of tests that are not what they claim or show
    nothing, ``doubts``, tests that are ``alike``, and ``contradictions`` between what was proved and seen.
    """

    targets: tuple[Target, ...]
    gaps: TestedGaps
    faults: tuple[Remark, ...]
    doubts: tuple[Remark, ...]
    alike: tuple[Remark, ...]
    contradictions: tuple[Remark, ...]

    @property
    def missing(self) -> tuple[Target, ...]:
        """What is to be tested, and no test shows."""
        return (*(x for x in self.targets if not x.tested), *self.gaps.missing)

    @property
    def all_targets(self) -> tuple[Target, ...]:
        """Scenarios, classes, and classes of gaps."""
        return (*self.targets, *self.gaps.targets)


def tested(
    asked: Questions,
    concrete: Sequence[ConcreteAnswer],
    abstract: Sequence[Abstract],
    facts: Sequence[Fact],
    words: Mapping[str, str],
    near: float,
    surveyed: Mapping[str, ClassAnswer | None] | None,
) -> Targets:
    """All of it. ``words``: each target by name, in words, in order; ``near``: how far tests that say the
    same may begin apart, in m and m/s; ``surveyed``: what is known of each class of gaps by name, None of
    those that tests show, where gaps are to be tested too. What tests claim is of scenarios as they are: it
    is not looked at where a driver model says how they begin.
    """
    sectors = sectors_of(asked)
    gaps = _gaps(asked, concrete, facts, surveyed)
    known = {*words, *(x.name for x in (*gaps.targets, *gaps.empty))}
    restricted = restriction_of(asked.specification.options) is not None
    claimed = (
        ()
        if restricted
        else (*_of_concrete(asked, concrete, known, gaps.asked), *_of_abstract(asked, abstract, facts, known))
    )
    unreadable = (Remark((x.entry.id,), f"cannot be read: {x.fault}") for x in concrete if x.fault)
    # Drive files that are not what they say, judged with their own values.
    rejected = (Remark((x.entry.id,), f"its file is rejected: {x.rejected}") for x in concrete if x.rejected)
    open_gaps = (
        Remark((name,), f"whether there is such a gap is in doubt: {reason}")
        for name, reason in gaps.open.items()
    )
    return Targets(
        tuple(_target(name, told, sectors.get(name, ""), concrete, facts) for name, told in words.items()),
        gaps,
        (*unreadable, *rejected, *claimed),
        (*_doubts(abstract, facts), *open_gaps),
        (*_same(concrete, near), *_implied(abstract, facts)),
        (*_contradictions(concrete, facts), *_shown_though_empty(gaps)),
    )


def _gaps(
    asked: Questions,
    concrete: Sequence[ConcreteAnswer],
    facts: Sequence[Fact],
    surveyed: Mapping[str, ClassAnswer | None] | None,
) -> TestedGaps:
    """The classes of gaps; those that are shown or claimed where it is not asked for all."""
    wanted = {x for answer in concrete for x in (*answer.names, *answer.claims) if x.startswith(PREFIX)}
    wanted |= {x for fact in facts for x in fact.also if x.startswith(PREFIX)}
    if asked.gaps is None or not (wanted or surveyed is not None):
        return TestedGaps()
    words = asked.gaps.words
    made = {name: _target(name, told, "", concrete, facts) for name, told in words.items()}
    if surveyed is None:
        shown = tuple(x for x in made.values() if x.name in wanted)
        return TestedGaps(targets=shown, total=len(made))
    verdicts = {name: answer.verdict for name, answer in surveyed.items() if answer is not None}
    empty = tuple(x for x in made.values() if verdicts.get(x.name) is Verdict.IMPOSSIBLE)
    still_open = {
        name: answer.reason
        for name, answer in surveyed.items()
        if answer is not None and answer.verdict is Verdict.UNKNOWN and not made[name].tested
    }
    left = tuple(x for x in made.values() if x not in empty)
    return TestedGaps(True, left, empty, still_open, len(made))


def _shown_though_empty(gaps: TestedGaps) -> Iterator[Remark]:
    for target in gaps.empty:
        for test in (*target.tested, *target.possible):
            yield Remark((test,), f"shows {target.name}, though that is proved to be empty")


def targets_of(asked: Questions) -> dict[str, str]:
    """Every scenario and every class by name, with what it is in words."""
    words = called(asked.specification, asked.numbers)
    targets = {name_of(number): x.name or f"scenario {number}" for number, x in words.items()}
    if asked.classes is not None:
        for one in asked.classes.all():
            place = "" if one.place is None else f", {one.place.replace('_', ' and ')}"
            targets[one.name] = one.description + place
    return targets


def sectors_of(asked: Questions) -> dict[str, str]:
    """The road sector of each scenario and class by name; none where there are no classes or one sector."""
    if asked.classes is None or not asked.classes.plan.has_places:
        return {}
    plan = asked.classes.plan
    sectors = {
        name_of(number): plan.sectors[first]
        for group in plan.groups
        for number, (_, first) in group.rows.items()
    }
    return sectors | {one.name: str(one.place) for one in asked.classes.all()}


def _target(
    name: str, words: str, sector: str, concrete: Sequence[ConcreteAnswer], facts: Sequence[Fact]
) -> Target:
    showing = [x for x in concrete if name in x.names]
    implied = [x.test for x in facts if x.other == name and x.relation == "implies"]
    runs = {x.test for x in facts if x.relation == "runs"}
    possible = [x.test for x in facts if x.relation in ("shows", "runs") and name in (x.other, *x.also)]
    sure = [*(x.entry.id for x in showing), *(x for x in implied if x in runs)]
    covered: dict[str, tuple[float, float]] = {}
    for x in showing:
        for number, value in x.begins.items():
            low, high = covered.get(number, (value, value))
            covered[number] = min(low, value), max(high, value)
    maybe = dict.fromkeys(x for x in possible if x not in sure)
    return Target(name, words, sector, tuple(dict.fromkeys(sure)), tuple(maybe), covered)


# --- remarks -------------------------------------------------------------------------------------


def _of_concrete(
    asked: Questions, concrete: Sequence[ConcreteAnswer], known: Collection[str], gaps: bool
) -> Iterator[Remark]:
    """Tests that do not show what they claim, or nothing at all; ``gaps``: whether a gap is something.

    A copy whose format cannot say enough claims nothing.
    """
    for x in concrete:
        if x.fault:
            continue
        shown = sorted(x.names - {ENDANGERED, GAP, NOWHERE})
        for claim in x.claims:
            if claim not in known:
                yield Remark((x.entry.id,), f"claims {claim}, {_no_target(claim, asked)}")
            elif claim not in x.names:
                told = f"claims {claim}, and shows {', '.join(shown) or 'no scenario'}"
                yield Remark((x.entry.id,), told + _with_other_values(x) + _nearest(x))
        if not any(gaps or not name.startswith(PREFIX) for name in shown) and not (
            x.claims or x.entry.copy_of
        ):
            yield Remark((x.entry.id,), f"shows no scenario{_of_danger(x)}{_nearest(x)}")


def _nearest(answer: ConcreteAnswer) -> str:
    """The scenario most parts of which hold on a test that shows none."""
    return "" if answer.why is None else f"; {answer.why}"


def _of_danger(answer: ConcreteAnswer) -> str:
    if GAP in answer.names:
        kinds = [x for x in sorted(answer.names) if x.startswith(PREFIX)]
        told = ", though danger comes: a gap, which no scenario covers for any lane and in any roles"
        return f"{told} ({', '.join(kinds)})" if kinds else told
    return ", though danger comes" if ENDANGERED in answer.names else ""


def _with_other_values(answer: ConcreteAnswer) -> str:
    if not answer.others:
        return ""
    return f"; its file has other values of {', '.join(answer.others)} than are asked for"


def _no_target(claim: str, asked: Questions) -> str:
    """Say why a claimed name is none of the targets of this catalogue."""
    number = number_in(claim)
    if number is not None and number in numbers_of(asked.specification):
        return "which is not among the scenarios of this run; add it with --among"
    if number is None and asked.classes is None:
        return "but this run is about scenarios only; classes need a run without --no-classes"
    return "but there is no scenario and no class of that name: classes that are proved empty are left out"


def _why_of_formula(runs: Fact, asked: Questions) -> str:
    """Why the drive of a test with a formula shows no scenario."""
    if runs.drive is None:
        return ""
    vehicles = runs.drive.file.drive.vehicles
    if not any({*roles} <= {*vehicles} for roles in asked.roles):
        needed = " or ".join(", ".join(roles) for roles in asked.roles)
        return f"; it speaks of {', '.join(vehicles)}, and scenarios have {needed}"
    why = why_not(runs.drive.file, runs.drive.file, asked, Freedom())
    return "" if why is None else f"; on the drive that was found: {why}"


def _of_abstract(
    asked: Questions, abstract: Sequence[Abstract], facts: Sequence[Fact], targets: Collection[str]
) -> Iterator[Remark]:
    """Tests that can never be run, show nothing, or show no drive of what they claim."""
    by_test: dict[str, dict[str, Fact]] = {}
    for x in facts:
        by_test.setdefault(x.test, {}).setdefault(x.other, x)
    for entry in abstract:
        known = by_test.get(entry.id, {})
        alone = known.get("")
        if alone is not None and alone.relation == "empty":
            yield Remark((entry.id,), "can never be run: that is proved")
            continue
        if alone is not None and alone.relation == "runs" and not entry.claims and not _says_something(known):
            yield Remark((entry.id,), "shows no scenario" + _why_of_formula(alone, asked))
        for claim in entry.claims:
            if claim not in targets:
                yield Remark((entry.id,), f"claims {claim}, {_no_target(claim, asked)}")
                continue
            fact: Fact | None = known.get(claim)
            if fact is None and alone is not None and claim in alone.also:
                continue
            if fact is None:
                why = (
                    _why_of_formula(alone, asked) if alone is not None and not _says_something(known) else ""
                )
                yield Remark((entry.id,), f"claims {claim}, which no drive of it shows that was found{why}")
            elif fact.relation == "excludes":
                yield Remark((entry.id,), f"claims {claim}, which it excludes: that is proved")


def _says_something(known: Mapping[str, Fact]) -> bool:
    """Whether a test implies a scenario, or may show one."""
    return any(x.relation in ("implies", "shows", "open") for other, x in known.items() if other)


def _doubts(abstract: Sequence[Abstract], facts: Sequence[Fact]) -> Iterator[Remark]:
    """Tests that may never be run, claims neither shown nor excluded, and ends of ranges; other scenarios
    are no matter."""
    claims = {entry.id: entry.claims for entry in abstract}
    for fact in facts:
        if fact.relation == "open" and not fact.test:
            yield Remark((fact.other,), f"how far its drives go is in doubt: {fact.reason}")
        elif fact.relation == "open" and (not fact.other or fact.other in claims[fact.test]):
            what = f"whether it can show {fact.other}" if fact.other else "whether it can be run"
            yield Remark((fact.test,), f"{what} is in doubt: {fact.reason}")


def _contradictions(concrete: Sequence[ConcreteAnswer], facts: Sequence[Fact]) -> Iterator[Remark]:
    tests = [x.entry.id for x in concrete if NOWHERE in x.names]
    tests += [x.test for x in facts if NOWHERE in x.also]
    for test in dict.fromkeys(tests):
        yield Remark((test,), "scenarios hold on it, and no class of them, though that is proved to be")


# --- alike ---------------------------------------------------------------------------------------


_SAME = 1e-6  # m, m/s: samples are rounded


def _same(concrete: Sequence[ConcreteAnswer], near: float) -> Iterator[Remark]:
    """Tests that show the same and begin nearly as the first of them does; copies are not told.

    Tests on different sides of a driver model do not show the same.
    """
    ids = {x.entry.id for x in concrete}
    groups: dict[tuple[frozenset[str], ...], list[list[ConcreteAnswer]]] = {}
    for x in concrete:
        if x.fault or x.entry.copy_of in ids:
            continue
        sides = frozenset(f"{y.scenario} {y.driver} {y.side}" for y in x.decisions)
        known = groups.setdefault((x.names, frozenset(x.begins), sides), [])
        alike = next((those for those in known if _apart(those[0], x) <= near), None)
        if alike is None:
            known.append([x])
        else:
            alike.append(x)
    for first, *others in (those for known in groups.values() for those in known):
        if others:
            apart = max(_apart(first, x) for x in others)
            told = f"begin within {apart:.2g} of the first (m, m/s)" if apart > _SAME else "begin alike"
            yield Remark((first.entry.id, *(x.entry.id for x in others)), f"show the same and {told}")


def _apart(one: ConcreteAnswer, other: ConcreteAnswer) -> float:
    return max((abs(one.begins[name] - other.begins[name]) for name in one.begins), default=0.0)


def _implied(abstract: Sequence[Abstract], facts: Sequence[Fact]) -> Iterator[Remark]:
    ids = {entry.id for entry in abstract}
    pairs = {(x.test, x.other) for x in facts if x.relation == "implies" and x.other in ids}
    for one, other in sorted(pairs):
        if (other, one) not in pairs:
            yield Remark((one, other), "every drive of the first is one of the second: that is proved")
        elif one < other:
            yield Remark((one, other), "have the same drives: that is proved")


# --- how much tests show, in figures ---------------------------------------------------------------

SCENARIOS: Kind = "scenarios"
CLASSES: Kind = "classes"
GAPS: Kind = "classes of gaps"


def kind_of(target: str) -> Kind:
    """What a target other than a class of gaps is, by its name."""
    return CLASSES if number_in(target) is None else SCENARIOS


def figures(set_name: str, targets: Sequence[Target], gaps: TestedGaps) -> tuple[Figure, ...]:
    """The figures of the set that is asked about; classes of gaps where it is known which are empty."""
    found = [*_counted(set_name, {x.name: (x.sector, bool(x.tested)) for x in targets})]
    if gaps.asked:
        tested = sum(bool(x.tested) for x in gaps.targets)
        found.append(Figure(set_name, GAPS, "", tested, len(gaps.targets)))
    return tuple(found)


def figures_beside(
    asked: Questions, concrete: Sequence[ConcreteAnswer], facts: Sequence[Fact]
) -> tuple[Figure, ...]:
    """The figures of another set: what concrete tests show there, and what abstract ones imply there."""
    name, sectors = asked.specification.set_name, sectors_of(asked)
    runs = {x.test for x in facts if x.relation == "runs"}
    shown = {x for answer in concrete for x in answer.names}
    shown |= {
        x.other.removesuffix(f"@{name}") for x in facts if x.relation == "implies" and x.test in runs
        and x.other.endswith(f"@{name}")
    }  # fmt: skip
    targets = {target: (sectors.get(target, ""), target in shown) for target in targets_of(asked)}
    return tuple(_counted(name, targets))


def _counted(set_name: str, targets: dict[str, tuple[str, bool]]) -> Iterator[Figure]:
    for kind in (SCENARIOS, CLASSES):
        those = [x for name, x in targets.items() if kind_of(name) == kind]
        sectors = list(dict.fromkeys(sector for sector, _ in those if sector))
        for sector in ("", *sectors) if those else ():
            here = [tested for place, tested in those if sector in ("", place)]
            yield Figure(set_name, kind, sector, sum(here), len(here))
