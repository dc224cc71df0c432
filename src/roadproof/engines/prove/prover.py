"""Decides one claim: PROVED with a certificate, REFUTED with a judged countermodel, or UNKNOWN."""

import math
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import field, replace
from fractions import Fraction
from functools import lru_cache

from roadproof.engines.prove.claim_parts import claim_conjuncts, other_readings, premise_of
from roadproof.engines.prove.countermodel import realise, with_truths
from roadproof.engines.prove.lasso import find_lasso
from roadproof.engines.prove.roads import Roster, roster_for
from roadproof.engines.prove.search import InstanceSearch, Model, NoAnswer, Proof
from roadproof.engines.prove.states import StateCache, StateChecker
from roadproof.engines.prove.unknown import StopPoint
from roadproof.engines.solve.recall import check_sat
from roadproof.errors import InputError
from roadproof.evidence.atoms import Atoms, Reading
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certify import certify, goal_of
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.derivation import derive_query, met_sites
from roadproof.evidence.sites import Site, StateLemma, prefix_form
from roadproof.evidence.times import ZERO
from roadproof.evidence.verdict_with_evidence import VerdictWithEvidence
from roadproof.library import motion
from roadproof.library.assumption import NOTHING, Assumption, assumes_motion, limits_in
from roadproof.library.bind import default_values
from roadproof.library.specification import Query, Specification, satisfies_bound
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import forced_values
from roadproof.logic.rewrite import with_values
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.budget import Budget, Effort
from roadproof.runtime.progress import report_stage
from roadproof.runtime.records import dataclass
from roadproof.runtime.timing import now, seconds_since
from roadproof.verdict import ClaimVerdict, Verdict

# Ways to look, in turns: (ask for few instants, units of work). The last is given what is left.
TURNS: tuple[tuple[bool, float], ...] = (
    (False, 0.3),
    (True, 0.5),
    (False, 3.0),
    (True, 6.0),
    (False, 20.0),
    (True, math.inf),
)
ON_FEW_LANES = 1.0
REPEATING = 1.0
VACUITY = 0.5
OTHERWISE = 2.0  # for each other reading of what is a predicate


@dataclass(frozen=True)
class ProverResult(VerdictWithEvidence[ClaimVerdict]):
    """A verdict over dense, unbounded time; ``reason`` explains UNKNOWN and VACUOUS.

    ``work``: the units spent on the search. Exactly PROVED and VACUOUS have a ``certificate``. UNKNOWN has
    ``stop``, where the search stopped.
    """

    work: float = 0.0
    countermodel: Countermodel | None = None
    stop: StopPoint | None = None

    def called(self, label: str = "", scenario: int | None = None) -> "ProverResult":
        """Return the result with the claim's label and scenario in its certificate."""
        if self.certificate is None:
            return self
        return replace(self, certificate=replace(self.certificate, property=label, scenario=scenario))


def prove(
    specification: Specification,
    query: Query,
    effort: Effort | None = None,
    assumed: Assumption = NOTHING,
) -> ProverResult:
    """Decide whether ``query`` holds at time 0 on all traces, for all values of its parameters.

    Parameters keep their declared bounds and are otherwise arbitrary, as are lengths and widths above zero,
    roads, and signals as functions of time. Values that ``assumed`` or the claim's premise fix are put in
    first. A proof counts only once its certificate, derived separately, has been answered unsat. Where motion
    is ``assumed`` nothing is refuted: a trace that has it at finitely many instants need be no motion.
    Raises ``BudgetExceeded``; ``InputError`` for forbidden assumptions.
    """
    started, effort = now(), (effort or Effort()).with_clock_started()
    if f.looks_back(query.formula):
        return ProverResult(
            verdict=Verdict.UNKNOWN, reason=ReasonKind.TOLD(f.NO_PAST), stop=StopPoint.PAST, seconds=0.0
        )
    result = _prove(specification, query, effort, assumed)
    brief = effort.with_units(min(OTHERWISE, effort.units))
    for reading in other_readings(query.formula):
        if result.verdict is not Verdict.UNKNOWN or result.stop is StopPoint.CERTIFICATE:
            break
        again = _prove(specification, query, brief, assumed, reading)
        result = replace(again if again.holds else result, work=result.work + again.work)
    return replace(result, seconds=seconds_since(started))


