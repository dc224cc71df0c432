"""Ranges of initial values of drives that show a target, and the part of each that no test covers.

Drives that a search finds within limits show how far a value can go; nothing is claimed beyond them. Values
between tests count as covered.
"""

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import get_args

from roadproof.engines.search.placing import judge_as
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.initial_values import signal_of
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.surveys.extremes.extreme import PROOF, ExtremeQuestion, ExtremeSearch
from roadproof.extensions.surveys.extremes.measure import Sense, read_measure
from roadproof.extensions.surveys.extremes.points import ClaimGenerator, JudgementCache, Points
from roadproof.library.compose import both
from roadproof.library.elaborate import read_term
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.reasons import NO_REASON, ReasonKind
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.world.units import unit_text

EFFORT = 6.0
"""The most units of work for one search."""
_PRECISION = {"s": Fraction(2), "d": Fraction(1, 4), "v_lon": Fraction(1)}  # m, m, m/s


@dataclass(frozen=True)
class Reach:
    """The search for the range of ``term`` at the start of drives of ``query``, which show ``target``.

    ``known``: drives of tests that show it.
    """

    target: str
    term: str
    query: Query
    known: tuple[JudgedDrive, ...] = ()


@dataclass(frozen=True)
class InitialValueRange:
    """The range of an initial value of drives that show ``target``: of tests, and of all drives.

    ``tested`` and ``reached``: least and greatest value, in ``unit``. ``beyond``: the reasons why the search
    found no drive with a lower or with a higher value.
    """

    target: str
    term: str
    unit: str
    tested: tuple[float, float]
    reached: tuple[float, float]
    beyond: tuple[str, str]

    @property
    def untested(self) -> tuple[tuple[float, float], ...]:
        """The parts of the range below and above all tests."""
        (low, high), (least, greatest) = self.tested, self.reached
        parts = ((least, low), (high, greatest))
        return tuple(part for part in parts if part[0] < part[1])

    @property
    def share(self) -> float:
        """The untested share of the range, from 0 to 1."""
        width = self.reached[1] - self.reached[0]
        return sum(high - low for low, high in self.untested) / width if width else 0.0


@dataclass(frozen=True)
class ReachBatch:
    """The claims about both ends of a range."""

    basis: Basis
    reach: Reach

    @property
    def name(self) -> str:
        """The stem of the names of its claims."""
        return f"range-{self.reach.target}-{digest(self.reach.term)[:6]}"

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        effort = self.basis.effort
        return Work(effort.with_units(min(effort.units, EFFORT)), PROOF, staged=True, moves=False)

    @property
    def seeds(self) -> tuple[JudgedDrive, ...]:
        """The drives of tests that show the target."""
        return self.reach.known

    def steps(self) -> Generator[tuple[str, Claim], ClaimAnswer, None]:
        """Yield each claim, and be sent its answer."""
        yield from self.facts()

    def facts(self) -> ClaimGenerator[tuple[CatalogueFact, ...]]:
        """Claim a drive at each end of the range, and return a fact about each."""
        facts: list[CatalogueFact] = []
        for sense in get_args(Sense):
            facts.append((yield from self._end(sense)))
        return tuple(facts)

    def _end(self, sense: Sense) -> ClaimGenerator[CatalogueFact]:
        """Search for the drive with the least or greatest value, and return the fact."""
        reach, home = self.reach, self.basis.specification
        measure = read_measure(home, sense, reach.term, given=reach.query.claim.given)
        fact = CatalogueFact("", reach.target, "open", reach.query, term=reach.term, sense=sense)
        search = self.basis.search(reach.query, effort=self.work.effort)
        precision = _PRECISION[signal_of(reach.term)]
        question = ExtremeQuestion(f"{self.name}-{sense}", search, measure, precision)
        extreme = yield from ExtremeSearch(question, Points(JudgementCache())).run(reach.known)
        beyond = NO_REASON if extreme.outside is None else extreme.outside.reason
        if extreme.best is None:
            return replace(fact, reason=ReasonKind.EXTREME(sense, reach.term, beyond))
        [value] = extreme.best.at
        bound = both(*measure.bound(value))
        made = replace(fact, relation="reaches", conclusion=bound, reason=beyond, at=value)
        return replace(made, drive=extreme.best.drive, name=extreme.best.name, answer=extreme.best.answer)


def ranges_of(
    specification: Specification,
    targets: Mapping[str, Mapping[str, tuple[float, float]]],
    facts: Sequence[CatalogueFact],
) -> list[InitialValueRange]:
    """Return the ranges whose ends are both known; ``targets``: by name and term, the range of tests."""
    ends: dict[tuple[str, str], dict[str, CatalogueFact]] = {}
    for fact in facts:
        if fact.relation == "reaches":
            ends.setdefault((fact.other, fact.term), {})[fact.sense] = fact
    return [
        _range_of(name, term, unit_text(read_term(specification, term)[1]), tested, ends[name, term])
        for name, covered in targets.items()
        for term, tested in covered.items()
        if len(ends.get((name, term), {})) == 2
    ]


def _range_of(
    target: str, term: str, unit: str, tested: tuple[float, float], ends: Mapping[str, CatalogueFact]
) -> InitialValueRange:
    """Return a range with the values of tests, which may go farther than the drives of the search."""
    low, high = (ends[sense] for sense in ("least", "greatest"))
    reached = min(float(low.at or 0), tested[0]), max(float(high.at or 0), tested[1])
    return InitialValueRange(target, term, unit, tested, reached, (low.reason, high.reason))


def reaches_of(
    formulas: TargetFormulas,
    targets: Mapping[str, Mapping[str, tuple[float, float]]],
    concrete: Sequence[ConcreteAnswer],
) -> Iterator[Reach]:
    """Yield a search for each initial value of each target that tests show."""
    for name, covered in targets.items():
        query = formulas.query_of(name)
        known = tuple(_known(formulas, name, query, covered, concrete)) if covered else ()
        yield from (Reach(name, term, query, known) for term in covered)


def _known(
    formulas: TargetFormulas,
    name: str,
    query: Query,
    covered: Mapping[str, tuple[float, float]],
    concrete: Sequence[ConcreteAnswer],
) -> Iterator[JudgedDrive]:
    """Yield the drives of tests that have a least or greatest value among tests."""
    home = formulas.specification
    for x in concrete:
        at_end = any(x.begins.get(term) in ends for term, ends in covered.items())
        if x.dense and name in x.names and at_end:
            here = replace(load_drive(Path(x.entry.place)), set_name=home.set_name)
            judged = judge_as(here, query, home.library)
            yield from () if judged is None else (judged,)
