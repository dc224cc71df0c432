"""Faults planted in the finder never lead to a wrong answer; faults in refuting are caught."""

from dataclasses import replace

import pytest

from proving.claims import (
    BEYOND,
    INVALID,
    PROVED,
    VALID,
    is_false_on,
    settle,
    speaks_of_all_lanes,
    specification,
)
from proving.on_roads import is_road
from rejection import rejection_reason
from roadproof.engines.prove import countermodel, grounding, prover
from roadproof.engines.prove.grounding import Grounding, Window
from roadproof.engines.prove.search import InstanceSearch
from roadproof.engines.prove.states import StateChecker
from roadproof.engines.solve.smt import Session, check_sat
from roadproof.evidence import refutation
from roadproof.logic import formula as f
from roadproof.verdict import Verdict
from roadproof.world.road import Lanelet, Road
from tables import read_table

UNITS = 0.4
true_smt, true_inside, true_shrink = Window.smt, Window.inside, InstanceSearch._shrink
true_unfold, true_atom, true_name = Grounding._unfold, Grounding.atom, Grounding._name_time
true_after, true_holds_part = refutation._after, refutation._holds


def phi_at_the_end(monkeypatch):
    """φ U ψ asks for φ also when ψ comes."""

    def smt(self, when):
        return true_smt(Window(self.low, self.high), when)

    def inside(self, instants, values):
        return true_inside(Window(self.low, self.high), instants, values)

    monkeypatch.setattr(Window, "smt", smt)
    monkeypatch.setattr(Window, "inside", inside)


def open_windows(monkeypatch):
    monkeypatch.setattr(Window, "smt", lambda self, when: [f"(<= {self.low.smt()} {when.smt()})"])
    monkeypatch.setattr(
        Window, "inside", lambda self, instants, values: true_inside(Window(self.low, None), instants, values)
    )


def swapped_operators(monkeypatch):
    def unfold(self, formula, positive, moment, switch):
        match formula:
            case f.Eventually(interval, body):
                formula = f.Always(interval, body)
            case f.Always(interval, body):
                formula = f.Eventually(interval, body)
        true_unfold(self, formula, positive, moment, switch)

    monkeypatch.setattr(Grounding, "_unfold", unfold)


def shared_names(monkeypatch):
    """All existentials fall on one moment."""

    def name_time(self, site, earliest):
        made = true_name(self, site, earliest)
        first = next(iter(self.names.values()))
        self.session.tell(f"(assert (= {made.smt()} {first}))")
        return made

    monkeypatch.setattr(Grounding, "_name_time", name_time)


def no_guard(monkeypatch):
    """A universal holds outside its window, too."""
    monkeypatch.setattr(Window, "inside", lambda self, instants, values: list(instants))

    def instantiate(self, universal, when):
        universal.done.append(when)
        self.declare_moment(when)
        self._add_clause((universal.site, str(when)), f"(=> {universal.switch} {universal.body(when)})")

    monkeypatch.setattr(Grounding, "instantiate", instantiate)


def frozen_atoms(monkeypatch):
    monkeypatch.setattr(Grounding, "atom", lambda self, name, moment: true_atom(self, name, grounding.ZERO))


def wishes_as_clauses(monkeypatch):
    """A model has few instants, or there is none."""

    def check(self, meter):
        ground = self.grounding
        return ground.session.check([*ground.switches, *ground.wishes], meter=meter)

    def shrink(self, meter):
        ground = self.grounding
        wanted = {switch for switch in ground.session.core() if switch in ground.switches}
        ground.switches = {switch: ground.switches[switch] for switch in ground.switches if switch in wanted}
        ground.session.tell("(assert false)")
        core = ground.session.core
        ground.session.core = lambda: list(ground.switches)
        try:
            return true_shrink(self, meter)
        finally:
            ground.session.core = core

    monkeypatch.setattr(prover, "TURNS", ((True, 5.0),))
    monkeypatch.setattr(InstanceSearch, "_check", check)
    monkeypatch.setattr(InstanceSearch, "_shrink", shrink)


def every_state_is_impossible(monkeypatch):
    """Whatever a model says of one instant becomes a lemma against it."""
    monkeypatch.setattr(
        StateChecker,
        "refute",
        lambda self, wanted, meter, case=0.0: (
            tuple((name, not value) for name, value in wanted.items()) or None
        ),
    )
    monkeypatch.setattr(StateChecker, "signals", lambda self, wanted: {})


def no_membership(monkeypatch):
    monkeypatch.setattr(Grounding, "_fact", lambda self, domain, element: "true")


def everything_unsat(monkeypatch):
    """What z3 does not know, or has a model of, counts as refuted."""
    monkeypatch.setattr(Session, "check", lambda self, assuming=(), meter=None: "unsat")
    monkeypatch.setattr(Session, "core", lambda self: [])


FINDER_FAULTS = [
    phi_at_the_end,
    open_windows,
    swapped_operators,
    shared_names,
    no_guard,
    frozen_atoms,
    wishes_as_clauses,
    every_state_is_impossible,
    no_membership,
    everything_unsat,
]
TEMPTING = read_table(__file__, "tempting")


def verdict_or_crash(claim: str) -> Verdict | str:
    try:
        return settle(claim, units=UNITS).verdict
    except (AssertionError, KeyError) as crash:
        return type(crash).__name__