def _prove(
    specification: Specification,
    query: Query,
    effort: Effort,
    assumed: Assumption,
    reading: Reading = "states",
) -> ProverResult:
    """Decide the claim under one choice of atoms; under other choices than the default only proofs count."""
    started = now()
    meter = effort.meter()
    here = motion.values_in(specification, assumed.texts)
    demanded = _forced_values(specification, query, here)
    pinned = motion.value_texts(specification, demanded)
    values = {**here, **demanded}
    states = _state_checker(specification, values, None, reading)
    premise, claim = goal_of(specification, query, assumed, states.atoms, pinned)
    attempt = _ProofAttempt(specification, query, states, meter, assumes_motion(assumed.texts))

    def result(
        verdict: ClaimVerdict, reason: Reason = NO_REASON, sure: Certificate | None = None
    ) -> ProverResult:
        """Return a result with the work and time spent so far."""
        spent, seconds = meter.spent, seconds_since(started)
        return ProverResult(spent, verdict=verdict, reason=reason, certificate=sure, seconds=seconds)

    proofs: list[Proof] = []
    for goal in claim_conjuncts(claim):
        outcome = attempt.decide(f.implication(premise, goal))
        if isinstance(outcome, Countermodel):
            return replace(result(Verdict.REFUTED), countermodel=with_truths(outcome, states.atoms))
        if isinstance(outcome, NoAnswer):
            return replace(result(Verdict.UNKNOWN, outcome.reason), stop=outcome.stop)
        proofs.append(outcome)
    fewer = attempt.needed(assumed, values, proofs)
    if fewer != assumed:
        again = _prove(specification, query, meter.effort(), fewer, reading)
        if again.verdict is Verdict.PROVED and attempt.never_holds(premise, f.TRUE):
            again = replace(again, verdict=Verdict.VACUOUS, reason=ReasonKind.CONTRADICTION())
        if again.holds:
            return replace(again, seconds=seconds_since(started), work=meter.spent + again.work)
    try:
        certificate = attempt.certificate(assumed, pinned, proofs)
    except InputError as error:
        return replace(result(Verdict.UNKNOWN, ReasonKind.NO_CERTIFICATE(error)), stop=StopPoint.CERTIFICATE)
    rejected = _rejection(certificate, proofs, meter)
    if rejected is not None:
        return replace(
            result(*rejected), stop=StopPoint.CERTIFICATE if rejected[0] is Verdict.UNKNOWN else None
        )
    if premise != f.TRUE and attempt.never_holds(premise, f.TRUE):
        return result(Verdict.VACUOUS, ReasonKind.CONTRADICTION(), certificate)
    condition = premise_of(query, claim)
    if condition is not None and attempt.never_holds(premise, condition):
        return result(Verdict.VACUOUS, ReasonKind.PREMISE(), certificate)
    return result(Verdict.PROVED, NO_REASON, certificate)


def _rejection(
    certificate: Certificate, proofs: Sequence[Proof], meter: Budget
) -> tuple[ClaimVerdict, Reason] | None:
    """Return verdict and reason where z3 does not confirm a query of the certificate; else None.

    Queries that the search for the ``proofs`` already put to z3 are not repeated.
    """
    confirmed = frozenset[str]().union(*(proof.unsat_queries for proof in proofs))
    for title, script in certificate.queries:
        if script in confirmed:
            continue
        answer = check_sat(script, meter=meter.separate(max(1.0, meter.left())))
        if answer != "unsat":
            why = ReasonKind.UNCONFIRMED(answer, title)
            return (Verdict.UNKNOWN if answer == "unknown" else Verdict.CROSSCHECK_FAILED), why
    return None


