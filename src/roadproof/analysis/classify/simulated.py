"""The shares of classes in a simulated recording, as an answer that can be known before it is asked for."""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar, TypeAlias

from roadproof.analysis.basis import Basis
from roadproof.analysis.classify.classes import Classes
from roadproof.analysis.classify.shares import Shares, count_shares
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared, conduct
from roadproof.evidence.codec import Doc
from roadproof.evidence.strict import JsonObject
from roadproof.library.scenarios import Scenario, applied
from roadproof.reasons import Reason
from roadproof.recordings.simulate.simulate import simulate
from roadproof.recordings.simulate.traffic import Traffic

SCHEMA = "roadproof/shares/1"
SECONDS, SEED = 600.0, 1
NAME = "shares"
Count: TypeAlias = tuple[str, int]


@dataclass(frozen=True)
class SharesRecord:
    """``Shares`` as they are kept, counts in the order in which they were met."""

    recordings: Annotated[tuple[str, ...], Doc("What was counted in.")]
    traces: Annotated[int, Doc("Traces in which danger arises.")]
    covered: Annotated[int, Doc("Those with a class.")]
    repeated: Annotated[int, Doc("Traces that were left out, as another recording shows them.")]
    situations: Annotated[tuple[Count, ...], Doc("Situations by class.")]
    in_traces: Annotated[tuple[Count, ...], Doc("Traces by class.")]
    classified: Annotated[tuple[tuple[int, int], ...], Doc("Situations by number of vehicles.")]
    broken: Annotated[tuple[str, ...], Doc("Situations in which classes are not what is proved.")]


@dataclass(frozen=True)
class SimulatedShares(Unprepared):
    """The question for shares of ``classes``, as a ``study.frame.Study``; ``basis`` is about their set."""

    record_type: ClassVar[type[SharesRecord]] = SharesRecord
    basis: Basis
    classes: Classes

    @property
    def source(self) -> str:
        """What is counted, in words."""
        return f"a simulated recording of {SECONDS:g} s, seed {SEED}"

    @property
    def question(self) -> Question:
        plan = self.classes.plan
        said: JsonObject = {"set": plan.set_name, "scenarios": [*plan.numbers], "source": self.source}
        return Question(SCHEMA, said | self.basis.said(), self.basis.limits, self.basis.library)

    def pieces(self, known: Mapping[str, Shares]) -> Sequence[str]:
        return [] if NAME in known else [NAME]

    def wanted(self, known: Mapping[str, Shares]) -> Collection[str]:
        return [NAME]

    def key(self, name: str) -> str:
        """Classes and scenarios are asked with the definitions that they use."""
        plan = self.classes.plan
        home, classes = self.basis.specification, self.classes.all()
        scenarios = (applied(home, Scenario(number, plan.set_name)) for number in plan.numbers)
        asked = [*scenarios, *(one.query(home) for one in classes)]
        called = [(x.name, x.vehicles, x.scenarios) for x in classes]
        return self.basis.key(asked, plan, called, home.library.lanes, self.basis.all_values())

    def settle(self, piece: str) -> dict[str, Shares]:
        recording = simulate(Traffic(seconds=SECONDS), SEED)
        home, values = self.basis.specification, self.basis.all_values()
        return {piece: count_shares(self.classes, home, values, [recording], source=self.source)}

    def doubt(self, piece: str, reason: Reason) -> dict[str, Shares]:
        return {piece: Shares(source=self.source, broken=[reason])}

    def is_sure(self, answer: Shares) -> bool:
        return not answer.broken

    def record(self, name: str, answer: Shares, shelf: EvidenceStore) -> SharesRecord:
        return SharesRecord(
            tuple(answer.recordings),
            answer.all_traces,
            answer.covered,
            answer.repeated,
            tuple(answer.situations.items()),
            tuple(answer.traces.items()),
            tuple(answer.classified.items()),
            tuple(answer.broken),
        )

    def recall(self, record: SharesRecord, shelf: EvidenceStore) -> tuple[str, Shares]:
        return NAME, Shares(
            [*record.recordings],
            record.traces,
            record.covered,
            Counter(dict(record.situations)),
            Counter(dict(record.in_traces)),
            Counter(dict(record.classified)),
            [*record.broken],
            record.repeated,
            self.source,
        )


def simulated_shares(basis: Basis, classes: Classes, fresh: bool = False) -> Shares:
    """The shares of ``classes`` in a simulated recording; ``fresh``: whether known ones are counted again."""
    return conduct(SimulatedShares(basis, classes), hands=1, fresh=fresh).answers[NAME]