@pytest.mark.parametrize("fault", FINDER_FAULTS, ids=lambda fault: fault.__name__)
def test_a_fault_in_the_finder_proves_nothing_false(fault, monkeypatch):
    assert set(TEMPTING) <= set(INVALID)
    # Traces that repeat would refute some claims in spite of the fault.
    monkeypatch.setattr(prover, "find_lasso", lambda *_: None)
    fault(monkeypatch)
    verdicts = [verdict_or_crash(claim) for claim in TEMPTING]
    assert not PROVED & set(verdicts)
    # The fault is at work: without it, all of these are refuted.
    assert set(verdicts) != {Verdict.REFUTED}


# --- the last check of a proof -------------------------------------------------------------------


def unknown_is_proved(monkeypatch):
    """A derived query that z3 cannot answer counts as answered unsat."""
    everything_unsat(monkeypatch)
    monkeypatch.setattr(prover, "check_sat", lambda query, **limits: "unsat")


def lemmas_not_asked(monkeypatch):
    """What the finder takes for a lemma is not derived and asked again."""
    every_state_is_impossible(monkeypatch)
    monkeypatch.setattr(
        prover, "check_sat", lambda query, **limits: "unsat" if "QF_NRA" in query else check_sat(query)
    )


LAST_FAULTS = [unknown_is_proved, lemmas_not_asked]


def wrong_proof() -> str | None:
    """A false claim that is called PROVED; its certificate says so to those who check it."""
    for claim in TEMPTING:
        result = settle(claim, units=UNITS)
        if result.verdict in PROVED:
            assert rejection_reason(result.certificate, specification().library, check_sat) is not None
            return claim
    return None


@pytest.mark.parametrize("fault", LAST_FAULTS, ids=lambda fault: fault.__name__)
def test_a_fault_in_the_last_check_is_caught(fault, monkeypatch):
    fault(monkeypatch)
    assert wrong_proof() is not None


@pytest.mark.parametrize(
    ("answer", "verdict"), [("unknown", Verdict.UNKNOWN), ("sat", Verdict.CROSSCHECK_FAILED)]
)
@pytest.mark.parametrize("claim", ["F F p -> F p", "aheadOf(SV,POV) -> not aheadOf(POV,SV)"])
def test_a_proof_counts_only_once_its_derived_queries_are_unsat(claim, answer, verdict, monkeypatch):
    monkeypatch.setattr(prover, "check_sat", lambda query, **limits: answer)
    result = settle(claim)
    assert result.verdict is verdict
    assert result.certificate is None
    assert "derived query 'claim'" in result.reason


def test_a_proof_that_fits_no_certificate_is_unknown(monkeypatch):
    """The names of a proof are lost on the way."""
    monkeypatch.setattr(prover, "met_sites", lambda claim, atoms, instances, *_: (instances, {}))
    result = settle("F F p -> F p")
    assert result.verdict is Verdict.UNKNOWN
    assert "no certificate" in result.reason


# --- refuting ------------------------------------------------------------------------------------


def wrong_side_held(monkeypatch):
    """What lies between instants is the state of the other side than is said."""
    turned = {"before": "after", "after": "before"}
    monkeypatch.setattr(
        refutation,
        "_after",
        lambda part, truths, trace: true_after(
            part, truths, replace(trace, interpolation=turned[trace.interpolation])
        ),
    )


def not_judged(monkeypatch):
    """A model over points in time is taken for a trace unseen."""
    monkeypatch.setattr(countermodel, "fault_of", lambda found, claim, bounds: None)


def comparisons_turned(monkeypatch):
    """The truth of comparisons is not that of the numbers handed out."""
    monkeypatch.setattr(refutation, "_holds", lambda part, instant: not true_holds_part(part, instant))


def lanelets_anywhere(monkeypatch):
    """The road is a heap of rectangles, one for each box that is to be in a lane."""

    def lay(layout):
        heap = [
            Lanelet(f"{lane}.{j}", lane, "main", "main", (box.rear, box.front), (box.right, box.left))
            for lane in layout.lanes
            for j, box in enumerate(layout.boxes)
            if (("lane", lane), j) in layout.inside
        ]
        return Road("heap", tuple(heap), frozenset())

    monkeypatch.setattr(countermodel, "build_road", lay)
    monkeypatch.setattr(refutation, "check_lanelets", lambda lanelets, where: None)


REFUTING_FAULTS = [
    wrong_side_held,
    not_judged,
    comparisons_turned,
    lanelets_anywhere,
]
MORE = [
    "not (not p and G[1,1] p and not (not p U[0,1] p))",
    "p U q -> p or F (p and q)",
    "atLane(SV,L) -> onMainRoad(SV) or inMergeZone(SV) or inDepartZone(SV)",
    "(some l in lanelets(L): occ(SV,l) and occ(POV,l)) -> atLane(SV,L)",
    BEYOND[-2],
    "F (v_lon(SV) > 20 m/s) -> G (v_lon(SV) > 20 m/s)",
    "F[0,minSafe] p -> p",
]


def wrong_refutation() -> str | None:
    """A claim that is called false though it is true, or on a trace on which it is true."""
    for claim in VALID + MORE + INVALID:
        try:
            result = settle(claim, units=UNITS)
            if result.verdict is not Verdict.REFUTED:
                continue
            road = result.countermodel.road
            true = claim in VALID or claim in MORE[2:5] or (road is not None and not is_road(road))
            if true or (not speaks_of_all_lanes(claim) and not is_false_on(result.countermodel, claim)):
                return claim
        except AssertionError:
            return claim
    return None


@pytest.mark.parametrize("fault", REFUTING_FAULTS, ids=lambda fault: fault.__name__)
def test_a_fault_in_refuting_is_caught(fault, monkeypatch):
    fault(monkeypatch)
    assert wrong_refutation() is not None


def test_without_a_fault_nothing_is_caught():
    assert wrong_refutation() is None
