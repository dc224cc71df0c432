"""Decides which truth values of atoms can hold together at one instant.

A combination is first tried with parameters at or near their declared values, boxes of a car and
motorway speeds, where the arithmetic is easiest; only if that fails is it asked in general. An impossible
combination comes back as a clause that holds at every instant.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from typing import Literal, TypeAlias, assert_never

from roadproof.engines.solve.recall import RecallingSession, check_sat, find_model
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.derivation import derive_lemma_queries
from roadproof.evidence.times import smt_rational
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, map_terms
from roadproof.reasons import Reason, ReasonKind
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
class StateCache:
    """Knowledge of states by the meaning of their atoms, independent of names.

    ``clauses`` hold at every instant, ``known`` maps possible truth values to a state that has them, and
    ``unsat_queries`` are queries of clauses that z3 has answered unsat.
    """

    clauses: list[tuple[tuple[Formula, bool], ...]] = field(default_factory=list)
    known: dict[frozenset[tuple[Formula, bool]], Mapping[str, Fraction | bool]] = field(default_factory=dict)
    unsat_queries: set[str] = field(default_factory=set)


class StateChecker:
    """The checker of states for all searches about a claim.

    Claims may share ``learnt`` if their bounds and defaults agree.
    """

    def __init__(
        self,
        atoms: Atoms,
        bounds: Mapping[str, str],
        defaults: Mapping[str, Fraction],
        learnt: StateCache | None = None,
    ) -> None:
        self.atoms = atoms
        self.bounds = bounds
        self.defaults = defaults
        self.learnt = learnt or StateCache()
        self._typical: dict[str, tuple[Formula, dict[str, Fraction]]] = {}

    @property
    def unsat_queries(self) -> set[str]:
        return self.learnt.unsat_queries

    def refute(self, truths: Mapping[str, bool], meter: Budget, case: float = CASE) -> Clause | Reason | None:
        """Return None if a state with these truth values exists, else a clause against it or a reason.

        ``case``: units of work for each query in general.
        """
        key = self._key(truths)
        if key in self.learnt.known:
            return None
        named = {self.atoms.meaning(name): name for name in truths}
        for learnt in self.learnt.clauses:
            if all((meaning, not positive) in key for meaning, positive in learnt):
                return tuple((named[meaning], positive) for meaning, positive in learnt)
        literals = list(truths.items())
        tried: set[Clause] = set()
        for assumed in ASSUMED:
            question = _StateQuery(self, truths, assumed)
            answer = question.session.check(list(question.switches), meter.part(QUICK))
            if answer == "sat":
                self.learnt.known[key] = question.values()
                return None
            literals = question.core() if answer == "unsat" else list(truths.items())
            clause = tuple((name, not positive) for name, positive in literals)
            if clause in tried:
                continue
            tried.add(clause)
            if self._always_holds(clause, meter, case):
                clause = self._shrink(clause, meter)
                self.learnt.clauses.append(tuple((self.atoms.meaning(name), p) for name, p in clause))
                return clause
        symbols = _StateQuery(self, truths, "nothing").symbols
        for query in derive_lemma_queries(self.atoms, [(n, not p) for n, p in truths.items()], self.bounds):
            model = find_model(query, symbols, meter.part(case))
            if model is not None:
                self.learnt.known[key] = model
                return None
        return ReasonKind.STATE(
            len(literals), _abbreviated([x if yes else f"not {x}" for x, yes in literals])
        )

    def _always_holds(self, clause: Clause, meter: Budget, units: float = CASE) -> bool:
        """Return whether each query of the clause, as in a certificate, is answered unsat in time."""
        for query in derive_lemma_queries(self.atoms, clause, self.bounds):
            if query not in self.unsat_queries:
                if check_sat(query, meter=meter.part(units)) != "unsat":
                    return False
                self.unsat_queries.add(query)
        return True

    def _shrink(self, clause: Clause, meter: Budget) -> Clause:
        """Drop literals that the clause can do without."""
        for literal in clause:
            shorter = tuple(other for other in clause if other != literal)
            if shorter and self._always_holds(shorter, meter, SHRINK):
                clause = shorter
        return clause

    def signals(self, truths: Mapping[str, bool]) -> Mapping[str, Fraction | bool]:
        """Return values of signals, sizes, parameters and road predicates in the state found for ``truths``.

        Irrational numbers are left out.
        """
        return self.learnt.known[self._key(truths)]

    def typical(self, name: str) -> tuple[Formula, dict[str, Fraction]]:
        """Return an atom with parameters and sizes at typical values, and these values by symbol."""
        if name not in self._typical:
            numbers: dict[str, Fraction] = {}
            put_in = _value_inserter(self.defaults, numbers)
            made = map_terms(self.atoms.meaning(name), lambda term: t.replace_leaves(term, put_in))
            self._typical[name] = made, numbers
        return self._typical[name]

    def _key(self, truths: Mapping[str, bool]) -> frozenset[tuple[Formula, bool]]:
        return frozenset((self.atoms.meaning(name), true) for name, true in truths.items())


class _StateQuery:
    """A solver query for a combination of atoms under ``assumed``.

    ``typical``: parameters and sizes are numbers; ``near``: parameters within a factor of three of them;
    both with plausible signals; ``nothing``: only declared bounds.
    """

    def __init__(self, checker: StateChecker, truths: Mapping[str, bool], assumed: Assumed) -> None:
        self.session = RecallingSession()
        self.numbers: dict[str, Fraction] = {}
        self.meanings = {name: checker.atoms.meaning(name) for name in truths}
        if assumed == "typical":
            usual = {name: checker.typical(name) for name in truths}
            self.meanings = {name: meaning for name, (meaning, _) in usual.items()}
            self.numbers = {symbol: x for _, numbers in usual.values() for symbol, x in numbers.items()}
        self.leaves = _leaves(self.meanings.values())
        self.session.tell("\n".join(state.declarations(self.meanings.values(), checker.bounds)))
        if assumed != "nothing":
            for leaf in self.leaves:
                self.session.tell(_plausible_range(leaf, checker.defaults))
            for consequence in self._where_boxes_lie():
                self.session.tell(f"(assert {consequence})")
        self.switches: dict[str, tuple[str, bool]] = {}
        for name, positive in truths.items():
            switch = f"a${len(self.switches) + 1}"
            self.switches[switch] = (name, positive)
            meaning = self.meanings[name]
            asserted = state.state(meaning if positive else f.negation(meaning))
            self.session.tell(f"(declare-const {switch} Bool)(assert (=> {switch} {asserted}))")

    def _where_boxes_lie(self) -> Iterator[str]:
        """Yield that a box around one on a lanelet of a domain is on it, too; for compared boxes."""
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
        """Yield that one side of the inner box lies within that of the outer, if both are compared."""
        if {t.Signal(signal, inner), t.Signal(signal, outer)} <= set(self.leaves):
            a, b = (state.symbol(t.Signal(signal, vehicle)) for vehicle in (inner, outer))
            x, y = (
                state.symbol(leaf) if leaf in self.leaves else smt_rational(TYPICAL_SIZE[size])
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
        """Return the literals that the last refutation used."""
        return [self.switches[switch] for switch in self.session.core()]


def _abbreviated(conditions: Sequence[str], most: int = 160) -> str:
    """Return the first conditions of a list that have room in a line, the shortest first."""
    chosen: list[str] = []
    for x in sorted(conditions, key=len):
        if len(", ".join((*chosen, x))) > most:
            break
        chosen.append(x)
    return ", ".join(x for x in conditions if x in chosen) + (", …" if len(chosen) < len(conditions) else "")


def _value_inserter(
    defaults: Mapping[str, Fraction], numbers: dict[str, Fraction]
) -> Callable[[t.Leaf], t.Term]:
    """Return a function that puts in typical values and notes them in ``numbers``."""

    def put_in(leaf: t.Leaf) -> t.Term:
        """Return the typical value of a parameter or size; other leaves stay."""
        match leaf:
            case t.Parameter(name, dimension) if name in defaults:
                numbers[name] = defaults[name]
                return t.Number(defaults[name], dimension)
            case t.Size(name, _):
                numbers[state.symbol(leaf)] = TYPICAL_SIZE[name]
                return t.Number(TYPICAL_SIZE[name], t.SIZE_DIMENSIONS.get(name, (0, 0)))
            case t.Number() | t.Parameter() | t.Variable() | t.Signal() | t.CustomSignal():
                return leaf

    return put_in


def _leaves(
    formulas: Iterable[Formula],
) -> list[t.Parameter | t.Variable | t.Signal | t.Size | t.CustomSignal]:
    leaves = {leaf for x in formulas for leaf in leaves_of(x)}
    return sorted((leaf for leaf in leaves if not isinstance(leaf, t.Number)), key=state.symbol)


def _plausible_range(
    leaf: t.Parameter | t.Variable | t.Signal | t.Size | t.CustomSignal, defaults: Mapping[str, Fraction]
) -> str:
    """Return an SMT assertion of usual values for a leaf, which only guides the first queries."""
    match leaf:
        case t.Signal(name, _):
            low, high = map(Fraction, _motorway_range(name))
        case t.Parameter(name, _) if name in defaults:
            low, high = sorted((defaults[name] / 3, defaults[name] * 3))
        case t.Size(size, _):
            low = high = TYPICAL_SIZE[size]
        case t.Parameter() | t.Variable() | t.CustomSignal():
            return ""
        case _:
            assert_never(leaf)
    return f"(assert (<= {smt_rational(low)} {state.symbol(leaf)} {smt_rational(high)}))"


def _motorway_range(signal: t.SignalName) -> tuple[int, int]:
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


def is_propositional(formula: Formula) -> bool:
    """Return whether an abstracted formula combines atoms at one instant and nothing else."""
    match formula:
        case f.Truth() | f.Application():
            return True
        case f.Not() | f.And() | f.Or():
            return all(map(is_propositional, f.children(formula)))
        case f.Compare() | f.Occupies() | f.Some() | f.Every():
            return False
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            return False


def deciding_atoms(formula: Formula, value: bool, truths: Mapping[str, bool]) -> dict[str, bool] | None:
    """Return atoms with their ``truths`` that give ``formula`` this ``value``; None where it has another.

    Where one part decides, the part with the fewest atoms is taken, the first among equals.
    """
    match formula:
        case f.Truth(known):
            return {} if known == value else None
        case f.Application(name, _, _):
            return {name: value} if truths.get(name) == value else None
        case f.Not(body):
            return deciding_atoms(body, not value, truths)
        case f.And(parts) | f.Or(parts):
            explanations = [deciding_atoms(part, value, truths) for part in parts]
            enough = [x for x in explanations if x is not None]
            if isinstance(formula, f.And) != value:
                return min(enough, key=len, default=None)
            return {k: v for x in enough for k, v in x.items()} if len(enough) == len(explanations) else None
        case f.Compare() | f.Occupies() | f.Some() | f.Every():
            raise ValueError(f"not plain: {type(formula).__name__}")
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            raise ValueError(f"not plain: {type(formula).__name__}")
