"""Which truth values of atoms can hold together at one instant.

A combination is first tried with every parameter at its declared value and boxes of a car, where
the arithmetic is easiest; only what is impossible there is asked in general. An impossible
combination comes back as a clause that holds at every instant.
"""

import time
from collections.abc import Mapping
from fractions import Fraction

from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.times import rational
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import terms_of
from roadproof.solve.smt import Session

TYPICAL_SIZE: Mapping[t.SizeName, Fraction] = {"length": Fraction(9, 2), "width": Fraction(9, 5)}


class StateChecker:
    def __init__(self, atoms: Atoms, bounds: Mapping[str, str], defaults: Mapping[str, Fraction]) -> None:
        self.atoms = atoms
        self.bounds = bounds
        self.defaults = defaults
        self.known: dict[frozenset[tuple[str, bool]], Mapping[str, Fraction | bool]] = {}

    def refute(self, wanted: Mapping[str, bool], deadline: float) -> tuple[tuple[str, bool], ...] | str | None:
        """None where a state with these truth values exists; else a clause against it, or why not known."""
        key = frozenset(wanted.items())
        if key in self.known:
            return None
        for general in (False, True):
            asked = _Question(self, wanted, general)
            answer = asked.session.check(list(asked.switches), timeout=_left(deadline, general))
            if answer == "sat":
                self.known[key] = asked.values()
                return None
            if answer == "unsat" and general:
                return tuple((name, not positive) for name, positive in asked.shrink(deadline))
        return "z3 gave no answer about a state: " + ", ".join(
            name if positive else f"not {name}" for name, positive in wanted.items()
        )

    def signals(self, wanted: Mapping[str, bool]) -> Mapping[str, Fraction | bool]:
        """Values of signals, sizes, parameters and road predicates in the state found for ``wanted``.

        Numbers that are not rational are left out.
        """
        return self.known[frozenset(wanted.items())]


def _left(deadline: float, general: bool) -> float:
    left = max(0.01, deadline - time.monotonic())
    return left if general else min(left, 2.0)


class _Question:
    def __init__(self, checker: StateChecker, wanted: Mapping[str, bool], general: bool) -> None:
        self.session = Session()
        self.meanings = {name: checker.atoms.meaning(name) for name in wanted}
        self.leaves = sorted(
            {
                leaf
                for meaning in self.meanings.values()
                for side in terms_of(meaning)
                for leaf in t.leaves(side)
                if not isinstance(leaf, t.Number)
            },
            key=state.symbol,
        )
        self.session.tell("\n".join(state.declarations(self.meanings.values(), checker.bounds)))
        if not general:
            for leaf in self.leaves:
                value = _typical(leaf, checker.defaults)
                if value is not None:
                    self.session.tell(f"(assert (= {state.symbol(leaf)} {rational(value)}))")
        self.switches: dict[str, tuple[str, bool]] = {}
        for name, positive in wanted.items():
            switch = f"a{len(self.switches) + 1}"
            self.switches[switch] = (name, positive)
            meaning = self.meanings[name]
            asserted = state.state(meaning if positive else f.negation(meaning))
            self.session.tell(f"(declare-const {switch} Bool)(assert (=> {switch} {asserted}))")

    def values(self) -> Mapping[str, Fraction | bool]:
        symbols = [state.symbol(leaf) for leaf in self.leaves]
        symbols += sorted({s for meaning in self.meanings.values() for s in state.opaque_symbols(meaning)})
        read = self.session.values(symbols)
        return {s: v for s, v in zip(symbols, read, strict=True) if v is not None}

    def shrink(self, deadline: float) -> list[tuple[str, bool]]:
        """The literals of an impossible combination, each one needed."""
        needed = self.session.core()
        for switch in list(needed):
            without = [s for s in needed if s != switch]
            if self.session.check(without, timeout=min(2.0, _left(deadline, True))) == "unsat":
                needed = without
        return [self.switches[switch] for switch in needed]


def _typical(
    leaf: t.Parameter | t.Variable | t.Signal | t.Size, defaults: Mapping[str, Fraction]
) -> Fraction | None:
    match leaf:
        case t.Parameter(name, _):
            return defaults.get(name)
        case t.Size(name, _):
            return TYPICAL_SIZE[name]
        case _:
            return None
