"""Remarks on tests: mislabelled and unreadable ones, open claims, duplicates, and contradictions."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from roadproof.extensions.catalogue.catalogue_data import Remark, TargetData
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.drive_targets import nearest_on_drive
from roadproof.extensions.catalogue.entries import AbstractTest, Freedom
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, GAP, NO_CLASS, TargetFormulas
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.library.scenarios import number_in, numbers_of

# --- faults --------------------------------------------------------------------------------------


def fault_remarks(
    formulas: TargetFormulas,
    concrete: Sequence[ConcreteAnswer],
    abstract: Sequence[AbstractTest],
    facts: Sequence[CatalogueFact],
    known: Collection[str],
    gaps: bool,
) -> tuple[Remark, ...]:
    """Return a remark on each test that is unreadable, rejected or mislabelled, or shows nothing.

    ``known``: the names of all targets; ``gaps``: whether gaps are required. Claims of tests are about
    scenarios without a driver model, so they are not compared where one says how scenarios begin.
    """
    is_restricted = restriction_of(formulas.specification.options) is not None
    claimed = (
        ()
        if is_restricted
        else (*_of_concrete(formulas, concrete, known, gaps), *_of_abstract(formulas, abstract, facts, known))
    )
    unreadable = (Remark((x.entry.id,), f"cannot be read: {x.fault}") for x in concrete if x.fault)
    # Drive files whose own formula is false on the drive with the file's own values.
    rejected = (Remark((x.entry.id,), f"its file is rejected: {x.rejected}") for x in concrete if x.rejected)
    return (*unreadable, *rejected, *claimed)


def _of_concrete(
    formulas: TargetFormulas, concrete: Sequence[ConcreteAnswer], known: Collection[str], gaps: bool
) -> Iterator[Remark]:
    """Yield a remark for each claim that a concrete test does not show, and for each test that shows nothing.

    ``gaps``: whether a gap counts. A copy in a format that lacks information claims nothing.
    """
    for x in concrete:
        if x.fault:
            continue
        shown = sorted(x.names - {ENDANGERED, GAP, NO_CLASS})
        for claim in x.claims:
            if claim not in known:
                yield Remark((x.entry.id,), f"claims {claim}, {_no_target(claim, formulas)}")
            elif claim not in x.names:
                text = f"claims {claim}, and shows {', '.join(shown) or 'no scenario'}"
                yield Remark((x.entry.id,), text + _with_other_values(x) + _nearest(x))
        if not any(gaps or not name.startswith(PREFIX) for name in shown) and not (
            x.claims or x.entry.copy_of
        ):
            yield Remark((x.entry.id,), f"shows no scenario{_of_danger(x)}{_nearest(x)}")


def _nearest(answer: ConcreteAnswer) -> str:
    """Return the text about the nearest scenario of a test that shows none."""
    return "" if answer.why is None else f"; {answer.why}"


def _of_danger(answer: ConcreteAnswer) -> str:
    if GAP in answer.names:
        classes = [x for x in sorted(answer.names) if x.startswith(PREFIX)]
        text = ", though danger comes: a gap, which no scenario covers for any lane and in any roles"
        return f"{text} ({', '.join(classes)})" if classes else text
    return ", though danger comes" if ENDANGERED in answer.names else ""


def _with_other_values(answer: ConcreteAnswer) -> str:
    if not answer.others:
        return ""
    return f"; its file has other values of {', '.join(answer.others)} than are asked for"


def _no_target(claim: str, formulas: TargetFormulas) -> str:
    """Return why a claimed name is none of the targets of this catalogue."""
    number = number_in(claim)
    if number is not None and number in numbers_of(formulas.specification):
        return "which is not among the scenarios of this run; add it with --among"
    if number is None and formulas.classes is None:
        return "but this run is about scenarios only; classes need a run without --no-classes"
    return "but there is no scenario and no class of that name: classes that are proved empty are left out"


def _why_of_formula(runs: CatalogueFact, formulas: TargetFormulas) -> str:
    """Return why the drive of a test with a formula shows no scenario."""
    if runs.drive is None:
        return ""
    vehicles = runs.drive.file.drive.vehicles
    if not any({*roles} <= {*vehicles} for roles in formulas.roles):
        needed = " or ".join(", ".join(roles) for roles in formulas.roles)
        return f"; it speaks of {', '.join(vehicles)}, and scenarios have {needed}"
    why = nearest_on_drive(runs.drive.file, runs.drive.file, formulas, Freedom())
    return "" if why is None else f"; on the drive that was found: {why}"


def _of_abstract(
    formulas: TargetFormulas,
    abstract: Sequence[AbstractTest],
    facts: Sequence[CatalogueFact],
    targets: Collection[str],
) -> Iterator[Remark]:
    """Yield a remark on each test that can never be run, shows nothing, or has no drive for its claim.

    ``targets``: the names of all targets.
    """
    by_test: dict[str, dict[str, CatalogueFact]] = {}
    for x in facts:
        by_test.setdefault(x.test, {}).setdefault(x.other, x)
    for entry in abstract:
        of_test = by_test.get(entry.id, {})
        alone = of_test.get("")
        if alone is not None and alone.relation == "empty":
            yield Remark((entry.id,), "can never be run: that is proved")
            continue
        if alone is not None and alone.relation == "runs" and not entry.claims and not _may_show_any(of_test):
            yield Remark((entry.id,), "shows no scenario" + _why_of_formula(alone, formulas))
        for claim in entry.claims:
            if claim not in targets:
                yield Remark((entry.id,), f"claims {claim}, {_no_target(claim, formulas)}")
                continue
            fact: CatalogueFact | None = of_test.get(claim)
            if fact is None and alone is not None and claim in alone.also:
                continue
            if fact is None:
                is_silent = alone is not None and not _may_show_any(of_test)
                why = _why_of_formula(alone, formulas) if alone is not None and is_silent else ""
                yield Remark((entry.id,), f"claims {claim}, which no drive of it shows that was found{why}")
            elif fact.relation == "excludes":
                yield Remark((entry.id,), f"claims {claim}, which it excludes: that is proved")


def _may_show_any(facts: Mapping[str, CatalogueFact]) -> bool:
    """Return whether a test implies a scenario, or may show one; ``facts``: those of the test by name."""
    return any(x.relation in ("implies", "shows", "open") for other, x in facts.items() if other)


# --- open claims, contradictions -----------------------------------------------------------------


def open_remarks(
    abstract: Sequence[AbstractTest], facts: Sequence[CatalogueFact], open_gaps: Mapping[str, str]
) -> tuple[Remark, ...]:
    """Return a remark on each open claim of a test, each open end of a range, and each open class of gaps.

    ``open_gaps``: the reason by class.
    """
    gaps = (
        Remark((name,), f"whether there is such a gap is in doubt: {reason}")
        for name, reason in open_gaps.items()
    )
    return (*_open_facts(abstract, facts), *gaps)


def _open_facts(abstract: Sequence[AbstractTest], facts: Sequence[CatalogueFact]) -> Iterator[Remark]:
    """Yield a remark on each open fact about a test alone, a target that it claims, or a range."""
    claims = {entry.id: entry.claims for entry in abstract}
    for fact in facts:
        if fact.relation == "open" and not fact.test:
            yield Remark((fact.other,), f"how far its drives go is in doubt: {fact.reason}")
        elif fact.relation == "open" and (not fact.other or fact.other in claims[fact.test]):
            what = f"whether it can show {fact.other}" if fact.other else "whether it can be run"
            yield Remark((fact.test,), f"{what} is in doubt: {fact.reason}")


def contradiction_remarks(
    concrete: Sequence[ConcreteAnswer], facts: Sequence[CatalogueFact], empty: Sequence[TargetData]
) -> tuple[Remark, ...]:
    """Return a remark on each test that shows a class that is proved empty; ``empty``: classes of gaps."""
    return (*_without_class(concrete, facts), *_shown_though_empty(empty))


def _without_class(concrete: Sequence[ConcreteAnswer], facts: Sequence[CatalogueFact]) -> Iterator[Remark]:
    tests = [x.entry.id for x in concrete if NO_CLASS in x.names]
    tests += [x.test for x in facts if NO_CLASS in x.also]
    for test in dict.fromkeys(tests):
        yield Remark((test,), "scenarios hold on it, and no class of them, though that is proved to be")


def _shown_though_empty(empty: Sequence[TargetData]) -> Iterator[Remark]:
    for target in empty:
        for test in (*target.tested, *target.possible):
            yield Remark((test,), f"shows {target.name}, though that is proved to be empty")


# --- duplicates ----------------------------------------------------------------------------------


_ROUNDING = 1e-6  # m, m/s: samples are rounded


def duplicate_remarks(
    concrete: Sequence[ConcreteAnswer],
    abstract: Sequence[AbstractTest],
    facts: Sequence[CatalogueFact],
    near: float,
) -> tuple[Remark, ...]:
    """Return a remark on each group of concrete duplicates, and on each pair of tests of which one implies
    the other; ``near``: largest difference of initial states (m, m/s).
    """
    return (*_duplicates(concrete, near), *_implied_tests(abstract, facts))


def _duplicates(concrete: Sequence[ConcreteAnswer], near: float) -> Iterator[Remark]:
    """Yield a remark on tests that show the same and begin ``near`` the first of them, without copies.

    Tests on different sides of a driver model do not show the same.
    """
    ids = {x.entry.id for x in concrete}
    groups: dict[tuple[frozenset[str], ...], list[list[ConcreteAnswer]]] = {}
    for x in concrete:
        if x.fault or x.entry.copy_of in ids:
            continue
        sides = frozenset(f"{y.scenario} {y.driver} {y.side}" for y in x.decisions)
        clusters = groups.setdefault((x.names, frozenset(x.begins), sides), [])
        cluster = next((those for those in clusters if _difference(those[0], x) <= near), None)
        if cluster is None:
            clusters.append([x])
        else:
            cluster.append(x)
    for first, *others in (cluster for clusters in groups.values() for cluster in clusters):
        if others:
            apart = max(_difference(first, x) for x in others)
            text = (
                f"starts within {apart:.2g} (m, m/s) of the first" if apart > _ROUNDING else "the same start"
            )
            yield Remark((first.entry.id, *(x.entry.id for x in others)), f"the same verdicts and {text}")


def _difference(one: ConcreteAnswer, other: ConcreteAnswer) -> float:
    """Return the largest difference of two initial values of the same name (m, m/s)."""
    return max((abs(one.begins[name] - other.begins[name]) for name in one.begins), default=0.0)


def _implied_tests(abstract: Sequence[AbstractTest], facts: Sequence[CatalogueFact]) -> Iterator[Remark]:
    ids = {entry.id for entry in abstract}
    pairs = {(x.test, x.other) for x in facts if x.relation == "implies" and x.other in ids}
    for one, other in sorted(pairs):
        if (other, one) not in pairs:
            yield Remark((one, other), "every drive of the first is one of the second: that is proved")
        elif one < other:
            yield Remark((one, other), "have the same drives: that is proved")