class ProofHeuristic:
    """A quick test for proofs of similar claims, without certificates.

    Knowledge of states is shared between claims. The answer proves nothing: it tells for which claim
    ``prove`` is worth the work.
    """

    def __init__(self, specification: Specification) -> None:
        self.specification = specification
        self.learnt: dict[tuple[str, ...], StateCache] = {}

    def has_proof(self, query: Query, effort: Effort) -> tuple[bool, float]:
        """Return whether ``query`` is proved, and the units of work it took. Raises ``BudgetExceeded``."""
        meter = effort.meter()
        values = _forced_values(self.specification, query, {})
        pinned = motion.value_texts(self.specification, values)
        states = _state_checker(self.specification, values, self.learnt.setdefault(pinned, StateCache()))
        premise, claim = goal_of(self.specification, query, NOTHING, states.atoms, pinned)
        attempt = _ProofAttempt(self.specification, query, states, meter, False)
        goals = (f.implication(premise, goal) for goal in claim_conjuncts(claim))
        return all(isinstance(attempt.decide(goal), Proof) for goal in goals), meter.spent


def _state_checker(
    specification: Specification,
    values: Mapping[str, Fraction],
    learnt: StateCache | None = None,
    reading: Reading = "states",
) -> StateChecker:
    """Return the checker of states for the atoms of one claim, with parameters at ``values``."""
    library = specification.library
    return StateChecker(Atoms(reading=reading), library.bounds, {**default_values(library), **values}, learnt)


def _forced_values(
    specification: Specification, query: Query, here: Mapping[str, Fraction]
) -> dict[str, Fraction]:
    """Return the values that the claim's own premise forces, as far as parameters may have them."""
    library = specification.library
    forced = forced_values(with_values(query.formula, here))
    return {name: x for name, x in forced.items() if satisfies_bound(library.bounds[name], x)}


@lru_cache(maxsize=256)
def _is_quickly_proved(
    goal: Formula,
    lanes: tuple[str, ...],
    bounds: tuple[tuple[str, str], ...],
    defaults: tuple[tuple[str, Fraction], ...],
) -> bool:
    """Return whether ``goal``, a formula of atoms, has a quick proof whose derived query is unsat, too.

    Memoised, since many claims share a premise. It depends on the arguments alone: nothing is learnt from
    other claims.
    """
    atoms, names, budget = Atoms(), dict[Site, str](), Effort(VACUITY)
    goal = atoms.abstract(goal)
    states = StateChecker(atoms, dict(bounds), dict(defaults))
    with closing(InstanceSearch(goal, states, lanes, names, True)) as search:
        proof = search.run(budget.meter())
    if not isinstance(proof, Proof):
        return False
    met = met_sites(goal, atoms, proof.instances, names, states.bounds, lanes)
    query = derive_query(goal, atoms, *met, proof.lemmas, states.bounds, lanes)
    return check_sat(query, meter=budget.meter()) == "unsat"


