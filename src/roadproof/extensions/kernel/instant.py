"""The search for a reason of a fact about one instant, as proofs/kernel/Products.v checks it. Not trusted.

The fact is taken to be false and taken apart; maxima and minima by cases, quotients as numbers of their own;
then a contradiction of polynomial constraints is looked for (``cone.py``, then ``squares.py``), at last with
quotients and variables taken to be at least 0, or below.
"""

import re
from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.extensions.kernel import cone
from roadproof.extensions.kernel.constructors import size, term
from roadproof.extensions.kernel.plain import atoms_of, binary, comparisons, extrema, plain
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term
from roadproof.world.polynomial import Polynomial, constant, variable

MOST_CASES = 4000
MOST_WORK = 100_000  # products that are looked at
MOST_SUMS = 20  # cases in which sums of squares are looked for
MOST_PARTS = 400  # of a polynomial
MOST_CUTS = 2
LEVELS = (1, 2, 3)
_PLACES = ("s", "d")
_GIVEN = re.compile(r"\(given_ (\d+)\)")
_OPEN = re.compile(r"<(\d+)>")


class NoReasonError(Exception):
    """No reason was found."""


@dataclass(frozen=True)
class Reason:
    """``written``: the reason for Coq; ``atoms``: the terms that are variables of its polynomials."""

    written: str
    atoms: tuple[Term, ...]


@dataclass(frozen=True)
class _Core:
    """Constraints that contradict each other, and why; ``<0>`` in it is how many come after the first."""

    keys: tuple[Hashable, ...]
    why: str

    def written(self, after: Mapping[Hashable, int]) -> str | None:
        """The same where so many constraints come ``after`` each; None where one of them is missing."""
        if not all(x in after for x in self.keys):
            return None
        return _OPEN.sub(lambda x: str(after[self.keys[int(x[1])]]), self.why)


@dataclass(frozen=True)
class _State:
    """One case: facts by their places, constraints by theirs, terms that stand for polynomials."""

    facts: tuple[tuple[bool, Formula], ...]
    constraints: tuple[cone.Constraint, ...]
    table: Mapping[Term, Polynomial[int]]
    waiting: tuple[int, ...]  # facts that are to be read
    choices: tuple[int, ...] = ()  # disjunctions
    divided: frozenset[Term] = frozenset()
    cuts: int = 0

    def constrained(self, *more: cone.Constraint) -> "_State":
        return replace(self, constraints=(*self.constraints, *more))

    def told(self, place: int, *facts: tuple[bool, Formula]) -> "_State":
        """With facts in place of the one at ``place``."""
        new = range(len(self.facts), len(self.facts) + len(facts))
        left = tuple(x for x in self.waiting if x != place)
        choices = tuple(x for x in self.choices if x != place)
        return replace(self, facts=(*self.facts, *facts), waiting=(*new, *left), choices=choices)


def reason(fact: Formula, strict: Mapping[str, bool], own: Sequence[t.Own]) -> Reason | None:
    """A reason for a fact, None where none is found.

    ``strict`` says of each bounded parameter whether it is above 0; ``own``: the signals of a specification,
    in the order of their bounds.
    """
    try:
        search = _Search(binary(fact), strict, own)
        return Reason(search.run(), tuple(search.atoms))
    except (NoReasonError, InputError, RecursionError):
        return None


