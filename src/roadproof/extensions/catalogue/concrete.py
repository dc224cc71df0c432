"""Claims about tests whose vehicles move as they say: what each shows."""

from collections.abc import Mapping
from functools import cached_property

from roadproof.evidence.answer import Judged
from roadproof.evidence.claim import Claim, On, claim_of
from roadproof.extensions.catalogue.abstract import stem_of
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.entries import Concrete, Freedom
from roadproof.extensions.catalogue.showing import ConcreteAnswer, show
from roadproof.extensions.catalogue.traces import digest_of
from roadproof.extensions.traffic.evaluate.decisions import Drivers, content_of
from roadproof.library.elaborate import read_claim
from roadproof.questions.question import Answers, Steps
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class TestJudge:
    """Looks at one test, and asks driver models of it."""

    entry: Concrete
    asked: Questions
    freedom: Freedom
    drivers: Drivers | None

    @property
    def kind(self) -> type[ConcreteAnswer]:
        """What it says."""
        return ConcreteAnswer

    def __call__(self) -> ConcreteAnswer:
        """Return what the test shows."""
        return show(self.entry, self.asked, self.freedom, self.drivers)


@dataclass(frozen=True)
class ConcreteBatch:
    """The claims about some tests, in one spec set."""

    asked: Questions
    freedom: Freedom
    drivers: Drivers | None
    entries: tuple[Concrete, ...]

    @property
    def name(self) -> str:
        """The name of its first claim."""
        return self.named(self.entries[0])

    def named(self, entry: Concrete) -> str:
        """Return the name of the claim about a test."""
        return f"judged-{stem_of(entry.id)}-{self.asked.specification.set_name}"

    def steps(self) -> Steps:
        """Yield a claim for each test."""
        for entry in self.entries:
            yield self.named(entry), self.claim(entry)

    def claim(self, entry: Concrete) -> Claim:
        """Return the claim what a test shows; a test may use any definition, and is told of all spec sets."""
        home = self.asked.specification
        judge = TestJudge(entry, self.asked, self.freedom, self.drivers)
        asked = digest(self._asked, entry)
        mode = On((digest_of(entry.place),), asked, judge)
        return claim_of(home, read_claim(home, "true"), mode, {})

    @cached_property
    def _asked(self) -> str:
        home = self.asked.specification
        read = home.set_name, home.options, self.asked.values, home.library.fingerprint, home.library.titles
        drivers = None if self.drivers is None else content_of(self.drivers)
        asked = self.asked.numbers, self.asked.named, self.freedom, bool(home.library.files)
        return digest(read, asked, drivers)

    def answers(self, known: Answers) -> Mapping[str, ConcreteAnswer]:
        """Return what is known of the tests, by id."""
        found = {x.id: known.get(self.named(x)) for x in self.entries}
        shows = {id: x.evidence.shows for id, x in found.items() if x and isinstance(x.evidence, Judged)}
        return {id: x for id, x in shows.items() if isinstance(x, ConcreteAnswer)}
