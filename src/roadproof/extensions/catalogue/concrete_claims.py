"""Claims about concrete tests: the targets that each shows."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Final

from roadproof.evidence.answer import JudgedTrace
from roadproof.evidence.claim import Claim, On, claim_of
from roadproof.extension import entries
from roadproof.extensions.catalogue.abstract_claims import claim_stem
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.judge_test import judge_test
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.catalogue.traces import digest_of
from roadproof.extensions.drivers.models import entry_of
from roadproof.extensions.traffic.evaluate.decisions import Drivers, content_of
from roadproof.library.elaborate import read_claim
from roadproof.questions.question import Answers, Steps
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass

JUDGED: Final = "judged-"
"""The prefix of names of claims about concrete tests."""


@dataclass(frozen=True)
class TestJudge:
    """The judgement of one test in a spec set, with driver models."""

    entry: ConcreteTest
    formulas: TargetFormulas
    freedom: Freedom
    drivers: Drivers | None

    @property
    def kind(self) -> type[ConcreteAnswer]:
        """The class of the answer."""
        return ConcreteAnswer

    @property
    def relies_on(self) -> tuple[str, ...]:
        """The entries of the driver models, and of the reader of the file of the test."""
        suffix = Path(self.entry.place).suffix
        readers = (entries(slot).get(suffix) for slot in ("traces", "drives"))
        models = () if self.drivers is None else self.drivers.models
        return (*map(entry_of, models), *(x for x in readers if x is not None))

    def __call__(self) -> ConcreteAnswer:
        """Return the answer about the test."""
        return judge_test(self.entry, self.formulas, self.freedom, self.drivers)


def judged_name(test: str, set_name: str) -> str:
    """Return the name of the claim about a concrete test in a spec set."""
    return f"{JUDGED}{claim_stem(test)}-{set_name}"


@dataclass(frozen=True)
class ConcreteBatch:
    """The claims about some tests, in one spec set."""

    formulas: TargetFormulas
    freedom: Freedom
    drivers: Drivers | None
    entries: tuple[ConcreteTest, ...]

    @property
    def name(self) -> str:
        """The name of its first claim."""
        return self.claim_name(self.entries[0])

    def claim_name(self, entry: ConcreteTest) -> str:
        """Return the name of the claim about a test."""
        return judged_name(entry.id, self.formulas.specification.set_name)

    def steps(self) -> Steps:
        """Yield a claim for each test."""
        for entry in self.entries:
            yield self.claim_name(entry), self.claim(entry)

    def claim(self, entry: ConcreteTest) -> Claim:
        """Return the claim about the targets of a test, with definitions of all spec sets.

        A driver model may use any definition, and notes name other spec sets.
        """
        home = self.formulas.specification
        judge = TestJudge(entry, self.formulas, self.freedom, self.drivers)
        question = digest(self._question, entry)
        mode = On((digest_of(entry.place),), question, judge)
        return claim_of(home, read_claim(home, "true"), mode, {})

    @cached_property
    def _question(self) -> str:
        """The digest of all on which answers depend beside the test."""
        home = self.formulas.specification
        read = (
            home.set_name,
            home.options,
            self.formulas.values,
            home.library.fingerprint,
            home.library.titles,
        )
        drivers = None if self.drivers is None else content_of(self.drivers)
        formulas = self.formulas.numbers, self.formulas.class_names, self.freedom, bool(home.library.files)
        return digest(read, formulas, drivers)

    def answers(self, known: Answers) -> Mapping[str, ConcreteAnswer]:
        """Return the known answers about the tests, by id."""
        claims = {x.id: known.get(self.claim_name(x)) for x in self.entries}
        shows = {
            id: x.evidence.shows for id, x in claims.items() if x and isinstance(x.evidence, JudgedTrace)
        }
        return {id: x for id, x in shows.items() if isinstance(x, ConcreteAnswer)}
