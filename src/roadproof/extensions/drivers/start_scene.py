"""The initial values of a plate as a scene: POV goes on as it begins, so each instant is a quotient."""

from fractions import Fraction

from roadproof.extensions.drivers.manoeuvres import CutIn, CutOut, Deceleration, Start
from roadproof.runtime.records import dataclass

_NONE = Fraction(0)


@dataclass(frozen=True)
class StartScene:
    """Initial values as a ``Scene`` that begins at 0 s.

    Raises ``ValueError`` where a manoeuvre does not define what is asked for.
    """

    values: Start

    @property
    def start(self) -> Fraction:
        return _NONE

    def offset(self, metres: Fraction) -> Fraction | None:
        match self.values:
            case CutIn(Vy=lateral) | CutOut(Vy=lateral):
                return metres / lateral
            case Deceleration():
                return None

    def beside(self) -> Fraction | None:
        return self._cut_in.dy0 / self._cut_in.Vy

    def past_marking(self, metres: Fraction) -> Fraction | None:
        return (self._cut_in.dy0 / 2 + metres) / self._cut_in.Vy

    def wrapped(self) -> Fraction | None:
        return (self._cut_in.dy0 + self._cut_in.width) / self._cut_in.Vy

    def closing(self, seconds: Fraction, since: Fraction) -> Fraction | None:
        begin = self._cut_in
        return None if begin.dV0 <= 0 else max(since, begin.dx0 / begin.dV0 - seconds)

    def braking(self, least: Fraction) -> Fraction | None:
        begin = self.values
        if not isinstance(begin, Deceleration) or begin.Gx < least:
            return None
        if not least or begin.dGdt is None:
            return _NONE
        instant = least / begin.dGdt
        stands = begin.Ve0 - begin.dV0 <= begin.dGdt * instant**2 / 2
        return None if stands else instant

    @property
    def _cut_in(self) -> CutIn:
        if not isinstance(self.values, CutIn):
            raise ValueError(f"no vehicle comes into the lane of SV: {self.values}")
        return self.values
