"""The search for a proof or for a countermodel over finitely many moments.

Model-based instantiation: the solver proposes a model of the ground clauses; universals that the
model violates at a known moment are instantiated there; when none is left, the states at its
moments are checked one by one, and what cannot be a state becomes a lemma; when all are states, the
model is a candidate countermodel. When the clauses have no model, the claim is proved, and the
instances are shrunk to those that are needed.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

from roadproof.engines.prove.doubt import Stop
from roadproof.engines.prove.grounding import Grounding, Universal
from roadproof.engines.prove.roads import Roster, open_quantifiers
from roadproof.engines.prove.states import CASE, StateChecker, is_plain, reason
from roadproof.engines.solve.smt import Satisfiability
from roadproof.evidence.derivation import free_prefix
from roadproof.evidence.road_axioms import membership
from roadproof.evidence.sites import Lemma, Site
from roadproof.evidence.times import ZERO, Moment, at, bound_parameters, constant, moment_of, read_moment
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import free_lanelets, road_names
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import Budget
from roadproof.runtime.records import dataclass

MOST_ROUNDS = 400
MOST_ELEMENTS = 24
# Units of work for a look at one moment of one universal, and for an instance.
LOOK = 2e-6
INSTANCE = 2e-4
BRIEFLY = 1.0  # units of work for a state that says no more than why the claim is false
WISH = 0.25  # units of work for a check with wishes, or for one of a shorter proof

States: TypeAlias = Mapping[Fraction, Mapping[str, bool]]


@dataclass(frozen=True)
class Proof:
    """What ``evidence.derivation`` needs, beside the names, to derive the ground query again.

    ``settled`` are queries of lemmas that z3 has already answered unsat.
    """

    instances: Mapping[Site, tuple[str, ...]]
    lemmas: tuple[Lemma, ...]
    settled: frozenset[str]


@dataclass(frozen=True)
class Model:
    """A model of all clauses: when the moments are, and which atoms are true there.

    ``states`` gives each instant its atoms, and ``signals`` each instant a state in which they hold.
    ``elements`` are the lanes and lanelets spoken of, with the domain that each was taken from, and
    ``facts`` says which are in which domain.
    """

    values: Mapping[str, Fraction]
    states: States
    signals: Mapping[Fraction, Mapping[str, Fraction | bool]]
    elements: Mapping[str, f.Domain]
    facts: Mapping[tuple[f.Domain, str], bool]


@dataclass(frozen=True)
class GaveUp:
    """Why neither was found, in words, and where the search stopped."""

    reason: Reason
    stop: Stop = Stop.WORK


class InstanceSearch:
    """One claim under attack, with one way of choosing models.

    ``wishful`` asks for models with few instants, which ends the hunt for a countermodel sooner and
    a hard proof later. ``names`` is shared between searches whose proofs are to be put together.
    With a ``roster`` only countermodels are found, on a road of just its lanes and lanelets. ``sparing``:
    nothing is instantiated where the model already has what is enough for it at that moment.
    """

    def __init__(
        self,
        claim: Formula,
        states: StateChecker,
        lanes: Sequence[str],
        names: dict[Site, str],
        wishful: bool,
        roster: Roster | None = None,
        sparing: bool = False,
    ) -> None:
        bounds = dict(states.bounds)
        prefixes = free_prefix("t", bounds), free_prefix("M", {*lanes, *road_names(claim)})
        self.grounding = Grounding(
            states.atoms, bounds, prefixes, bound_parameters(claim), wishful, names, roster
        )
        if roster is not None:
            self.grounding.elements |= roster.elements()
        self.grounding.elements |= dict.fromkeys(lanes, f.Domain("lanes"))
        self.grounding.elements |= dict.fromkeys(free_lanelets(claim), f.Domain("lanelets"))
        if not self.grounding.elements:
            # Every road has a lane: one of the claim's own variables stands for it.
            variables = sorted({x.variable for x in open_quantifiers(claim)})
            self.grounding.elements |= dict.fromkeys(variables[:1], f.Domain("lanes"))
        self.states = states
        self.sparing = sparing
        self.claim = claim if is_plain(claim) else None
        self.bound_moments = _bounds_of(claim)
        for bound in self.bound_moments:
            self.grounding.declare_moment(bound)
        self.spread = 0
        self.grounding.deny(claim)

    def run(self, meter: Budget) -> Proof | Model | GaveUp:
        """A proof, a candidate countermodel, or why neither was found with what ``meter`` had left.

        May be called again: with more work, or after ``widen``. Raises ``BudgetExceeded``.
        """
        for _ in range(MOST_ROUNDS):
            if meter.is_out():
                return GaveUp(meter.reason())
            answer = self._check(meter)
            if answer == "unsat" and self.grounding.roster is not None:
                return GaveUp(Why.FEW_LANES(), Stop.PLACE)
            if answer == "unsat":
                return self._shrink(meter)
            if answer == "unknown":
                out = meter.is_out()
                if out:
                    return GaveUp(meter.reason())
                return GaveUp(Why.GROUND_QUERY(), Stop.SOLVER)
            values = self._values()
            if self._instantiate(values, meter, flat_only=self.sparing):
                if len(self.grounding.elements) > MOST_ELEMENTS:
                    return GaveUp(Why.ELEMENTS(MOST_ELEMENTS), Stop.LANES)
                continue
            states, refused = self._refused(values, meter)
            if isinstance(refused, GaveUp):
                return refused
            if refused is None and not (self.sparing and self._look_on(values, meter)):
                signals = {instant: self.states.signals(state) for instant, state in states.items()}
                return Model(values, states, signals, dict(self.grounding.elements), self._facts())
        return GaveUp(Why.ROUNDS(MOST_ROUNDS), Stop.ROUNDS)

    def _look_on(self, values: dict[str, Fraction], meter: Budget) -> bool:
        """Instantiate also what speaks of further moments; whether there is more to be looked at.

        What was asked of the model without being told to the solver yet has to be possible, too.
        """
        known = len(self.grounding.applied)
        return self._instantiate(values, meter) or len(self.grounding.applied) > known

    def close(self) -> None:
        """Give back the solver, which lives as long as the grounding that refers to itself."""
        self.grounding.session.close()

    def widen(self) -> bool:
        """Add moments between and around those known; False where that was done often enough."""
        if self.spread >= 3:
            return False
        self.spread += 1
        return True

    def _check(self, meter: Budget) -> Satisfiability:
        """Check all clauses, giving up the latest wish that stands in the way until none does.

        Wishes make the query harder; all are given up where they cost more than ``WISH``.
        """
        session, grounding = self.grounding.session, self.grounding
        while grounding.wishes:
            answer = session.check([*grounding.switches, *grounding.wishes], meter.part(WISH))
            if answer == "sat":
                return answer
            if answer == "unknown":
                grounding.wishes.clear()
                break
            blamed = set(session.core()) & set(grounding.wishes)
            if not blamed:
                return answer
            grounding.wishes.remove(max(blamed, key=grounding.wishes.index))
        return session.check(list(grounding.switches), meter)

    # --- one round -------------------------------------------------------------------------------

    def _values(self) -> dict[str, Fraction]:
        """Values of all named times and parameters in the current model."""
        grounding = self.grounding
        names = [name for name in grounding.names.values() if at(name) in grounding.moments]
        names += grounding.known_parameters()
        read = grounding.session.values([constant(name) for name in names])
        return {n: v for n, v in zip(names, read, strict=True) if isinstance(v, Fraction)}

    def _pool(self, values: Mapping[str, Fraction]) -> dict[Fraction, Moment]:
        """A known moment for each value, the simplest; also shifted by interval bounds after ``widen``."""
        pool: dict[Fraction, Moment] = {}
        for moment in self.grounding.moments:
            pool.setdefault(moment.value(values), moment)
        frontier = dict(pool)
        bounds = [(bound, bound.value(values)) for bound in self.bound_moments]
        for _ in range(self.spread):
            shifted: dict[Fraction, Moment] = {}
            for value, moment in frontier.items():
                for bound, by in bounds:
                    if value + by not in pool:
                        shifted.setdefault(value + by, moment + bound)
                    if value - by not in pool and value >= by:
                        shifted.setdefault(value - by, moment - bound)
            pool |= shifted
            frontier = shifted
        return pool

    def _instantiate(self, values: dict[str, Fraction], meter: Budget, flat_only: bool = False) -> bool:
        """Instantiate what the model violates; whether there was anything.

        ``flat_only``: but for what speaks of further moments.
        """
        grounding = self.grounding
        switches = [u.switch for u in grounding.universals] + [u.switch for u in grounding.road_universals]
        active = {s for s, on in zip(switches, grounding.session.values(switches), strict=True) if on}
        wanted: list[tuple[Universal, Moment]] = []
        pool = self._pool(values)
        meter.spend(LOOK * len(pool) * len(active))
        for universal in grounding.universals:
            if universal.switch in active:
                wanted += [(universal, moment) for moment in _missing(universal, pool, values)]
        flat = [(u, m, u.body(m)) for u, m in wanted if u.is_flat]
        chosen = [(u, m) for u, m in wanted if not u.is_flat]
        if self.sparing:
            flat += [] if flat_only else [(u, m, u.easily(m)) for u, m in chosen]
            chosen = []
        truths = grounding.session.values([body for _, _, body in flat])
        chosen += [(u, m) for (u, m, _), true in zip(flat, truths, strict=True) if not true]
        meter.spend(INSTANCE * len(chosen))
        for universal, moment in chosen:
            grounding.instantiate(universal, moment)
        found = bool(chosen)
        for road in list(grounding.road_universals):
            if road.switch in active:
                for element in [e for e in grounding.elements if e not in road.done]:
                    grounding.instantiate_road(road, element)
                    found = True
        return found

    def _states(self, values: dict[str, Fraction]) -> dict[Fraction, dict[str, bool]]:
        """Which atoms the model makes true, by instant; atoms that it leaves open are not listed."""
        applied = list(self.grounding.applied.items())
        truths = self.grounding.session.values([text for _, text in applied])
        states: dict[Fraction, dict[str, bool]] = {ZERO.value(values): {}}
        for ((name, moment), _), true in zip(applied, truths, strict=True):
            instant = moment.value(values)
            # A time that no obligation of the model speaks of may lie before 0, where there is nothing.
            if instant >= 0 and f.is_state(self.states.atoms.meaning(name)):
                states.setdefault(instant, {})[name] = bool(true)
        return dict(sorted(states.items()))

    def _facts(self) -> dict[tuple[f.Domain, str], bool]:
        """Memberships of lanes and lanelets in the model."""
        facts = self.grounding.facts
        truths = self.grounding.session.values([f"|{membership(*fact)}|" for fact in facts])
        return {fact: bool(true) for fact, true in zip(facts, truths, strict=True)}

    def _refused(self, values: dict[str, Fraction], meter: Budget) -> tuple[States, bool | GaveUp | None]:
        """The states of the model, and what ``_lemmas`` says of them.

        Of a claim about one instant, what makes it false there is asked about first, and all else only where
        that has no quick answer: more may help to divide a state into cases.
        """
        states = self._states(values)
        if self.claim is not None:
            brief = {when: reason(self.claim, False, state) or state for when, state in states.items()}
            refused = self._lemmas(brief, values, meter, BRIEFLY)
            if not isinstance(refused, GaveUp):
                return brief, refused
        return states, self._lemmas(states, values, meter)

    def _lemmas(
        self, states: States, values: dict[str, Fraction], meter: Budget, case: float = CASE
    ) -> bool | GaveUp | None:
        """Turn impossible states into lemmas; None where every state is possible."""
        learnt = False
        for instant, state in states.items():
            clause = self.states.refute(state, meter, case)
            if isinstance(clause, Reason):
                return GaveUp(clause, Stop.WORK if meter.is_out() else Stop.SOLVER)
            if clause is not None:
                learnt = True
                for moment in self._moments_at(instant, values):
                    self.grounding.add_lemma(clause, moment)
        return True if learnt else None

    def _moments_at(self, instant: Fraction, values: dict[str, Fraction]) -> list[Moment]:
        moments = dict.fromkeys(m for _, m in self.grounding.applied if m.value(values) == instant)
        return list(moments)

    # --- a proof ---------------------------------------------------------------------------------

    def _shrink(self, meter: Budget) -> Proof:
        """The clauses that the last refutation needs, each one of them."""
        session = self.grounding.session
        needed = session.core()
        for switch in list(needed):
            without = [s for s in needed if s != switch]
            if session.check(without, meter.apart(WISH)) == "unsat":
                needed = without
        needed = self._with_origins(needed)
        instances: dict[Site, list[str]] = {}
        lemmas: dict[tuple[tuple[str, bool], ...], list[str]] = {}
        for switch in sorted(needed, key=lambda s: int(s[2:])):
            used = self.grounding.switches[switch]
            if isinstance(used, Lemma):
                lemmas.setdefault(used.literals, []).extend(used.moments)
            else:
                instances.setdefault(used[0], []).append(used[1])
        return Proof(
            {site: tuple(texts) for site, texts in instances.items()},
            tuple(Lemma(literals, tuple(moments)) for literals, moments in lemmas.items()),
            frozenset(self.states.settled),
        )

    def _with_origins(self, needed: Sequence[str]) -> list[str]:
        """``needed``, and the clauses in which the names that they speak of were met."""
        known, waiting = dict.fromkeys(needed), list(needed)
        while waiting:
            used = self.grounding.switches[waiting.pop()]
            texts = used.moments if isinstance(used, Lemma) else (used[1],)
            for name in (name for text in texts for name, _ in read_moment(text).parts):
                origin = self.grounding.origins.get(name)
                if origin and origin not in known:
                    known[origin] = None
                    waiting.append(origin)
        return list(known)


def _missing(
    universal: Universal, pool: Mapping[Fraction, Moment], values: dict[str, Fraction]
) -> list[Moment]:
    """The moments of ``pool`` inside the window at whose value there is no instance yet."""
    seen = {moment.value(values) for moment in universal.done}
    return [pool[instant] for instant in universal.window.inside(pool, values) if instant not in seen]


def _bounds_of(formula: Formula) -> list[Moment]:
    """The distinct interval bounds of an abstracted formula, but for zero and those inside of atoms."""
    found: dict[Moment, None] = {}
    waiting = [formula]
    while waiting:
        current = waiting.pop()
        if isinstance(current, f.Application):
            continue
        waiting += reversed(f.children(current))
        for interval in f.intervals(current):
            for bound in (interval.low, interval.high):
                if bound is not None:
                    found[moment_of(bound)] = None
    return [moment for moment in found if moment != ZERO]
