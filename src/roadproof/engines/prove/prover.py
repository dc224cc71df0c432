"""One claim, one verdict: PROVED with a certificate, REFUTED with a judged countermodel, or UNKNOWN."""

import math
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import field, replace
from fractions import Fraction
from functools import lru_cache

from roadproof.engines.prove.claim_parts import conjuncts, other_readings, premise_of
from roadproof.engines.prove.countermodel import realise, with_truths
from roadproof.engines.prove.doubt import Doubt, Stop
from roadproof.engines.prove.lasso import find_lasso
from roadproof.engines.prove.roads import Roster, roster_for
from roadproof.engines.prove.search import GaveUp, InstanceSearch, Model, Proof
from roadproof.engines.prove.states import Learnt, StateChecker
from roadproof.engines.solve.recall import ask
from roadproof.errors import InputError
from roadproof.evidence.atoms import Atoms, Reading
from roadproof.evidence.certificate import Certificate, certify, goal_of
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.derivation import derive_query, met_sites
from roadproof.evidence.settled import Settled
from roadproof.evidence.sites import Lemma, Site, prefix_form
from roadproof.evidence.times import ZERO
from roadproof.library import motion
from roadproof.library.bind import default_values
from roadproof.library.specification import Query, Specification, is_within
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import pins
from roadproof.logic.rewrite import with_values
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import Budget, Effort
from roadproof.runtime.progress import begin
from roadproof.runtime.records import dataclass
from roadproof.runtime.timing import now, since
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
class Result(Settled[ClaimVerdict]):
    """A verdict over dense, unbounded time; ``reason`` says why where it is UNKNOWN or VACUOUS.

    ``work``: the units spent on the search. There is a ``certificate`` with PROVED and VACUOUS, and with
    nothing else. Of an UNKNOWN ``stop`` says where the search stopped, and ``doubt`` its cause.
    """

    work: float = 0.0
    countermodel: Countermodel | None = None
    stop: Stop | None = None
    doubt: Doubt | None = None

    def called(self, label: str = "", scenario: int | None = None) -> "Result":
        """The same, with what the claim is called in its certificate."""
        if self.certificate is None:
            return self
        return replace(self, certificate=replace(self.certificate, property=label, scenario=scenario))


def prove(
    specification: Specification,
    query: Query,
    effort: Effort | None = None,
    assumed: motion.Assumption = motion.NOTHING,
) -> Result:
    """Decide whether ``query`` holds at time 0 on all traces, for all values of its parameters.

    Parameters keep their declared bounds and are otherwise arbitrary, as are lengths and widths
    above zero, roads, and signals as functions of time; a value that is ``assumed``, or that the claim's own
    premise demands, is put in first. A proof counts only once its certificate, derived apart, has been
    answered unsat. Where motion is ``assumed`` nothing is refuted: a trace that has it at finitely many
    instants need be no motion. Raises ``BudgetExceeded``; ``InputError`` for forbidden assumptions.
    """
    begun, effort = now(), (effort or Effort()).running()
    found = _prove(specification, query, effort, assumed)
    brief = effort.of(min(OTHERWISE, effort.units))
    for reading in other_readings(query.formula):
        if found.verdict is not Verdict.UNKNOWN or found.stop is Stop.CERTIFICATE:
            break
        again = _prove(specification, query, brief, assumed, reading)
        found = replace(again if again.holds else found, work=found.work + again.work)
    return replace(found, seconds=since(begun))


def _prove(
    specification: Specification,
    query: Query,
    effort: Effort,
    assumed: motion.Assumption,
    reading: Reading = "states",
) -> Result:
    """As ``prove``, in one reading; in others than the usual one only proofs count."""
    begun = now()
    meter = effort.meter()
    here = motion.values_said(specification, assumed.said)
    demanded = _demanded(specification, query, here)
    pinned = motion.value_texts(specification, demanded)
    values = {**here, **demanded}
    states = _states(specification, values, None, reading)
    premise, claim = goal_of(specification, query, assumed, states.atoms, pinned)
    attempt = _Attempt(specification, query, states, meter, motion.is_moving(assumed.said))

    def result(verdict: ClaimVerdict, reason: Reason = NO_REASON, sure: Certificate | None = None) -> Result:
        spent, seconds = meter.spent, since(begun)
        return Result(spent, verdict=verdict, reason=reason, certificate=sure, seconds=seconds)

    proofs: list[Proof] = []
    for goal in conjuncts(claim):
        found = attempt.decide(f.implication(premise, goal))
        if isinstance(found, Countermodel):
            return replace(result(Verdict.REFUTED), countermodel=with_truths(found, states.atoms))
        if isinstance(found, GaveUp):
            return replace(result(Verdict.UNKNOWN, found.reason), stop=found.stop)
        proofs.append(found)
    fewer = attempt.needed(assumed, values, proofs)
    if fewer != assumed:
        again = _prove(specification, query, meter.effort(), fewer, reading)
        if again.verdict is Verdict.PROVED and attempt.never_holds(premise, f.TRUE):
            again = replace(again, verdict=Verdict.VACUOUS, reason=Why.CONTRADICTION())
        if again.holds:
            return replace(again, seconds=since(begun), work=meter.spent + again.work)
    try:
        certificate = attempt.certificate(assumed, pinned, proofs)
    except InputError as error:
        return replace(result(Verdict.UNKNOWN, Why.NO_CERTIFICATE(error)), stop=Stop.CERTIFICATE)
    rejected = _rejection(certificate, proofs, meter)
    if rejected is not None:
        return replace(result(*rejected), stop=Stop.CERTIFICATE if rejected[0] is Verdict.UNKNOWN else None)
    if premise != f.TRUE and attempt.never_holds(premise, f.TRUE):
        return result(Verdict.VACUOUS, Why.CONTRADICTION(), certificate)
    condition = premise_of(query, claim)
    if condition is not None and attempt.never_holds(premise, condition):
        return result(Verdict.VACUOUS, Why.PREMISE(), certificate)
    return result(Verdict.PROVED, NO_REASON, certificate)


