"""How drives that show a target can begin, and how tests of it begin: what part of the range nobody tests.

How far a number can go is what drives show that were looked for, within limits; nothing is claimed of what
lies beyond them, nor of values between tests, which are taken as covered.
"""

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import get_args

from roadproof.engines.search.placing import judged_as
from roadproof.evidence.answer import Answer
from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.fact import Fact
from roadproof.extensions.catalogue.showing import ConcreteAnswer, signal_of
from roadproof.extensions.surveys.extremes.extreme import PROOF, ExtremeQuestion, ExtremeSearch
from roadproof.extensions.surveys.extremes.measure import Sense, read_measure
from roadproof.extensions.surveys.extremes.points import Asking, Points, Remembered
from roadproof.library.compose import both
from roadproof.library.elaborate import read_term
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.reasons import NO_REASON, Why
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.world.units import unit_text

EFFORT = 6.0
"""Most units of work for one search."""
_PRECISION = {"s": Fraction(2), "d": Fraction(1, 4), "v_lon": Fraction(1)}  # m, m, m/s


@dataclass(frozen=True)
class Reach:
    """How far can ``term`` go at the start of drives of ``query``, which show ``target``?

    ``known``: drives of tests that do.
    """

    target: str
    term: str
    query: Query
    known: tuple[JudgedDrive, ...] = ()


@dataclass(frozen=True)
class Span:
    """Of one number at the start of drives that show ``target``: where tests are, and how far drives go.

    Low and high, in ``unit``. ``beyond``: what is known of lower and of higher values.
    """

    target: str
    term: str
    unit: str
    tested: tuple[float, float]
    reached: tuple[float, float]
    beyond: tuple[str, str]

    @property
    def untested(self) -> tuple[tuple[float, float], ...]:
        """The parts of the range that no test is in or between."""
        (low, high), (least, greatest) = self.tested, self.reached
        parts = ((least, low), (high, greatest))
        return tuple(part for part in parts if part[0] < part[1])

    @property
    def share(self) -> float:
        """How much of the range that is."""
        width = self.reached[1] - self.reached[0]
        return sum(high - low for low, high in self.untested) / width if width else 0.0


@dataclass(frozen=True)
class ReachBatch:
    """The claims about both ends of a range."""

    basis: Basis
    reach: Reach

    @property
    def name(self) -> str:
        """How the names of its claims begin."""
        return f"range-{self.reach.target}-{digest(self.reach.term)[:6]}"

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        effort = self.basis.effort
        return Work(effort.of(min(effort.units, EFFORT)), PROOF, staged=True, moves=False)

    @property
    def seeds(self) -> tuple[JudgedDrive, ...]:
        """The drives of tests that show the target."""
        return self.reach.known

    def steps(self) -> Generator[tuple[str, Claim], Answer, None]:
        """Yield each claim, and be sent its answer."""
        yield from self.facts()

    def facts(self) -> Asking[tuple[Fact, ...]]:
        """Ask for a drive at each end of the range, and return it, or why there is none."""
        facts: list[Fact] = []
        for sense in get_args(Sense):
            facts.append((yield from self._end(sense)))
        return tuple(facts)

    def _end(self, sense: Sense) -> Asking[Fact]:
        reach, home = self.reach, self.basis.specification
        measure = read_measure(home, sense, reach.term, given=reach.query.claim.given)
        fact = Fact("", reach.target, "open", reach.query, term=reach.term, sense=sense)
        search = self.basis.search(reach.query, effort=self.work.effort)
        precision = _PRECISION[signal_of(reach.term)]
        asked = ExtremeQuestion(f"{self.name}-{sense}", search, measure, precision)
        found = yield from ExtremeSearch(asked, Points(Remembered())).run(reach.known)
        beyond = NO_REASON if found.missed is None else found.missed.reason
        if found.best is None:
            return replace(fact, reason=Why.EXTREME(sense, reach.term, beyond))
        [value] = found.best.at
        bound = both(*measure.bound(value))
        made = replace(fact, relation="reaches", conclusion=bound, reason=beyond, at=value)
        return replace(made, drive=found.best.drive, name=found.best.name, answer=found.best.answer)


def spans_of(
    specification: Specification,
    targets: Mapping[str, Mapping[str, tuple[float, float]]],
    facts: Sequence[Fact],
) -> list[Span]:
    """The ranges of targets whose both ends are known; ``targets``: by name and number where tests are."""
    ends: dict[tuple[str, str], dict[str, Fact]] = {}
    for fact in facts:
        if fact.relation == "reaches":
            ends.setdefault((fact.other, fact.term), {})[fact.sense] = fact
    return [
        _span(name, term, unit_text(read_term(specification, term)[1]), tested, ends[name, term])
        for name, covered in targets.items()
        for term, tested in covered.items()
        if len(ends.get((name, term), {})) == 2
    ]


def _span(target: str, term: str, unit: str, tested: tuple[float, float], ends: Mapping[str, Fact]) -> Span:
    """With the values of tests, which may go farther than the drives that were looked for."""
    low, high = (ends[sense] for sense in ("least", "greatest"))
    reached = min(float(low.at or 0), tested[0]), max(float(high.at or 0), tested[1])
    return Span(target, term, unit, tested, reached, (low.reason, high.reason))


def reaches_of(
    asked: Questions,
    targets: Mapping[str, Mapping[str, tuple[float, float]]],
    concrete: Sequence[ConcreteAnswer],
) -> Iterator[Reach]:
    """What is to be asked of targets that tests show: each number of how these begin."""
    for name, covered in targets.items():
        query = asked.query_of(name)
        known = tuple(_known(asked, name, query, covered, concrete)) if covered else ()
        yield from (Reach(name, term, query, known) for term in covered)


def _known(
    asked: Questions,
    name: str,
    query: Query,
    covered: Mapping[str, tuple[float, float]],
    concrete: Sequence[ConcreteAnswer],
) -> Iterator[JudgedDrive]:
    """The drives among tests that are at the ends of where tests are."""
    home = asked.specification
    for x in concrete:
        at_end = any(x.begins.get(term) in ends for term, ends in covered.items())
        if x.dense and name in x.names and at_end:
            here = replace(load_drive(Path(x.entry.place)), set_name=home.set_name)
            judged = judged_as(here, query, home.library)
            yield from () if judged is None else (judged,)
