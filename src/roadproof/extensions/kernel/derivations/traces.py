"""The signals of a refuting trace, for derivations. Not trusted: Coq checks the derivation."""

from dataclasses import dataclass, field
from fractions import Fraction

from roadproof.evidence.countermodel import Loop
from roadproof.evidence.refutation import when_true
from roadproof.extensions.kernel.derivations.signs import Shapes, TimePart
from roadproof.extensions.kernel.trace import TraceStatement, steps_of
from roadproof.extensions.kernel.world import Steps
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of
from roadproof.logic.formula import Compare
from roadproof.semantics.exact.polynomial import TimePolynomial, polynomial
from roadproof.semantics.exact.truth import TruthSet


@dataclass
class TraceShapes(Shapes):
    """The signals of a trace, which are constant in steps."""

    refuted: TraceStatement
    _steps: dict[t.Leaf, Steps] = field(default_factory=dict)

    @property
    def loop(self) -> Loop | None:
        return self.refuted.trace.loop

    def when(self, compared: Compare) -> TruthSet:
        return when_true(compared, self.refuted.trace)

    def knots(self, leaf: t.Leaf) -> list[Fraction]:
        return []

    def steps(self, leaf: t.Leaf) -> list[Fraction]:
        return [time for time, _, _ in self._of(leaf)] if isinstance(leaf, t.Varying) else []

    def signal(self, signal: t.Varying, part: TimePart) -> TimePolynomial:
        time, at, after = [x for x in self._of(signal) if x[0] <= part.start][-1]
        return polynomial(at if time == part.start and not part.begin.after else after)

    def size(self, size: t.Size) -> Fraction:
        """Return a size of a vehicle, or the code of its kind."""
        motion = self.refuted.world.vehicles[size.vehicle]
        if size.name == "kind":
            return Fraction(code_of(motion.kind or "other"))
        return motion.length if size.name == "length" else motion.width

    def _of(self, signal: t.Varying) -> Steps:
        if signal not in self._steps:
            name = signal.text if isinstance(signal, t.CustomSignal) else f"{signal.name}({signal.vehicle})"
            self._steps[signal] = steps_of(self.refuted.trace, name)
        return self._steps[signal]
