"""The state in which a manoeuvre of a test begins, as the sheets of UN R157 name it."""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.logic import terms as t
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class InitialState:
    """The vehicles at one instant: signals and sizes by name and vehicle (SI)."""

    signals: Mapping[tuple[t.SignalName, str], Fraction]
    sizes: Mapping[tuple[t.SizeName, str], Fraction]

    def gap(self, behind: str, ahead: str) -> Fraction:
        """Return the distance from the front of one vehicle to the rear of the other, along the road."""
        return self.signals["s", ahead] - self.sizes["length", ahead] - self.signals["s", behind]

    def beside(self, one: str, other: str) -> Fraction:
        """Between two vehicles across the road; negative where the boxes overlap."""
        left = self.signals["d", other] - self.sizes["width", other] - self.signals["d", one]
        right = self.signals["d", one] - self.sizes["width", one] - self.signals["d", other]
        return max(left, right)

    def start(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> dict[str, float]:
        """Return the state under the names of UN R157's sheets, in SI units."""
        return {name: round(float(x), 4) for name, x in self.values(manoeuvre, vehicles).items()}

    def values(self, manoeuvre: ManoeuvreName, vehicles: tuple[str, ...]) -> dict[str, Fraction]:
        """The initial values of a manoeuvre that say this state; ``length`` is that of a middling vehicle."""
        first, other, last = vehicles[0], vehicles[1], vehicles[-1]
        signals, speed = self.signals, self.signals["v_lon", first]
        box: tuple[t.SizeName, ...] = ("length", "width")
        length, width = ((self.sizes[x, first] + self.sizes[x, last]) / 2 for x in box)
        gap, nothing = self.gap(first, other), Fraction(0)
        match manoeuvre:
            case "cut-in":
                values = {"dV0": speed - signals["v_lon", other], "Vy": abs(signals["v_lat", other])}
                values |= {"dx0": gap, "dy0": self.beside(first, other)}
            case "cut-out":
                near = gap if speed else nothing
                values = {"Vf0": signals["v_lon", last], "Vy": abs(signals["v_lat", other])}
                values |= {"headway": near / speed if speed else nothing}
                values |= {"dx0_f": self.gap(first, last) - near - length}
            case "deceleration":
                values = {"dV0": speed - signals["v_lon", other], "Gx": -signals["a_lon", other], "dx0": gap}
        return {"Ve0": speed, **values, "length": length, "width": width}
