"""The tests of a request, read and judged: what concrete ones show, and what is to be asked of the others."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.decisions import Drivers
from roadproof.analysis.catalogue.earlier import EarlierAnswers
from roadproof.analysis.catalogue.entries import Abstract, Catalogue, Concrete, Freedom, Request
from roadproof.analysis.catalogue.gaps import PREFIX, gap_kinds
from roadproof.analysis.catalogue.meaning import Meanings
from roadproof.analysis.catalogue.ranges import Reach, reaches_of
from roadproof.analysis.catalogue.reading import read_catalogue
from roadproof.analysis.catalogue.showing import ConcreteAnswer, show
from roadproof.analysis.catalogue.tested import CLASSES, SCENARIOS, kind_of, targets_of, tested
from roadproof.analysis.classify.classes import Classes, plan_of
from roadproof.analysis.classify.divide import divide
from roadproof.analysis.study import pool
from roadproof.analysis.study.pool import Progress
from roadproof.drivers.restriction import restriction_of, said_in, unrestricted
from roadproof.errors import RoadproofError, UsageError
from roadproof.library.specification import Specification
from roadproof.runtime.executors import Jobs, is_fork_unsafe

BATCH = 20


@dataclass(frozen=True)
class Examination:
    """The tests of a ``request``; ``study`` asks what abstract ones mean.

    ``concrete``: what concrete ones show; ``beside``: that in further spec sets, as ``study.beside``.
    ``drivers``: the models that are asked what becomes of them. ``known``: how many concrete ones were judged
    in earlier runs.
    """

    request: Request
    tests: Catalogue
    study: Meanings
    concrete: tuple[ConcreteAnswer, ...]
    beside: tuple[tuple[ConcreteAnswer, ...], ...]
    drivers: Drivers | None = None
    known: int = 0


def examine(
    request: Request,
    basis: Basis,
    numbers: tuple[int, ...],
    plain: Specification,
    drivers: Drivers | None = None,
    jobs: Jobs = None,
    progress: Progress | None = None,
    fresh: bool = False,
) -> Examination:
    """Read the tests and judge the concrete ones, of the scenarios of these ``numbers``.

    ``plain``: the definitions in which formulas of tests are read, whatever ``basis`` says of how scenarios
    begin; ``drivers``: those that are asked. Tests that earlier runs have judged are judged again where
    ``fresh``. Raises ``InputError``, ``TextError``, ``UsageError``.
    """
    home = basis.specification
    tests = _read(request, unrestricted(plain), home)
    kinds = gap_kinds(basis, numbers) if request.gaps else None

    def ask(set_name: str) -> Questions:
        here = replace(basis, specification=home.in_set(set_name), sets=())
        made = _divided(here, numbers, jobs, progress, fresh) if request.classes else None
        return Questions(here.specification, numbers, made, basis.all_values())

    asked, *others = (ask(name) for name in request.sets)
    concrete = tuple(x for x in tests.entries if isinstance(x, Concrete))
    earlier = [EarlierAnswers(asked, request.freedom, drivers)]
    beside_drivers = None if restriction_of(home.options) is None else drivers
    earlier += [EarlierAnswers(other, request.freedom, beside_drivers) for other in others]
    known = [{} if fresh else x.of(concrete) for x in earlier]
    judged = zip(earlier, known, strict=True)
    answers, *beside = (_shown(concrete, x, found, jobs, progress) for x, found in judged)
    abstract = tuple(x for x in tests.entries if isinstance(x, Abstract))
    shown = frozenset(x for answer in answers for x in answer.names if x.startswith(PREFIX))
    reaches = tuple(_reaches(asked, answers)) if request.explore else ()
    both_sides = drivers if restriction_of(home.options) is None else None
    study = Meanings(basis, abstract, asked, tuple(others), kinds, shown, reaches, both_sides)
    return Examination(request, tests, study, answers, tuple(beside), drivers, len(known[0]))


def _read(request: Request, plain: Specification, asked: Specification) -> Catalogue:
    """The tests as the library says them, whatever the scenarios are that are ``asked`` about."""
    tests = read_catalogue(request.paths, plain, request.strict)
    if plain is asked:
        return tests
    entries = tuple(
        replace(x, query=said_in(x.query, plain, asked)) if isinstance(x, Abstract) else x
        for x in tests.entries
    )
    return replace(tests, entries=entries)


def _reaches(asked: Questions, concrete: Sequence[ConcreteAnswer]) -> Iterator[Reach]:
    """How far drives can go of the classes that concrete tests show; of scenarios, where there are none."""
    found = tested(asked, concrete, (), (), targets_of(asked), 0.0, None).targets
    kind = SCENARIOS if asked.classes is None else CLASSES
    return reaches_of(asked, {x.name: x.covered for x in found if kind_of(x.name) == kind}, concrete)


def _divided(
    basis: Basis, numbers: tuple[int, ...], jobs: Jobs, progress: Progress | None, fresh: bool
) -> Classes | None:
    """The classes of scenarios. Raises ``UsageError`` where it is in doubt which there are."""
    try:
        plan = plan_of(basis.specification, numbers)
    except RoadproofError as error:
        raise UsageError(f"{error}; or leave out classes with --no-classes") from None
    division = divide(basis, plan, jobs, progress, in_few_words=False, fresh=fresh)
    if division.cut_off:
        told = "; ".join(x.reason for x in division.doubts)
        raise UsageError(f"the classes are in doubt ({told}): give more work, or use --no-classes")
    return division.classes


def _shown(
    entries: Sequence[Concrete],
    earlier: EarlierAnswers,
    known: Mapping[str, ConcreteAnswer],
    jobs: Jobs,
    progress: Progress | None,
) -> tuple[ConcreteAnswer, ...]:
    """The answers to all tests in order: ``known`` ones by the id of the test, the others judged and kept."""
    left = [x for x in entries if x.id not in known]
    batches = [left[k : k + BATCH] for k in range(0, len(left), BATCH)]
    judge_batch = partial(_batch, earlier.asked, earlier.freedom, earlier.drivers)
    fresh = is_fork_unsafe()  # tests can be tables
    done = pool.work(judge_batch, batches, jobs, None, progress, "batches of tests", fresh=fresh)
    made = [answer for answers in pool.in_order(done) for answer in answers]
    earlier.keep(made)
    every = {**known, **{x.entry.id: x for x in made}}
    return tuple(every[x.id] for x in entries)


def _batch(
    asked: Questions, freedom: Freedom, drivers: Drivers | None, entries: Sequence[Concrete]
) -> list[ConcreteAnswer]:
    return [show(entry, asked, freedom, drivers) for entry in entries]