@dataclass(frozen=True)
class _ProofAttempt:
    """One attempt to decide a claim; ``names``: the shared names of elements and times in all its proofs."""

    specification: Specification
    query: Query
    states: StateChecker
    meter: Budget
    moving: bool
    names: dict[Site, str] = field(default_factory=dict)

    @property
    def refutes(self) -> bool:
        """Return whether a model is made into a trace."""
        return not self.moving and self.states.atoms.reading == "states"

    def decide(self, goal: Formula) -> Proof | Countermodel | NoAnswer:
        """Look for a proof and for a countermodel in turns, until one is found or the work is used up."""
        last = NoAnswer(self.meter.reason())
        turns = TURNS[-1:] if f.is_state(goal) else TURNS
        roster = roster_for(goal, self.query.lanes) if self.refutes else None
        for number, (prefer_known_times, units) in enumerate(turns, 1):
            report_stage("prove", f"turn {number} of {len(turns)}")
            if roster is not None and number == len(turns[:2]):
                few = self._run(self._search(goal, {}, True, roster), self.meter.part(ON_FEW_LANES))
                if isinstance(few, Countermodel):
                    return few
            if number == len(turns[:3]) and self.refutes:
                repeating = find_lasso(self.query, goal, self.states, self.meter.part(REPEATING))
                if repeating is not None:
                    return repeating
            outcome = self._run(self._search(goal, self.names, prefer_known_times), self.meter.part(units))
            if not isinstance(outcome, NoAnswer):
                return outcome
            last = outcome
            if self.meter.is_exhausted():
                break
        return last

    def _run(self, search: InstanceSearch, meter: Budget) -> Proof | Countermodel | NoAnswer:
        """Run one search; models are made into traces and judged."""
        with closing(search):
            return self._run_to_end(search, meter)

    def _run_to_end(self, search: InstanceSearch, meter: Budget) -> Proof | Countermodel | NoAnswer:
        outcome = search.run(meter)
        while not isinstance(outcome, Proof | NoAnswer):
            countermodel = self._realised(outcome) if self.refutes else None
            if countermodel is not None:
                return countermodel
            if not search.widen():
                return (
                    NoAnswer(ReasonKind.FACTS(), StopPoint.FACTS)
                    if self.moving
                    else NoAnswer(ReasonKind.TRACES(), StopPoint.PLACE)
                )
            outcome = search.run(meter)
        return outcome

    def _realised(self, model: Model) -> Countermodel | None:
        return realise(self.query, self.states, model)

    def never_holds(self, premise: Formula, condition: Formula) -> bool:
        """Return whether a quick proof shows that ``condition`` is false under ``premise``."""
        goal = f.implication(premise, f.negation(condition))
        states = self.states
        return _is_quickly_proved(
            goal, tuple(self.query.lanes), tuple(states.bounds.items()), tuple(states.defaults.items())
        )

    def _search(
        self, goal: Formula, names: dict[Site, str], prefer_known_times: bool, roster: Roster | None = None
    ) -> InstanceSearch:
        return InstanceSearch(
            goal, self.states, self.query.lanes, names, prefer_known_times, roster, self.moving
        )

    def certificate(
        self, assumed: Assumption, pinned: tuple[str, ...], proofs: Sequence[Proof]
    ) -> Certificate:
        """Return the proofs of all parts as one certificate. Raises ``InputError`` where they do not fit."""
        lemmas: dict[tuple[tuple[str, bool], ...], tuple[str, ...]] = {}
        for proof in proofs:
            for lemma in proof.lemmas:
                before = lemmas.get(lemma.literals, ())
                lemmas[lemma.literals] = tuple(dict.fromkeys([*before, *lemma.moments]))
        atoms = Atoms(reading=self.states.atoms.reading)
        claim = f.implication(*goal_of(self.specification, self.query, assumed, atoms, pinned))
        met = self._met(claim, atoms, proofs)
        made = tuple(StateLemma(literals, moments) for literals, moments in lemmas.items())
        return certify(
            self.specification,
            self.query,
            met,
            made,
            assumed=assumed,
            pinned_and_reading=(pinned, self.states.atoms.reading),
        )

    def needed(
        self, assumed: Assumption, values: Mapping[str, Fraction], proofs: Sequence[Proof]
    ) -> Assumption:
        """Return the assumption reduced to the premises that the proofs used and the claim lacks.

        Each premise is a universal that holds at time 0.
        """
        if not assumed.axioms and not limits_in(assumed.texts):
            return Assumption(assumed.texts)
        instances, atoms = _instances(proofs), Atoms(reading=self.states.atoms.reading)
        own, _ = self._met(atoms.abstract(with_values(self.query.formula, values)), atoms, proofs)

        def is_used(formula: Formula) -> bool:
            made = atoms.abstract(with_values(formula, values))
            site = Site(prefix_form(made), True, str(ZERO))
            return site in instances and site not in own

        home, query = self.specification, self.query
        axioms = tuple(x for x in assumed.axioms if is_used(motion.axiom_formula(home, query, x)))
        used = {x for x, made in motion.limit_formulas(home, query, assumed).items() if is_used(made)}
        return Assumption(assumed.texts, axioms, tuple(x for x in limits_in(assumed.texts) if x not in used))

    def _met(
        self, claim: Formula, atoms: Atoms, proofs: Sequence[Proof]
    ) -> tuple[dict[Site, tuple[str, ...]], dict[Site, str]]:
        """Return the instances of proofs, and their names, that a derivation from the claim reaches."""
        bounds = self.specification.library.bounds
        return met_sites(claim, atoms, _instances(proofs), self.names, bounds, self.query.lanes)


def _instances(proofs: Sequence[Proof]) -> dict[Site, tuple[str, ...]]:
    """The instances of several proofs, each once."""
    instances: dict[Site, tuple[str, ...]] = {}
    for proof in proofs:
        for site, texts in proof.instances.items():
            instances[site] = tuple(dict.fromkeys([*instances.get(site, ()), *texts]))
    return instances