def _rejection(
    certificate: Certificate, proofs: Sequence[Proof], meter: Budget
) -> tuple[ClaimVerdict, Reason] | None:
    """The verdict and the reason where z3 does not confirm a query of the certificate; None where it does.

    A query that the search for the ``proofs`` has put to z3 itself is not asked again.
    """
    settled = frozenset[str]().union(*(proof.settled for proof in proofs))
    for title, script in certificate.queries:
        if script in settled:
            continue
        answer = ask(script, meter=meter.apart(max(1.0, meter.left())))
        if answer != "unsat":
            why = Why.UNCONFIRMED(answer, title)
            return (Verdict.UNKNOWN if answer == "unknown" else Verdict.CROSSCHECK_FAILED), why
    return None


class ProofHeuristic:
    """Whether claims that are much alike have proofs, found quickly: no certificate is made of them.

    What is learnt of states for one claim serves the next. Nobody may rest on the answer: it says for which
    claim ``prove`` is worth the work.
    """

    def __init__(self, specification: Specification) -> None:
        self.specification = specification
        self.learnt: dict[tuple[str, ...], Learnt] = {}

    def has_proof(self, query: Query, effort: Effort) -> tuple[bool, float]:
        """Whether ``query`` is proved, and the units of work that it took. Raises ``BudgetExceeded``."""
        meter = effort.meter()
        values = _demanded(self.specification, query, {})
        pinned = motion.value_texts(self.specification, values)
        states = _states(self.specification, values, self.learnt.setdefault(pinned, Learnt()))
        premise, claim = goal_of(self.specification, query, motion.NOTHING, states.atoms, pinned)
        attempt = _Attempt(self.specification, query, states, meter, False)
        goals = (f.implication(premise, goal) for goal in conjuncts(claim))
        return all(isinstance(attempt.decide(goal), Proof) for goal in goals), meter.spent


def _states(
    specification: Specification,
    values: Mapping[str, Fraction],
    learnt: Learnt | None = None,
    reading: Reading = "states",
) -> StateChecker:
    """Which states there are where parameters have ``values``, for a claim of its own atoms."""
    library = specification.library
    return StateChecker(Atoms(reading=reading), library.bounds, {**default_values(library), **values}, learnt)


def _demanded(
    specification: Specification, query: Query, here: Mapping[str, Fraction]
) -> dict[str, Fraction]:
    """The values that the claim's own premise demands, as far as parameters may have them."""
    library = specification.library
    found = pins(with_values(query.formula, here))
    return {name: x for name, x in found.items() if is_within(library.bounds[name], x)}


