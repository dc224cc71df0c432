"""The search for a proof of a fact about one instant, which proofs/kernel/Products.v checks. Not trusted.

The negated fact is decomposed. Maxima and minima are split into cases, quotients become new numbers. Then the
search looks for a contradiction of polynomial constraints (``cone.py``, then ``squares.py``). As a last
resort it splits on the sign of a quotient or variable.
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


class NoInstantProofError(Exception):
    """The search found no proof."""


@dataclass(frozen=True)
class InstantProof:
    """A proof as text for Coq; ``atoms``: the terms that are variables of its polynomials."""

    proof_text: str
    atoms: tuple[Term, ...]


@dataclass(frozen=True)
class _Core:
    """Contradictory constraints with a proof; ``<0>`` in it is the number of constraints after the first."""

    keys: tuple[Hashable, ...]
    why: str

    def proof_text(self, after: Mapping[Hashable, int]) -> str | None:
        """Return the proof for constraints with these numbers; None if one of them is missing."""
        if not all(x in after for x in self.keys):
            return None
        return _OPEN.sub(lambda x: str(after[self.keys[int(x[1])]]), self.why)


@dataclass(frozen=True)
class _Case:
    """A case of the proof: facts and constraints by place, and terms with their polynomials."""

    facts: tuple[tuple[bool, Formula], ...]
    constraints: tuple[cone.Constraint, ...]
    table: Mapping[Term, Polynomial[int]]
    waiting: tuple[int, ...]  # facts that are to be read
    choices: tuple[int, ...] = ()  # disjunctions
    divided: frozenset[Term] = frozenset()
    cuts: int = 0

    def constrained(self, *more: cone.Constraint) -> "_Case":
        return replace(self, constraints=(*self.constraints, *more))

    def with_facts(self, place: int, *facts: tuple[bool, Formula]) -> "_Case":
        """Return the case with these facts in place of the one at ``place``."""
        new = range(len(self.facts), len(self.facts) + len(facts))
        left = tuple(x for x in self.waiting if x != place)
        choices = tuple(x for x in self.choices if x != place)
        return replace(self, facts=(*self.facts, *facts), waiting=(*new, *left), choices=choices)


def find_instant_proof(
    fact: Formula, strict: Mapping[str, bool], custom: Sequence[t.CustomSignal]
) -> InstantProof | None:
    """Return a proof of a fact about one instant; None if none is found.

    ``strict``: for each bounded parameter, whether it is above 0. ``custom``: the custom signals, in the
    order of their bounds.
    """
    try:
        search = _ProofSearch(binary(fact), strict, custom)
        return InstantProof(search.run(), tuple(search.atoms))
    except (NoInstantProofError, InputError, RecursionError):
        return None


@dataclass
class _ProofSearch:
    """A search with budgets for cases, products and sums of squares."""

    fact: Formula
    strict: Mapping[str, bool]
    custom: Sequence[t.CustomSignal]
    atoms: dict[Term, int] = field(default_factory=dict)
    left: int = MOST_CASES
    work: int = MOST_WORK
    sums: int = MOST_SUMS
    products: cone.Products = field(default_factory=dict)
    cores: list[_Core] = field(default_factory=list)

    def run(self) -> str:
        """Return the proof as text for Coq. Raises ``NoInstantProofError``."""
        for comparison in comparisons(self.fact):
            for side in (comparison.left, comparison.right):
                for atom in atoms_of(side):
                    self.atoms.setdefault(atom, len(self.atoms) + 1)
        table: dict[Term, Polynomial[int]] = {x: variable(number) for x, number in self.atoms.items()}
        bounds = [
            cone.Constraint("above" if strict else "at least", table[p])
            for name, strict in self.strict.items()
            for p in self.atoms
            if isinstance(p, t.Parameter) and p.name == name
        ]
        for signal in self.custom:
            for low, bound in ((True, signal.low), (False, signal.high)):
                if signal in table and bound is not None:
                    above = table[signal] + constant(-bound)
                    bounds.append(cone.Constraint("at least", above if low else above.scaled(Fraction(-1))))
        return self._prove(_Case(((False, self.fact),), tuple(reversed(bounds)), table, (0,)))

    def _prove(self, state: _Case) -> str:
        known = self._known(state.constraints)
        if known is not None:
            return known
        self.left -= 1
        if self.left < 0:
            raise NoInstantProofError
        for known_term in state.table:
            if isinstance(known_term, t.Size) and known_term not in state.divided:
                new = cone.Constraint("above", state.table[known_term])
                sized = replace(state, divided=state.divided | {known_term}).constrained(new)
                return f"(Sized {size(known_term)} {self._prove(sized)})"
        for place in state.waiting:
            proof = self._read(state, place)
            if proof is not None:
                return proof
        return (
            self._closed(state, LEVELS[:1])
            or self._quotient(state)
            or self._extremum(state)
            or self._divide(state)
            or self._closed(state, LEVELS[1:])
            or self._squares(state)
            or self._cut(state)
        )

    def _closed(self, state: _Case, levels: Sequence[int]) -> str | None:
        for level in levels:
            total = self._contradiction(state.constraints, level)
            if total is not None:
                return self._learn(state.constraints, f"(Absurd {total.proof_text()})")
        return None

    def _learn(self, constraints: Sequence[cone.Constraint], proof_text: str) -> str:
        """Store which constraints contradict each other: they may close other cases."""
        last = len(constraints) - 1
        places = sorted({last - int(x) for x in _GIVEN.findall(proof_text)})
        template = _GIVEN.sub(lambda x: f"(given_ <{places.index(last - int(x[1]))}>)", proof_text)
        self.cores.append(_Core(tuple(constraints[x].key for x in places), template))
        return proof_text

    def _known(self, constraints: Sequence[cone.Constraint]) -> str | None:
        """Return the stored proof that some of these constraints contradict each other, if there is one."""
        last = len(constraints) - 1
        after = {x.key: last - place for place, x in enumerate(constraints)}
        return next((x for core in self.cores if (x := core.proof_text(after)) is not None), None)

    def _contradiction(self, constraints: Sequence[cone.Constraint], level: int) -> cone.AbsurdSum | None:
        total, work = cone.contradiction(constraints, level, self.products)
        self.work -= work
        if total is None and self.work < 0:
            raise NoInstantProofError
        return total

    def _squares(self, state: _Case) -> str | None:
        """Return a proof by sums of squares, which are tried before signs are split."""
        if self.sums <= 0:
            return None
        self.sums -= 1
        from roadproof.extensions.kernel import squares as squares  # with numpy and a solver

        total = squares.contradiction(state.constraints)
        return None if total is None else self._learn(state.constraints, f"(Absurd {total})")

    # --- facts -------------------------------------------------------------------------------------

    def _read(self, state: _Case, place: int) -> str | None:
        """Return the proof after reading a fact; None if it must wait until extrema are resolved."""
        sign, formula = state.facts[place]
        number = len(state.facts) - 1 - place
        match formula:
            case f.Truth(value):
                if value != sign:
                    return f"(Untrue {number})"
                return self._prove(state.with_facts(place))
            case f.Not(body):
                return f"(Both {number} {self._prove(state.with_facts(place, (not sign, body)))})"
            case f.And((one, two)) | f.Or((one, two)):
                if isinstance(formula, f.And) == sign:
                    inside = self._prove(state.with_facts(place, (sign, one), (sign, two)))
                    return f"(Both {number} {inside})"
                left = tuple(x for x in state.waiting if x != place)
                return self._prove(replace(state, waiting=left, choices=(*state.choices, place)))
            case f.Compare(left, _, right):
                if isinstance(left, t.Inverse) or isinstance(right, t.Inverse):
                    without = plain(formula)
                    return f"(Plain {number} {self._prove(state.with_facts(place, (sign, without)))})"
                new = self._constraint(state, sign, formula)
                if new is None:
                    return None
                return f"(Reads {number} {self._prove(state.with_facts(place).constrained(new))})"
            case _:  # open: formulas that stay opaque, such as a lane predicate
                for other_place, (other_sign, other_formula) in enumerate(state.facts):
                    if other_formula == formula and other_sign != sign:
                        true, false = (place, other_place) if sign else (other_place, place)
                        last = len(state.facts) - 1
                        return f"(Opposed {last - true} {last - false})"
                return self._prove(state.with_facts(place))

    def _constraint(self, state: _Case, sign: bool, compare: f.Compare) -> cone.Constraint | None:
        """Return the constraint of a comparison; None if it must wait until extrema are resolved."""
        left, op, right = compare.left, compare.op, compare.right
        one_side, other = self._polynomial(state, left), self._polynomial(state, right)
        if one_side is None or other is None:
            return None
        greater = other - one_side if (op in ("<", "<=")) == sign else one_side - other
        strict = (op in ("<", ">")) == sign
        return cone.Constraint("above" if strict else "at least", greater)

    def _divide(self, state: _Case) -> str | None:
        if not state.choices:
            return None
        place = next((x for x in state.choices if self._is_decided(state, *state.facts[x])), state.choices[0])
        sign, formula = state.facts[place]
        assert isinstance(formula, f.And | f.Or)
        one, two = formula.parts
        first = self._prove(state.with_facts(place, (sign, one)))
        known = self._known(state.constraints)
        if known is not None:
            return known
        other = self._prove(state.with_facts(place, (sign, two)))
        return f"(Either {len(state.facts) - 1 - place} {first} {other})"

    def _is_decided(self, state: _Case, sign: bool, formula: Formula) -> bool:
        """Return whether known contradictions exclude at least one of two cases."""
        return any(self._is_excluded(state, sign, x) for x in f.children(formula))

    def _is_excluded(self, state: _Case, sign: bool, formula: Formula) -> bool:
        match formula:
            case f.Not(body):
                return self._is_excluded(state, not sign, body)
            case f.And(parts) | f.Or(parts):
                combine = all if isinstance(formula, f.Or) == sign else any
                return combine(self._is_excluded(state, sign, x) for x in parts)
            case f.Compare():
                try:
                    constraint = self._constraint(state, sign, formula)
                except NoInstantProofError:
                    return False
                return constraint is not None and self._known((*state.constraints, constraint)) is not None
            case f.Truth() | f.Occupies() | f.Some() | f.Every() | f.Application():
                return False
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return False

    # --- terms -------------------------------------------------------------------------------------

    def _polynomial(self, state: _Case, term: Term) -> Polynomial[int] | None:
        """Return ``polynomial`` of Products.v; None for a maximum or minimum that is not resolved."""
        if term in state.table:
            return state.table[term]
        match term:
            case t.Number(value, _):
                return constant(value)
            case t.Sum() | t.Product():
                parts = [self._polynomial(state, x) for x in t.children(term)]
                result: Polynomial[int] = constant(Fraction(int(isinstance(term, t.Product))))
                for part in parts:
                    if part is None:
                        return None
                    result = _small(result + part if isinstance(term, t.Sum) else result * part)
                return result
            case t.Power(base, exponent):
                inner = self._polynomial(state, base)
                if inner is None:
                    return None
                result = constant(Fraction(1))
                for _ in range(exponent):
                    result = _small(result * inner)
                return result
            case t.Quotient(above, t.Number(value, _)) if value:
                inner = self._polynomial(state, above)
                return None if inner is None else inner.scaled(1 / value)
            case _:  # open: quotients and extrema that are not in the table yet
                return None

    def _quotient(self, state: _Case) -> str | None:
        """Return a proof in which a quotient with a divisor of known sign is a number of its own."""
        for quotient in state.table:
            if not isinstance(quotient, t.Quotient) or quotient in state.divided:
                continue
            above, below = (
                self._polynomial(state, quotient.numerator),
                self._polynomial(state, quotient.denominator),
            )
            if above is None or below is None:
                continue
            for up in (True, False):
                other = below.scaled(Fraction(-1)) if up else below
                constraints = (*state.constraints, cone.Constraint("at least", other))
                shown = next(
                    (y for level in LEVELS[:2] if (y := self._contradiction(constraints, level))), None
                )
                if shown is not None:
                    new = cone.Constraint("zero", state.table[quotient] * below - above)
                    inside = self._prove(replace(state, divided=state.divided | {quotient}).constrained(new))
                    words = f"{term(quotient.numerator)} {term(quotient.denominator)} {str(up).lower()}"
                    return f"(Over {words} {shown.proof_text()} {inside})"
        return None

    def _extremum(self, state: _Case) -> str | None:
        """Return a proof by the two cases of a maximum or minimum with resolved arguments."""
        for place in state.waiting:
            _, formula = state.facts[place]
            assert isinstance(formula, f.Compare)
            for extremum in extrema((formula.left, formula.right)):
                one, two = extremum.terms
                p, q = self._polynomial(state, one), self._polynomial(state, two)
                if extremum in state.table or p is None or q is None:
                    continue
                least, most = (p, q) if isinstance(extremum, t.Minimum) else (q, p)
                first = replace(state, table={**state.table, extremum: least}).constrained(
                    cone.Constraint("at least", q - p)
                )
                other = replace(state, table={**state.table, extremum: most}).constrained(
                    cone.Constraint("above", p - q)
                )
                word = "Smallest" if isinstance(extremum, t.Minimum) else "Largest"
                words = f"{word} {term(one)} {term(two)}"
                return f"({words} {self._prove(first)} {self._prove(other)})"
        return None

    def _cut(self, state: _Case) -> str:
        """Return a proof by the sign of a polynomial of unknown sign. Raises ``NoInstantProofError``."""
        unknown = None if state.cuts >= MOST_CUTS else self._of_unknown_sign(state)
        if unknown is None:
            raise NoInstantProofError
        cut = replace(state, cuts=state.cuts + 1)
        first = self._prove(cut.constrained(cone.Constraint("at least", unknown)))
        other = self._prove(cut.constrained(cone.Constraint("above", unknown.scaled(Fraction(-1)))))
        return f"(Sign {cone.coq(unknown)} {first} {other})"

    def _of_unknown_sign(self, state: _Case) -> Polynomial[int] | None:
        """Return a quotient, or the variable in most products; the sign of a place is irrelevant."""
        constraints = [x.polynomial for x in state.constraints]
        signs = {v for x in constraints for v in x.variables if len(x.terms) == 1}
        for known_term, polynomial in state.table.items():
            if isinstance(known_term, t.Quotient) and not polynomial.variables & signs:
                below = self._polynomial(state, known_term.denominator)
                if below is None or below.degree > 0:
                    return polynomial
        places = {self.atoms[x] for x in self.atoms if isinstance(x, t.Signal) and x.name in _PLACES}
        products = Counter(v for x in constraints for m in x.terms if len(m) > 1 for v in set(m))
        candidates = [v for v, _ in products.most_common() if v not in signs | places]
        return variable(candidates[0]) if candidates else None


def _small(polynomial: Polynomial[int]) -> Polynomial[int]:
    """Return the polynomial. Raises ``NoInstantProofError`` if it has too many terms."""
    if len(polynomial.terms) > MOST_PARTS:
        raise NoInstantProofError
    return polynomial
