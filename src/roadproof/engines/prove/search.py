"""The search for a proof or for a countermodel over finitely many moments.

Model-based instantiation: the solver proposes a model of the ground clauses. Universals that the model
violates at a known moment are instantiated there. When none is left, the states at its moments are
checked one by one, and impossible ones become lemmas. If all are possible, the model is a candidate
countermodel. If the clauses have no model, the claim is proved, and unneeded instances are dropped.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

from roadproof.engines.prove.grounding import Grounding, Universal
from roadproof.engines.prove.roads import Roster, open_quantifiers
from roadproof.engines.prove.states import CASE, StateChecker, deciding_atoms, is_propositional
from roadproof.engines.prove.unknown import StopPoint
from roadproof.engines.solve.smt import Satisfiability
from roadproof.evidence.derivation import free_prefix
from roadproof.evidence.road_axioms import membership
from roadproof.evidence.sites import Site, StateLemma
from roadproof.evidence.times import (
    ZERO,
    Moment,
    bound_parameters,
    constant,
    moment_of,
    named_moment,
    read_moment,
)
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import free_lanelets, road_names
from roadproof.reasons import Reason, ReasonKind
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
    """The instances and lemmas from which ``evidence.derivation`` derives the ground query again.

    ``unsat_queries`` are queries of lemmas that z3 has already answered unsat.
    """

    instances: Mapping[Site, tuple[str, ...]]
    lemmas: tuple[StateLemma, ...]
    unsat_queries: frozenset[str]


@dataclass(frozen=True)
class Model:
    """A model of all clauses: the moments in time, and the atoms that are true there.

    ``states`` gives each instant its atoms, and ``signals`` each instant a state in which they hold.
    ``elements`` are the lanes and lanelets of the clauses, with the domain that each was taken from, and
    ``facts`` says which are in which domain.
    """

    values: Mapping[str, Fraction]
    states: States
    signals: Mapping[Fraction, Mapping[str, Fraction | bool]]
    elements: Mapping[str, f.Domain]
    facts: Mapping[tuple[f.Domain, str], bool]


@dataclass(frozen=True)
class NoAnswer:
    """The reason for neither proof nor model, in words, and where the search stopped."""

    reason: Reason
    stop: StopPoint = StopPoint.WORK


class InstanceSearch:
    """One search on one claim, with one way of choosing models.

    ``prefer_known_times``: ask for models with few instants, which finds countermodels sooner and hard
    proofs later. ``names`` is shared between searches whose proofs are combined. With a ``roster`` only
    countermodels are found, on a road of just its lanes and lanelets. ``sparing``: no instance where the
    model already satisfies a sufficient local condition.
    """

    def __init__(
        self,
        claim: Formula,
        states: StateChecker,
        lanes: Sequence[str],
        names: dict[Site, str],
        prefer_known_times: bool,
        roster: Roster | None = None,
        sparing: bool = False,
    ) -> None:
        bounds = dict(states.bounds)
        prefixes = free_prefix("t", bounds), free_prefix("M", {*lanes, *road_names(claim)})
        self.grounding = Grounding(
            states.atoms, bounds, prefixes, bound_parameters(claim), prefer_known_times, names, roster
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
        self.claim = claim if is_propositional(claim) else None
        self.bound_moments = _interval_bounds(claim)
        for bound in self.bound_moments:
            self.grounding.declare_moment(bound)
        self.spread = 0
        self.grounding.deny(claim)

    def run(self, meter: Budget) -> Proof | Model | NoAnswer:
        """Return a proof, a candidate countermodel, or why neither was found within ``meter``.

        May be called again: with more work, or after ``widen``. Raises ``BudgetExceeded``.
        """
        for _ in range(MOST_ROUNDS):
            if meter.is_exhausted():
                return NoAnswer(meter.reason())
            answer = self._check(meter)
            if answer == "unsat" and self.grounding.roster is not None:
                return NoAnswer(ReasonKind.FEW_LANES(), StopPoint.PLACE)
            if answer == "unsat":
                return self._shrink(meter)
            if answer == "unknown":
                out = meter.is_exhausted()
                if out:
                    return NoAnswer(meter.reason())
                return NoAnswer(ReasonKind.GROUND_QUERY(), StopPoint.SOLVER)
            values = self._values()
            if self._instantiate(values, meter, flat_only=self.sparing):
                if len(self.grounding.elements) > MOST_ELEMENTS:
                    return NoAnswer(ReasonKind.ELEMENTS(MOST_ELEMENTS), StopPoint.LANES)
                continue
            states, refused = self._refused(values, meter)
            if isinstance(refused, NoAnswer):
                return refused
            if refused is None and not (self.sparing and self._look_on(values, meter)):
                signals = {instant: self.states.signals(state) for instant, state in states.items()}
                return Model(values, states, signals, dict(self.grounding.elements), self._facts())
        return NoAnswer(ReasonKind.ROUNDS(MOST_ROUNDS), StopPoint.ROUNDS)

    def _look_on(self, values: dict[str, Fraction], meter: Budget) -> bool:
        """Instantiate also conditions on further moments; return whether the model must be checked again.

        Conditions that the model was asked for and the solver does not know yet have to be possible, too.
        """
        known = len(self.grounding.applied)
        return self._instantiate(values, meter) or len(self.grounding.applied) > known

    def close(self) -> None:
        """Release the solver, which lives as long as the grounding that refers to itself."""
        self.grounding.session.close()

    def widen(self) -> bool:
        """Add moments between and around those known; False where that was done often enough."""
        if self.spread >= 3:
            return False
        self.spread += 1
        return True

    def _check(self, meter: Budget) -> Satisfiability:
        """Check all clauses; drop the latest preference that is in conflict, until none is.

        Preferences make the query harder; all are dropped where they cost more than ``WISH``.
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
        names = [name for name in grounding.names.values() if named_moment(name) in grounding.moments]
        names += grounding.known_parameters()
        read = grounding.session.values([constant(name) for name in names])
        return {n: v for n, v in zip(names, read, strict=True) if isinstance(v, Fraction)}

    def _pool(self, values: Mapping[str, Fraction]) -> dict[Fraction, Moment]:
        """Return the simplest moment for each value; after ``widen`` also shifted by interval bounds."""
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
        """Instantiate universals that the model violates; return whether there were any.

        ``flat_only``: skip those about further moments.
        """
        grounding = self.grounding
        switches = [u.switch for u in grounding.universals] + [u.switch for u in grounding.road_universals]
        active = {s for s, on in zip(switches, grounding.session.values(switches), strict=True) if on}
        violated: list[tuple[Universal, Moment]] = []
        pool = self._pool(values)
        meter.spend(LOOK * len(pool) * len(active))
        for universal in grounding.universals:
            if universal.switch in active:
                violated += [(universal, moment) for moment in _missing_moments(universal, pool, values)]
        flat = [(u, m, u.body(m)) for u, m in violated if u.is_flat]
        chosen = [(u, m) for u, m in violated if not u.is_flat]
        if self.sparing:
            flat += [] if flat_only else [(u, m, u.locally(m)) for u, m in chosen]
            chosen = []
        truths = grounding.session.values([body for _, _, body in flat])
        chosen += [(u, m) for (u, m, _), true in zip(flat, truths, strict=True) if not true]
        meter.spend(INSTANCE * len(chosen))
        for universal, moment in chosen:
            grounding.instantiate(universal, moment)
        moments = bool(chosen)
        for road in list(grounding.road_universals):
            if road.switch in active:
                for element in [e for e in grounding.elements if e not in road.done]:
                    grounding.instantiate_road(road, element)
                    moments = True
        return moments

    def _states(self, values: dict[str, Fraction]) -> dict[Fraction, dict[str, bool]]:
        """Return the atoms that the model makes true or false, by instant; undetermined ones are left out."""
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

    def _refused(self, values: dict[str, Fraction], meter: Budget) -> tuple[States, bool | NoAnswer | None]:
        """Return the states of the model, and the result of ``_lemmas`` for them.

        For a claim about one instant, the atoms that make it false there come first, and all others only if
        that gives no quick answer: more atoms may help to split a state into cases.
        """
        states = self._states(values)
        if self.claim is not None:
            brief = {
                when: deciding_atoms(self.claim, False, state) or state for when, state in states.items()
            }
            refused = self._lemmas(brief, values, meter, BRIEFLY)
            if not isinstance(refused, NoAnswer):
                return brief, refused
        return states, self._lemmas(states, values, meter)

    def _lemmas(
        self, states: States, values: dict[str, Fraction], meter: Budget, case: float = CASE
    ) -> bool | NoAnswer | None:
        """Turn impossible states into lemmas; None where every state is possible."""
        learnt = False
        for instant, state in states.items():
            clause = self.states.refute(state, meter, case)
            if isinstance(clause, Reason):
                return NoAnswer(clause, StopPoint.WORK if meter.is_exhausted() else StopPoint.SOLVER)
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
        """Return a proof from the clauses of the last refutation, without those it can do without."""
        session = self.grounding.session
        needed = session.core()
        for switch in list(needed):
            without = [s for s in needed if s != switch]
            if session.check(without, meter.separate(WISH)) == "unsat":
                needed = without
        needed = self._with_origins(needed)
        instances: dict[Site, list[str]] = {}
        lemmas: dict[tuple[tuple[str, bool], ...], list[str]] = {}
        for switch in sorted(needed, key=lambda s: int(s[2:])):
            used = self.grounding.switches[switch]
            if isinstance(used, StateLemma):
                lemmas.setdefault(used.literals, []).extend(used.moments)
            else:
                instances.setdefault(used[0], []).append(used[1])
        return Proof(
            {site: tuple(texts) for site, texts in instances.items()},
            tuple(StateLemma(literals, tuple(moments)) for literals, moments in lemmas.items()),
            frozenset(self.states.unsat_queries),
        )

    def _with_origins(self, needed: Sequence[str]) -> list[str]:
        """Return ``needed`` and the clauses in which its names first occurred."""
        known, waiting = dict.fromkeys(needed), list(needed)
        while waiting:
            used = self.grounding.switches[waiting.pop()]
            texts = used.moments if isinstance(used, StateLemma) else (used[1],)
            for name in (name for text in texts for name, _ in read_moment(text).parts):
                origin = self.grounding.origins.get(name)
                if origin and origin not in known:
                    known[origin] = None
                    waiting.append(origin)
        return list(known)


def _missing_moments(
    universal: Universal, pool: Mapping[Fraction, Moment], values: dict[str, Fraction]
) -> list[Moment]:
    """The moments of ``pool`` inside the window at whose value there is no instance yet."""
    seen = {moment.value(values) for moment in universal.done}
    return [pool[instant] for instant in universal.window.inside(pool, values) if instant not in seen]


def _interval_bounds(formula: Formula) -> list[Moment]:
    """The distinct interval bounds of an abstracted formula, but for zero and those inside of atoms."""
    moments: dict[Moment, None] = {}
    waiting = [formula]
    while waiting:
        current = waiting.pop()
        if isinstance(current, f.Application):
            continue
        waiting += reversed(f.children(current))
        for interval in f.intervals(current):
            for bound in (interval.low, interval.high):
                if bound is not None:
                    moments[moment_of(bound)] = None
    return [moment for moment in moments if moment != ZERO]