@lru_cache(maxsize=256)
def _is_quickly_proved(
    goal: Formula,
    lanes: tuple[str, ...],
    bounds: tuple[tuple[str, str], ...],
    defaults: tuple[tuple[str, Fraction], ...],
) -> bool:
    """Whether ``goal``, of atoms, is proved quickly, its query derived apart, too.

    Remembered, since many claims share a premise. It depends on the arguments alone: nothing is learnt from
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
    return ask(query, meter=budget.meter()) == "unsat"


@dataclass(frozen=True)
class _Attempt:
    """``names``: what the elements and times are called that the proofs of all parts speak of."""

    specification: Specification
    query: Query
    states: StateChecker
    meter: Budget
    moving: bool
    names: dict[Site, str] = field(default_factory=dict)

    @property
    def refutes(self) -> bool:
        """Whether a model is made into a trace."""
        return not self.moving and self.states.atoms.reading == "states"

    def decide(self, goal: Formula) -> Proof | Countermodel | GaveUp:
        """Look for a proof and for a countermodel in turns, until one is found or the work is used up."""
        last = GaveUp(self.meter.reason())
        turns = TURNS[-1:] if f.is_state(goal) else TURNS
        roster = roster_for(goal, self.query.lanes) if self.refutes else None
        for number, (wishful, units) in enumerate(turns, 1):
            begin("prove", f"turn {number} of {len(turns)}")
            if roster is not None and number == len(turns[:2]):
                few = self._run(self._search(goal, {}, True, roster), self.meter.part(ON_FEW_LANES))
                if isinstance(few, Countermodel):
                    return few
            if number == len(turns[:3]) and self.refutes:
                repeating = find_lasso(self.query, goal, self.states, self.meter.part(REPEATING))
                if repeating is not None:
                    return repeating
            found = self._run(self._search(goal, self.names, wishful), self.meter.part(units))
            if not isinstance(found, GaveUp):
                return found
            last = found
            if self.meter.is_out():
                break
        return last

    def _run(self, search: InstanceSearch, meter: Budget) -> Proof | Countermodel | GaveUp:
        """What one search finds, a model of it made into a trace and judged."""
        with closing(search):
            return self._found(search, meter)

    def _found(self, search: InstanceSearch, meter: Budget) -> Proof | Countermodel | GaveUp:
        found = search.run(meter)
        while not isinstance(found, Proof | GaveUp):
            countermodel = self._realised(found) if self.refutes else None
            if countermodel is not None:
                return countermodel
            if not search.widen():
                return GaveUp(Why.FACTS(), Stop.FACTS) if self.moving else GaveUp(Why.TRACES(), Stop.PLACE)
            found = search.run(meter)
        return found

    def _realised(self, found: Model) -> Countermodel | None:
        return realise(self.query, self.states, found)

    def never_holds(self, premise: Formula, condition: Formula) -> bool:
        """Whether it is proved quickly that ``condition`` is false under ``premise``."""
        goal = f.implication(premise, f.negation(condition))
        states = self.states
        return _is_quickly_proved(
            goal, tuple(self.query.lanes), tuple(states.bounds.items()), tuple(states.defaults.items())
        )

    def _search(
        self, goal: Formula, names: dict[Site, str], wishful: bool, roster: Roster | None = None
    ) -> InstanceSearch:
        return InstanceSearch(goal, self.states, self.query.lanes, names, wishful, roster, self.moving)

    def certificate(
        self, assumed: motion.Assumption, pinned: tuple[str, ...], proofs: Sequence[Proof]
    ) -> Certificate:
        """The proofs of all parts as one certificate. Raises ``InputError`` where they do not fit."""
        lemmas: dict[tuple[tuple[str, bool], ...], tuple[str, ...]] = {}
        for proof in proofs:
            for lemma in proof.lemmas:
                before = lemmas.get(lemma.literals, ())
                lemmas[lemma.literals] = tuple(dict.fromkeys([*before, *lemma.moments]))
        atoms = Atoms(reading=self.states.atoms.reading)
        claim = f.implication(*goal_of(self.specification, self.query, assumed, atoms, pinned))
        met = self._met(claim, atoms, proofs)
        made = tuple(Lemma(literals, moments) for literals, moments in lemmas.items())
        return certify(
            self.specification,
            self.query,
            met,
            made,
            assumed=assumed,
            read_with=(pinned, self.states.atoms.reading),
        )

    def needed(
        self, assumed: motion.Assumption, values: Mapping[str, Fraction], proofs: Sequence[Proof]
    ) -> motion.Assumption:
        """The same with those premises alone of which a proof has instances, and which the claim has not.

        Each premise is a universal that holds at time 0.
        """
        if not assumed.axioms and not motion.limits_said(assumed.said):
            return motion.Assumption(assumed.said)
        instances, atoms = _instances(proofs), Atoms(reading=self.states.atoms.reading)
        own, _ = self._met(atoms.abstract(with_values(self.query.formula, values)), atoms, proofs)

        def is_used(formula: Formula) -> bool:
            made = atoms.abstract(with_values(formula, values))
            site = Site(prefix_form(made), True, str(ZERO))
            return site in instances and site not in own

        home, query = self.specification, self.query
        axioms = tuple(x for x in assumed.axioms if is_used(motion.axiom_formula(home, query, x)))
        used = {x for x, made in motion.limit_formulas(home, query, assumed).items() if is_used(made)}
        return motion.Assumption(
            assumed.said, axioms, tuple(x for x in motion.limits_said(assumed.said) if x not in used)
        )

    def _met(
        self, claim: Formula, atoms: Atoms, proofs: Sequence[Proof]
    ) -> tuple[dict[Site, tuple[str, ...]], dict[Site, str]]:
        """The instances of proofs, and their names, that a derivation from the claim meets."""
        bounds = self.specification.library.bounds
        return met_sites(claim, atoms, _instances(proofs), self.names, bounds, self.query.lanes)


def _instances(proofs: Sequence[Proof]) -> dict[Site, tuple[str, ...]]:
    """The instances of several proofs, each once."""
    instances: dict[Site, tuple[str, ...]] = {}
    for proof in proofs:
        for site, texts in proof.instances.items():
            instances[site] = tuple(dict.fromkeys([*instances.get(site, ()), *texts]))
    return instances
