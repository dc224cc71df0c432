"""Which truth values of atoms can hold together at one instant.

A combination is first tried with parameters at or near their declared values, boxes of a car and
speeds of a motorway, where the arithmetic is easiest; only what is impossible there is asked in
general. An impossible
combination comes back as a clause that holds at every instant.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from typing import Literal, TypeAlias, assert_never

from roadproof.engines.solve.recall import RecallingSession, ask, solve
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.derivation import derive_lemma_queries
from roadproof.evidence.times import rational
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, map_terms
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import Budget
from roadproof.runtime.records import dataclass

Assumed: TypeAlias = Literal["typical", "near", "nothing"]
ASSUMED: tuple[Assumed, ...] = ("typical", "near", "nothing")
Clause: TypeAlias = tuple[tuple[str, bool], ...]
# Units of work for one query: of a state, of a clause, of a clause with one literal less.
QUICK = 0.3
CASE = 5.0
SHRINK = 0.1
TYPICAL_SIZE: Mapping[t.SizeName, Fraction] = {
    "length": Fraction(9, 2),
    "width": Fraction(9, 5),
    "kind": Fraction(1),
}


@dataclass(frozen=True)
class Learnt:
    """What is known of states, by what their atoms mean, whatever these are called.

    ``clauses`` hold at every instant, ``known`` are states with the truth values that were asked for, and
    ``settled`` are queries of clauses that z3 has answered unsat.
    """

    clauses: list[tuple[tuple[Formula, bool], ...]] = field(default_factory=list)
    known: dict[frozenset[tuple[Formula, bool]], Mapping[str, Fraction | bool]] = field(default_factory=dict)
    settled: set[str] = field(default_factory=set)


class StateChecker:
    """One for all searches about a claim. Claims may share ``learnt``: their bounds and defaults agree."""

    def __init__(
        self,
        atoms: Atoms,
        bounds: Mapping[str, str],
        defaults: Mapping[str, Fraction],
        learnt: Learnt | None = None,
    ) -> None:
        self.atoms = atoms
        self.bounds = bounds
        self.defaults = defaults
        self.learnt = learnt or Learnt()
        self._typical: dict[str, tuple[Formula, dict[str, Fraction]]] = {}

    @property
    def settled(self) -> set[str]:
        return self.learnt.settled

    def refute(self, wanted: Mapping[str, bool], meter: Budget, case: float = CASE) -> Clause | Reason | None:
        """None where a state with these truth values exists; else a clause against it, or why not known.

        ``case``: units of work for each query in general.
        """
        key = self._key(wanted)
        if key in self.learnt.known:
            return None
        named = {self.atoms.meaning(name): name for name in wanted}
        for learnt in self.learnt.clauses:
            if all((meaning, not positive) in key for meaning, positive in learnt):
                return tuple((named[meaning], positive) for meaning, positive in learnt)
        literals = list(wanted.items())
        tried: set[Clause] = set()
        for assumed in ASSUMED:
            question = _Question(self, wanted, assumed)
            answer = question.session.check(list(question.switches), meter.part(QUICK))
            if answer == "sat":
                self.learnt.known[key] = question.values()
                return None
            literals = question.core() if answer == "unsat" else list(wanted.items())
            clause = tuple((name, not positive) for name, positive in literals)
            if clause in tried:
                continue
            tried.add(clause)
            if self._always_holds(clause, meter, case):
                clause = self._shrink(clause, meter)
                self.learnt.clauses.append(tuple((self.atoms.meaning(name), p) for name, p in clause))
                return clause
        symbols = _Question(self, wanted, "nothing").symbols
        for query in derive_lemma_queries(self.atoms, [(n, not p) for n, p in wanted.items()], self.bounds):
            found = solve(query, symbols, meter.part(case))
            if found is not None:
                self.learnt.known[key] = found
                return None
        return Why.STATE(len(literals), _in_short([x if yes else f"not {x}" for x, yes in literals]))

    def _always_holds(self, clause: Clause, meter: Budget, units: float = CASE) -> bool:
        """Whether each query of the clause, as a certificate will hold it, is answered unsat in time."""
        for query in derive_lemma_queries(self.atoms, clause, self.bounds):
            if query not in self.settled:
                if ask(query, meter=meter.part(units)) != "unsat":
                    return False
                self.settled.add(query)
        return True

    def _shrink(self, clause: Clause, meter: Budget) -> Clause:
        """The clause without the literals that it holds without."""
        for literal in clause:
            shorter = tuple(kept for kept in clause if kept != literal)
            if shorter and self._always_holds(shorter, meter, SHRINK):
                clause = shorter
        return clause

    def signals(self, wanted: Mapping[str, bool]) -> Mapping[str, Fraction | bool]:
        """Values of signals, sizes, parameters and road predicates in the state found for ``wanted``.

        Numbers that are not rational are left out.
        """
        return self.learnt.known[self._key(wanted)]

    def typical(self, name: str) -> tuple[Formula, dict[str, Fraction]]:
        """What an atom says where parameters and sizes have their usual values, with these by symbol."""
        if name not in self._typical:
            numbers: dict[str, Fraction] = {}
            put_in = _putting_in(self.defaults, numbers)
            made = map_terms(self.atoms.meaning(name), lambda term: t.replace_leaves(term, put_in))
            self._typical[name] = made, numbers
        return self._typical[name]

    def _key(self, wanted: Mapping[str, bool]) -> frozenset[tuple[Formula, bool]]:
        return frozenset((self.atoms.meaning(name), true) for name, true in wanted.items())


class _Question:
    """A combination of atoms put to the solver, under ``assumed``.

    ``typical``: parameters and sizes are numbers; ``near``: parameters within a factor of three of
    them; both with plausible signals; ``nothing``: whatever is declared.
    """

    def __init__(self, checker: StateChecker, wanted: Mapping[str, bool], assumed: Assumed) -> None:
        self.session = RecallingSession()
        self.numbers: dict[str, Fraction] = {}
        self.meanings = {name: checker.atoms.meaning(name) for name in wanted}
        if assumed == "typical":
            usual = {name: checker.typical(name) for name in wanted}
            self.meanings = {name: meaning for name, (meaning, _) in usual.items()}
            self.numbers = {symbol: x for _, numbers in usual.values() for symbol, x in numbers.items()}
        self.leaves = _leaves(self.meanings.values())
        self.session.tell("\n".join(state.declarations(self.meanings.values(), checker.bounds)))
        if assumed != "nothing":
            for leaf in self.leaves:
                self.session.tell(_plausible(leaf, checker.defaults))
            for consequence in self._where_boxes_lie():
                self.session.tell(f"(assert {consequence})")
        self.switches: dict[str, tuple[str, bool]] = {}
        for name, positive in wanted.items():
            switch = f"a${len(self.switches) + 1}"
            self.switches[switch] = (name, positive)
            meaning = self.meanings[name]
            asserted = state.state(meaning if positive else f.negation(meaning))
            self.session.tell(f"(declare-const {switch} Bool)(assert (=> {switch} {asserted}))")

    def _where_boxes_lie(self) -> Iterator[str]:
        """A box around one that is on a lanelet of a domain is so, too; for boxes that are compared."""
        on = {
            (part.domain, part.body.vehicle): state.opaque(part)
            for meaning in self.meanings.values()
            for part in f.subformulas(meaning)
            if isinstance(part, f.Some) and isinstance(part.body, f.Occupies)
        }
        for (domain, inner), inside in on.items():
            for (other, outer), around in on.items():
                ends = [*self._ends("s", "length", inner, outer), *self._ends("d", "width", inner, outer)]
                if inner != outer and domain == other and len(ends) == 4:
                    yield f"(=> (and {inside} {' '.join(ends)}) {around})"

    def _ends(self, signal: t.SignalName, size: t.SizeName, inner: str, outer: str) -> Iterator[str]:
        """What says that one side of the inner box lies within that of the outer, if both are compared."""
        if {t.Signal(signal, inner), t.Signal(signal, outer)} <= set(self.leaves):
            a, b = (state.symbol(t.Signal(signal, vehicle)) for vehicle in (inner, outer))
            x, y = (
                state.symbol(leaf) if leaf in self.leaves else rational(TYPICAL_SIZE[size])
                for leaf in (t.Size(size, inner), t.Size(size, outer))
            )
            yield f"(<= {a} {b})"
            yield f"(>= (- {a} {x}) (- {b} {y}))"

    @property
    def symbols(self) -> list[str]:
        """The constants whose values make a state."""
        road = {s for meaning in self.meanings.values() for s in state.opaque_symbols(meaning)}
        return [state.symbol(leaf) for leaf in self.leaves] + sorted(road)

    def values(self) -> Mapping[str, Fraction | bool]:
        read = zip(self.symbols, self.session.values(self.symbols), strict=True)
        return {**self.numbers, **{symbol: value for symbol, value in read if value is not None}}

    def core(self) -> list[tuple[str, bool]]:
        """The literals that the last refutation used."""
        return [self.switches[switch] for switch in self.session.core()]


def _in_short(conditions: Sequence[str], most: int = 160) -> str:
    """Return the first conditions of a list that have room in a line, the shortest first."""
    chosen: list[str] = []
    for x in sorted(conditions, key=len):
        if len(", ".join((*chosen, x))) > most:
            break
        chosen.append(x)
    return ", ".join(x for x in conditions if x in chosen) + (", …" if len(chosen) < len(conditions) else "")


def _putting_in(defaults: Mapping[str, Fraction], numbers: dict[str, Fraction]) -> Callable[[t.Leaf], t.Term]:
    """A function that puts usual values in place of parameters and sizes, and notes them in ``numbers``."""

    def put_in(leaf: t.Leaf) -> t.Term:
        match leaf:
            case t.Parameter(name, dimension) if name in defaults:
                numbers[name] = defaults[name]
                return t.Number(defaults[name], dimension)
            case t.Size(name, _):
                numbers[state.symbol(leaf)] = TYPICAL_SIZE[name]
                return t.Number(TYPICAL_SIZE[name], t.SIZE_DIMENSIONS.get(name, (0, 0)))
            case _:
                return leaf

    return put_in


def _leaves(formulas: Iterable[Formula]) -> list[t.Parameter | t.Variable | t.Signal | t.Size | t.Own]:
    found = {leaf for x in formulas for leaf in leaves_of(x)}
    return sorted((leaf for leaf in found if not isinstance(leaf, t.Number)), key=state.symbol)


def _plausible(
    leaf: t.Parameter | t.Variable | t.Signal | t.Size | t.Own, defaults: Mapping[str, Fraction]
) -> str:
    """What a reader expects of a signal, or of a parameter; only to look there first."""
    match leaf:
        case t.Signal(name, _):
            low, high = map(Fraction, _on_a_motorway(name))
        case t.Parameter(name, _) if name in defaults:
            low, high = sorted((defaults[name] / 3, defaults[name] * 3))
        case t.Size(size, _):
            low = high = TYPICAL_SIZE[size]
        case _:
            return ""
    return f"(assert (<= {rational(low)} {state.symbol(leaf)} {rational(high)}))"


def _on_a_motorway(signal: t.SignalName) -> tuple[int, int]:
    match signal:
        case "s":
            return 0, 500
        case "d":
            return 0, 11
        case "v_lon":
            return 5, 40
        case "v_lat":
            return -2, 2
        case "a_lon":
            return -8, 5
        case "a_lat":
            return -3, 3
        case "j_lon":
            return -10, 10
        case _:
            assert_never(signal)


def is_plain(formula: Formula) -> bool:
    """Whether an abstracted formula combines atoms and nothing else, at one instant."""
    match formula:
        case f.Truth() | f.Application():
            return True
        case f.Not() | f.And() | f.Or():
            return all(map(is_plain, f.children(formula)))
        case _:
            return False


def reason(formula: Formula, value: bool, truths: Mapping[str, bool]) -> dict[str, bool] | None:
    """Atoms with their ``truths`` that make a plain ``formula`` have this ``value``; None where it has not.

    Of parts of which one is enough, that with the fewest atoms, the first of these.
    """
    match formula:
        case f.Truth(known):
            return {} if known == value else None
        case f.Application(name, _, _):
            return {name: value} if truths.get(name) == value else None
        case f.Not(body):
            return reason(body, not value, truths)
        case f.And(parts) | f.Or(parts):
            found = [reason(part, value, truths) for part in parts]
            enough = [x for x in found if x is not None]
            if isinstance(formula, f.And) != value:
                return min(enough, key=len, default=None)
            return {k: v for x in enough for k, v in x.items()} if len(enough) == len(found) else None
        case _:
            raise ValueError(f"not plain: {type(formula).__name__}")
