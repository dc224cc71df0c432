"""What makes one drive clearly different from another, as a condition for the next search."""

from collections.abc import Mapping
from fractions import Fraction

from roadproof.engines.encode.circuit import Circuit, Leaf, any_of
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.polynomial import Inequality, constant
from roadproof.engines.encode.problem import ColumnInequality
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from roadproof.world.signals import SignalName

# How far a signal at the start or the end has to be from that of another drive, in m and m/s.
CLEARLY: Mapping[SignalName, Fraction] = {"s": Fraction(15), "d": Fraction(5, 2), "v_lon": Fraction(4)}


def differ(layout: Layout, other: Drive) -> Circuit[ColumnInequality]:
    """At the start or the end, a vehicle is in another lane, elsewhere along it, or at another speed."""
    choices: list[Circuit[ColumnInequality]] = []
    for name in layout.vehicles:
        for step in (0, layout.grid.steps):
            state = state_at(other.vehicles[name], step * layout.grid.dt)
            for signal, distance in CLEARLY.items():
                value: Fraction = getattr(state, signal)
                now = layout.state(name, signal, step)
                choices.append(Leaf(Inequality(now + constant(-value - distance), False)))
                choices.append(Leaf(Inequality(now.scaled(Fraction(-1)) + constant(value - distance), False)))
    return any_of(choices)
