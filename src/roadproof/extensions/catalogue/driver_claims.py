"""Claims about the drives of a test in which a driver model drives SV, such as that they end in a collision.

The drive is made again from the test whenever claims are listed, so evidence has to be that very drive.
"""

from collections.abc import Iterable, Iterator
from dataclasses import field, replace
from pathlib import Path

from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.catalogue.abstract_claims import claim_stem
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.drive_targets import decisions_on
from roadproof.extensions.traffic.evaluate.decisions import Decision, DrivenTest, Drivers
from roadproof.library.elaborate import read_claim
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Steps
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict
from roadproof.world.road import Road


def driver_claim_name(test: str, decision: Decision) -> str:
    """Return the name of the claim about a test under a driver model."""
    about = digest(test, decision.scenario, decision.vehicles, decision.driver)[:6]
    return f"driven-{claim_stem(test)}-{decision.scenario}-{decision.driver}-{about}"


@dataclass(frozen=True)
class DriverBatch:
    """The claims about a test that is a drive: one for each scenario that it shows and each driver model."""

    basis: Basis
    drivers: Drivers
    answer: ConcreteAnswer
    made: list[tuple[Road, dict[str, DrivenTest]]] = field(default_factory=list, compare=False, repr=False)

    @property
    def name(self) -> str:
        """The stem of the names of its claims."""
        return f"driven-{claim_stem(self.answer.entry.id)}"

    def steps(self) -> Steps:
        """Yield a claim for each decision that rests on a drive."""
        road, drives = self._drives()
        for name, driven in drives.items():
            yield name, self._claim(road, driven)

    def _drives(self) -> tuple[Road, dict[str, DrivenTest]]:
        """Return the road of the test, and the drives by the names of their claims; they are made once."""
        if not self.made:
            file = load_drive(Path(self.answer.entry.place))
            decisions = decisions_on(file, self.answer.shown, self.drivers)
            names = ((driver_claim_name(self.answer.entry.id, x), x.driven) for x in decisions)
            self.made.append((file.road, {name: x for name, x in names if x is not None}))
        return self.made[0]

    def _claim(self, road: Road, driven: DrivenTest) -> Claim:
        home = self.basis.specification
        mode = Exists(road=road, horizon=driven.rests, collisions=True, explain=False, like=driven.drive)
        return claim_of(home, read_claim(home, driven.formula), mode, {})


def driver_batches(basis: Basis, drivers: Drivers, tests: Iterable[ConcreteAnswer]) -> Iterator[DriverBatch]:
    """Yield a batch for each test that is an existing drive file on which a model decides something."""
    for x in tests:
        decides = any(decision.side != "not covered" for decision in x.decisions)
        if x.dense and decides and not x.fault and Path(x.entry.place).is_file():
            yield DriverBatch(basis, drivers, x)


def confirmed_decision(test: str, decision: Decision, known: Answers) -> Decision:
    """Return a decision, undecided where the drive on which it rests is not accepted."""
    answer = known.get(driver_claim_name(test, decision))
    if answer is None or answer.verdict is Verdict.WITNESSED:
        return decision
    without_values = replace(decision, gap=None, instant=None, speed=None)
    return replace(without_values, side="undecided", reason=answer.reason)