@dataclass
class _Search:
    fact: Formula
    strict: Mapping[str, bool]
    own: Sequence[t.Own]
    atoms: dict[Term, int] = field(default_factory=dict)
    left: int = MOST_CASES
    work: int = MOST_WORK
    sums: int = MOST_SUMS
    products: cone.Products = field(default_factory=dict)
    cores: list[_Core] = field(default_factory=list)

    def run(self) -> str:
        for x in comparisons(self.fact):
            for side in (x.left, x.right):
                for atom in atoms_of(side):
                    self.atoms.setdefault(atom, len(self.atoms) + 1)
        table: dict[Term, Polynomial[int]] = {x: variable(number) for x, number in self.atoms.items()}
        bounds = [
            cone.Constraint("above" if strict else "at least", table[p])
            for name, strict in self.strict.items()
            for p in self.atoms
            if isinstance(p, t.Parameter) and p.name == name
        ]
        for signal in self.own:
            for low, bound in ((True, signal.low), (False, signal.high)):
                if signal in table and bound is not None:
                    above = table[signal] + constant(-bound)
                    bounds.append(cone.Constraint("at least", above if low else above.scaled(Fraction(-1))))
        return self._prove(_State(((False, self.fact),), tuple(reversed(bounds)), table, (0,)))

    def _prove(self, state: _State) -> str:
        known = self._known(state.constraints)
        if known is not None:
            return known
        self.left -= 1
        if self.left < 0:
            raise NoReasonError
        for x in state.table:
            if isinstance(x, t.Size) and x not in state.divided:
                new = cone.Constraint("above", state.table[x])
                sized = replace(state, divided=state.divided | {x}).constrained(new)
                return f"(Sized {size(x)} {self._prove(sized)})"
        for place in state.waiting:
            found = self._read(state, place)
            if found is not None:
                return found
        return (
            self._closed(state, LEVELS[:1])
            or self._quotient(state)
            or self._extremum(state)
            or self._divide(state)
            or self._closed(state, LEVELS[1:])
            or self._squares(state)
            or self._cut(state)
        )

    def _closed(self, state: _State, levels: Sequence[int]) -> str | None:
        for level in levels:
            found = self._contradiction(state.constraints, level)
            if found is not None:
                return self._learn(state.constraints, f"(Absurd {found.written()})")
        return None

    def _learn(self, constraints: Sequence[cone.Constraint], written: str) -> str:
        """Remembers which constraints contradict each other: they close other cases as well."""
        last = len(constraints) - 1
        places = sorted({last - int(x) for x in _GIVEN.findall(written)})
        template = _GIVEN.sub(lambda x: f"(given_ <{places.index(last - int(x[1]))}>)", written)
        self.cores.append(_Core(tuple(constraints[x].key for x in places), template))
        return written

    def _known(self, constraints: Sequence[cone.Constraint]) -> str | None:
        """Why these contradict each other, if that was found out before."""
        last = len(constraints) - 1
        after = {x.key: last - place for place, x in enumerate(constraints)}
        return next((x for core in self.cores if (x := core.written(after)) is not None), None)

    def _contradiction(self, constraints: Sequence[cone.Constraint], level: int) -> cone.Sum | None:
        found, work = cone.contradiction(constraints, level, self.products)
        self.work -= work
        if found is None and self.work < 0:
            raise NoReasonError
        return found

    def _squares(self, state: _State) -> str | None:
        """By sums of squares, which are asked before signs are told apart."""
        if self.sums <= 0:
            return None
        self.sums -= 1
        from roadproof.extensions.kernel import squares as squares  # with numpy and a solver

        found = squares.contradiction(state.constraints)
        return None if found is None else self._learn(state.constraints, f"(Absurd {found})")

    # --- facts -------------------------------------------------------------------------------------

    def _read(self, state: _State, place: int) -> str | None:
        """What a fact gives; None where it has to wait until extrema are resolved."""
        sign, formula = state.facts[place]
        number = len(state.facts) - 1 - place
        match formula:
            case f.Truth(value):
                if value != sign:
                    return f"(Untrue {number})"
                return self._prove(state.told(place))
            case f.Not(body):
                return f"(Both {number} {self._prove(state.told(place, (not sign, body)))})"
            case f.And((one, two)) | f.Or((one, two)):
                if isinstance(formula, f.And) == sign:
                    inside = self._prove(state.told(place, (sign, one), (sign, two)))
                    return f"(Both {number} {inside})"
                left = tuple(x for x in state.waiting if x != place)
                return self._prove(replace(state, waiting=left, choices=(*state.choices, place)))
            case f.Compare(left, _, right):
                if isinstance(left, t.Inverse) or isinstance(right, t.Inverse):
                    without = plain(formula)
                    return f"(Plain {number} {self._prove(state.told(place, (sign, without)))})"
                new = self._constraint(state, sign, formula)
                if new is None:
                    return None
                return f"(Reads {number} {self._prove(state.told(place).constrained(new))})"
            case _:
                for other_place, (other_sign, other_formula) in enumerate(state.facts):
                    if other_formula == formula and other_sign != sign:
                        true, false = (place, other_place) if sign else (other_place, place)
                        last = len(state.facts) - 1
                        return f"(Opposed {last - true} {last - false})"
                return self._prove(state.told(place))

    def _constraint(self, state: _State, sign: bool, compare: f.Compare) -> cone.Constraint | None:
        """What a comparison says; None where it has to wait until extrema are resolved."""
        left, op, right = compare.left, compare.op, compare.right
        one_side, other = self._polynomial(state, left), self._polynomial(state, right)
        if one_side is None or other is None:
            return None
        greater = other - one_side if (op in ("<", "<=")) == sign else one_side - other
        strict = (op in ("<", ">")) == sign
        return cone.Constraint("above" if strict else "at least", greater)

    def _divide(self, state: _State) -> str | None:
        if not state.choices:
            return None
        place = next((x for x in state.choices if self._is_settled(state, *state.facts[x])), state.choices[0])
        sign, formula = state.facts[place]
        assert isinstance(formula, f.And | f.Or)
        one, two = formula.parts
        first = self._prove(state.told(place, (sign, one)))
        known = self._known(state.constraints)
        if known is not None:
            return known
        other = self._prove(state.told(place, (sign, two)))
        return f"(Either {len(state.facts) - 1 - place} {first} {other})"

    def _is_settled(self, state: _State, sign: bool, formula: Formula) -> bool:
        """Whether at most one of two cases is left by what contradicts each other."""
        return any(self._is_excluded(state, sign, x) for x in f.children(formula))

    def _is_excluded(self, state: _State, sign: bool, formula: Formula) -> bool:
        match formula:
            case f.Not(body):
                return self._is_excluded(state, not sign, body)
            case f.And(parts) | f.Or(parts):
                every = all if isinstance(formula, f.Or) == sign else any
                return every(self._is_excluded(state, sign, x) for x in parts)
            case f.Compare():
                try:
                    found = self._constraint(state, sign, formula)
                except NoReasonError:
                    return False
                return found is not None and self._known((*state.constraints, found)) is not None
            case _:
                return False

    # --- terms -------------------------------------------------------------------------------------

    def _polynomial(self, state: _State, term: Term) -> Polynomial[int] | None:
        """As ``polynomial`` of Products.v; None for a maximum or minimum that is not resolved."""
        if term in state.table:
            return state.table[term]
        match term:
            case t.Number(value, _):
                return constant(value)
            case t.Sum() | t.Product():
                parts = [self._polynomial(state, x) for x in t.children(term)]
                found: Polynomial[int] = constant(Fraction(int(isinstance(term, t.Product))))
                for x in parts:
                    if x is None:
                        return None
                    found = _small(found + x if isinstance(term, t.Sum) else found * x)
                return found
            case t.Power(base, exponent):
                inner = self._polynomial(state, base)
                if inner is None:
                    return None
                found = constant(Fraction(1))
                for _ in range(exponent):
                    found = _small(found * inner)
                return found
            case t.Quotient(above, t.Number(value, _)) if value:
                inner = self._polynomial(state, above)
                return None if inner is None else inner.scaled(1 / value)
            case _:
                return None

    def _quotient(self, state: _State) -> str | None:
        """A quotient whose divisor is above or below 0 as a number of its own."""
        for x in state.table:
            if not isinstance(x, t.Quotient) or x in state.divided:
                continue
            above, below = self._polynomial(state, x.numerator), self._polynomial(state, x.denominator)
            if above is None or below is None:
                continue
            for up in (True, False):
                other = below.scaled(Fraction(-1)) if up else below
                asked = (*state.constraints, cone.Constraint("at least", other))
                shown = next((y for level in LEVELS[:2] if (y := self._contradiction(asked, level))), None)
                if shown is not None:
                    new = cone.Constraint("zero", state.table[x] * below - above)
                    inside = self._prove(replace(state, divided=state.divided | {x}).constrained(new))
                    words = f"{term(x.numerator)} {term(x.denominator)} {str(up).lower()}"
                    return f"(Over {words} {shown.written()} {inside})"
        return None

    def _extremum(self, state: _State) -> str | None:
        """The two cases of a maximum or minimum of what is resolved already."""
        for place in state.waiting:
            _, formula = state.facts[place]
            assert isinstance(formula, f.Compare)
            for x in extrema((formula.left, formula.right)):
                one, two = x.terms
                p, q = self._polynomial(state, one), self._polynomial(state, two)
                if x in state.table or p is None or q is None:
                    continue
                least, most = (p, q) if isinstance(x, t.Minimum) else (q, p)
                first = replace(state, table={**state.table, x: least}).constrained(
                    cone.Constraint("at least", q - p)
                )
                other = replace(state, table={**state.table, x: most}).constrained(
                    cone.Constraint("above", p - q)
                )
                word = "Smallest" if isinstance(x, t.Minimum) else "Largest"
                words = f"{word} {term(one)} {term(two)}"
                return f"({words} {self._prove(first)} {self._prove(other)})"
        return None

    def _cut(self, state: _State) -> str:
        """What no sign is known of, at least 0 or below; else no reason is found."""
        unknown = None if state.cuts >= MOST_CUTS else self._of_unknown_sign(state)
        if unknown is None:
            raise NoReasonError
        cut = replace(state, cuts=state.cuts + 1)
        first = self._prove(cut.constrained(cone.Constraint("at least", unknown)))
        other = self._prove(cut.constrained(cone.Constraint("above", unknown.scaled(Fraction(-1)))))
        return f"(Sign {cone.coq(unknown)} {first} {other})"

    def _of_unknown_sign(self, state: _State) -> Polynomial[int] | None:
        """A quotient, or the variable that most products contain; of a place the sign says nothing."""
        constraints = [x.polynomial for x in state.constraints]
        signs = {v for x in constraints for v in x.variables if len(x.terms) == 1}
        for x, polynomial in state.table.items():
            if isinstance(x, t.Quotient) and not polynomial.variables & signs:
                below = self._polynomial(state, x.denominator)
                if below is None or below.degree > 0:
                    return polynomial
        places = {self.atoms[x] for x in self.atoms if isinstance(x, t.Signal) and x.name in _PLACES}
        products = Counter(v for x in constraints for m in x.terms if len(m) > 1 for v in set(m))
        found = [v for v, _ in products.most_common() if v not in signs | places]
        return variable(found[0]) if found else None


def _small(polynomial: Polynomial[int]) -> Polynomial[int]:
    """Raises ``NoReasonError`` for what is too large to be looked at."""
    if len(polynomial.terms) > MOST_PARTS:
        raise NoReasonError
    return polynomial
