"""What a search tries: what a model violates, and a road of few lanes where that can help."""

import random
from dataclasses import replace
from fractions import Fraction
from itertools import product
from random import Random

import pytest

import roadproof as rp
from engine_calls import prove
from extensions.drivers.read import specification as driver_specification
from proving.claims import settle, specification
from proving.on_roads import is_road, neighbours
from roadproof.engines.prove import countermodel, prover
from roadproof.engines.prove.countermodel import place_vehicles
from roadproof.engines.prove.grounding import Grounding
from roadproof.engines.prove.roads import ZONES, Box, RoadLayout, build_road, roster_for
from roadproof.engines.prove.search import Model, NoAnswer
from roadproof.engines.prove.states import deciding_atoms, is_propositional
from roadproof.engines.prove.unknown import StopPoint
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.extensions.drivers.models import lemmas_for, models_for
from roadproof.library.elaborate import read_claim
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Application, Formula
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from roadproof.world.models import load_vehicle
from roadproof.world.road import Lanelet, Road


def test_what_holds_anyway_is_not_instantiated(monkeypatch):
    met = []
    true_instantiate = Grounding.instantiate

    def instantiate(self, universal, when):
        met.append(str(when))
        true_instantiate(self, universal, when)

    monkeypatch.setattr(Grounding, "instantiate", instantiate)
    claim = "not (atLane(SV,L) and G atLane(SV,L))"
    assert prove(specification(), claim, Effort(5)).verdict is Verdict.REFUTED
    assert met == []
    claim = "atLane(SV,L) and G not atLane(SV,L) -> false"
    assert prove(specification(), claim, Effort(5)).verdict is Verdict.VACUOUS
    assert "0" in met


@pytest.mark.parametrize(
    ("claim", "few"),
    [
        ("G F p -> F G p", []),
        ("(every K in lanes: some M in lanes: G F atLane(SV,M) and F atLane(SV,K)) -> F G p", [1]),
    ],
)
def test_few_lanes_are_tried_once_where_quantifiers_over_lanes_are_open(claim, few, monkeypatch):
    looked = []
    true_search = prover._ProofAttempt._search

    def search(self, goal, names, prefer_known_times, roster=None):
        looked.append((prefer_known_times, roster))
        return true_search(self, goal, names, prefer_known_times, roster)

    monkeypatch.setattr(prover._ProofAttempt, "_search", search)
    settle(claim, units=2)
    assert [n for n, (_, roster) in enumerate(looked) if roster is not None] == few
    turns = [prefer_known_times for prefer_known_times, roster in looked if roster is None]
    assert turns == [prefer_known_times for prefer_known_times, _ in prover.TURNS[: len(turns)]]


def test_a_road_of_few_lanes_proves_nothing(monkeypatch):
    """What holds on it may fail on a larger one."""
    found = []
    true_run = prover._ProofAttempt._run

    def run(self, search, meter):
        made = true_run(self, search, meter)
        if search.grounding.roster is not None:
            found.append(made)
        return made

    monkeypatch.setattr(prover._ProofAttempt, "_run", run)
    monkeypatch.setattr(prover, "TURNS", ((False, 0.0), (True, 0.0)))
    assert settle("(every K in lanes: F atLane(SV,K)) -> F p").verdict is Verdict.UNKNOWN
    assert found == [NoAnswer("no countermodel on a road of few lanes", StopPoint.PLACE)]


def test_where_no_road_is_found_nothing_is_refuted(monkeypatch):
    """Not even where the claim is false without any road: there is none of that kind."""
    claim = "some K in lanes: G atLane(SV,K)"
    assert settle(claim, units=2).verdict is Verdict.REFUTED
    monkeypatch.setattr(countermodel, "build_road", lambda layout: None)
    assert settle(claim, units=2).verdict is Verdict.UNKNOWN


def test_a_vehicle_of_which_nothing_is_known_is_a_car_that_begins_at_zero():
    values = settle("not atLane(SV,L)").countermodel.instants[0].values
    car = load_vehicle("car")
    assert (values["length(SV)"], values["width(SV)"]) == (car.length, car.width)
    assert values["s(SV)"] == car.length


def test_vehicles_of_which_the_same_is_said_stand_together():
    said = {"|occ(A,l)|": True, "|occ(B,l)|": False, "|occ(C,l)|": True}
    formula = f.And(tuple(f.Occupies(name, "l") for name in "ABC"))
    sizes = {state.symbol(t.Size(size, name)): Fraction(2) for name in "ABC" for size in ("length", "width")}
    model = Model({}, {Fraction(0): {}}, {Fraction(0): said}, {}, {})
    (found,) = place_vehicles(formula, Atoms(), model, sizes)
    assert sorted("ABC", key=lambda name: found[f"s({name})"]) == ["B", "A", "C"]


# --- Few atoms that are enough: against all truth tables of random formulas -------------------------

NAMES = ("p", "q", "r", "s")


def atom(name: str) -> Formula:
    return Application(name, (), f.Truth(True))


def random_formula(rng: random.Random, depth: int) -> Formula:
    kind = rng.choice(["atom", "not", "and", "or", "truth"]) if depth else "atom"
    if kind == "atom":
        return atom(rng.choice(NAMES))
    if kind == "truth":
        return f.Truth(rng.random() < 0.5)
    if kind == "not":
        return f.Not(random_formula(rng, depth - 1))
    parts = tuple(random_formula(rng, depth - 1) for _ in range(rng.randint(1, 3)))
    return f.And(parts) if kind == "and" else f.Or(parts)


def value(formula: Formula, truths: dict[str, bool]) -> bool:
    match formula:
        case f.Truth(known):
            return known
        case Application(name, _, _):
            return truths[name]
        case f.Not(body):
            return not value(body, truths)
        case f.And(parts):
            return all(value(x, truths) for x in parts)
        case f.Or(parts):
            return any(value(x, truths) for x in parts)
        case _:
            raise AssertionError


def all_truths():
    return [dict(zip(NAMES, x, strict=True)) for x in product((False, True), repeat=len(NAMES))]


def test_what_is_told_is_true_and_enough():
    rng = random.Random(1)
    fewer = 0
    for _ in range(100):
        formula = random_formula(rng, 4)
        for truths in all_truths():
            found = value(formula, truths)
            assert deciding_atoms(formula, not found, truths) is None
            why = deciding_atoms(formula, found, truths)
            assert why is not None
            assert why.items() <= truths.items()
            fewer += len(why) < len(NAMES)
            assert all(value(formula, x) == found for x in all_truths() if why.items() <= x.items())
    assert fewer > 500


def test_one_of_several_is_enough():
    p, q, r = map(atom, "pqr")
    truths = {"p": True, "q": True, "r": True}
    assert deciding_atoms(f.Or((f.And((p, q)), r)), True, truths) == {"r": True}
    assert deciding_atoms(f.And((p, f.Not(q))), False, truths) == {"q": True}
    assert deciding_atoms(p, True, {}) is None


def test_only_what_is_about_one_instant_is_plain():
    later = read_claim(driver_specification(), "danger(SV, POV) -> G danger(SV, POV)")
    assert not is_propositional(Atoms().abstract(later.formula))
    assert is_propositional(f.Not(f.Or((atom("p"), f.Truth(False)))))


def test_a_state_is_asked_about_in_full_where_its_reason_is_not_enough():
    """``hits`` has a case in which one of two conditions of the premise is no help without the other."""
    lemma = next(x for x in lemmas_for("cut-in", models_for("cut-in", ("careful",))) if "slow" in x.name)
    answer = rp.prove(lemma.claim, using=rp.load(specs=["driver"]), declared=True, jobs=1)
    assert str(answer.verdict) == "PROVED"


# --- Roads made for a layout: they are roads, and have the facts that were asked for ----------------


def overlap(box: Box, lanelet: Lanelet) -> bool:
    low, high = lanelet.s
    return max(box.rear, low) < min(box.front, high) and max(box.right, lanelet.d[0]) < min(
        box.left, lanelet.d[1]
    )


def is_in(place: tuple[str, str], box: Box, road: Road) -> bool:
    kind, name = place
    of = {"lane": lambda x: x.lane, "zone": lambda x: x.zone, "lanelet": lambda x: x.id}[kind]
    return any(of(lanelet) == name and overlap(box, lanelet) for lanelet in road.lanelets)


def random_layout(rng: Random) -> RoadLayout:
    boxes = []
    for _ in range(rng.randint(1, 5)):
        rear, right = Fraction(rng.randint(0, 20)), Fraction(rng.randint(0, 6))
        boxes.append(Box(rear, rear + rng.randint(1, 5), right, right + rng.randint(1, 3)))
    lanes = tuple(f"L{k}" for k in range(rng.randint(0, 3)))
    places = [*(("lane", lane) for lane in lanes), *(("zone", zone) for zone in ZONES)]
    lanelets = {"l": (lanes[0], ZONES)} if lanes and rng.random() < 0.5 else {}
    places += [("lanelet", name) for name in lanelets]
    facts = [(place, j) for place in places for j in range(len(boxes))]
    said = {fact: rng.random() < 0.35 for fact in facts if rng.random() < 0.5}
    pairs = [frozenset((a, b)) for a in lanes for b in lanes if a < b]
    return RoadLayout(
        tuple(boxes),
        frozenset(fact for fact, true in said.items() if true),
        frozenset(fact for fact, true in said.items() if not true),
        lanes,
        lanelets,
        frozenset(pair for pair in pairs if rng.random() < 0.5),
        rng.random() < 0.3,
    )


def test_random_layouts():
    made = 0
    for seed in range(300):
        layout = random_layout(Random(seed))
        road = build_road(layout)
        if road is None:
            continue
        made += 1
        assert is_road(road), seed
        assert set(layout.lanes) <= set(road.lanes), seed
        assert neighbours(road) == layout.adjacent, seed
        for where, j in layout.inside:
            assert is_in(where, layout.boxes[j], road), (seed, where, j)
        for where, j in layout.outside:
            assert not is_in(where, layout.boxes[j], road), (seed, where, j)
    assert made > 150


BOX = Box(Fraction(0), Fraction(4), Fraction(0), Fraction(2))
BEFORE = replace(BOX, rear=Fraction(4), front=Fraction(8))
LEFT = replace(BOX, right=Fraction(2), left=Fraction(4))
BEHIND_IT = replace(BOX, rear=Fraction(8), front=Fraction(12))
LEFT_OF_IT = replace(BOX, right=Fraction(4), left=Fraction(6))
L = ("lane", "L")


def one_lane(boxes: tuple[Box, ...], inside: set[int], outside: set[int]) -> RoadLayout:
    facts = [frozenset((L, j) for j in which) for which in (inside, outside)]
    return RoadLayout(boxes, facts[0], facts[1], ("L",), {}, frozenset(), False)


@pytest.mark.parametrize(
    ("boxes", "inside", "outside", "possible"),
    [
        ((BOX,), {0}, set(), True),
        ((BOX,), set(), {0}, True),
        ((BOX, BOX), {0}, {1}, False),
        # around the middle one of a column, but not through the middle one of a row
        ((BOX, BEFORE, BEHIND_IT), {0, 2}, {1}, True),
        ((BOX, LEFT, LEFT_OF_IT), {0, 2}, {1}, False),
        # covered by two others
        ((replace(BOX, front=Fraction(8)), BOX, BEFORE), {0}, {1, 2}, False),
    ],
)
def test_what_a_lane_can_and_cannot_do(boxes, inside, outside, possible):
    assert (build_road(one_lane(boxes, inside, outside)) is not None) == possible


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_lanelet_with_a_name_may_come_first_or_later(order):
    inside = {(L, 0), (("lanelet", "l"), 1)}
    outside = {(("lanelet", "l"), 0)}
    boxes = tuple((BOX, BEFORE)[k] for k in order)
    lanelets = {"l": ("L", ZONES)}
    road = build_road(
        RoadLayout(boxes, frozenset(inside), frozenset(outside), ("L",), lanelets, frozenset(), False)
    )
    assert road is not None
    assert [x.lane for x in road.lanelets if x.id == "l"] == ["L"]
    for where, j in inside:
        assert is_in(where, boxes[j], road)
    assert not is_in(("lanelet", "l"), boxes[0], road)


def test_a_short_lane_has_no_lanelet_that_it_does_not_need():
    """Else no claim about every lanelet of a lane would be false for want of one."""
    layout = one_lane((BOX, BEFORE), {1}, {0})
    whole, short = build_road(layout), build_road(replace(layout, short=True))
    assert all(overlap(BEFORE, x) for x in short.lanelets)
    assert len(whole.lanelets) > len(short.lanelets)
    assert whole.lanelets[0].s[0] < BOX.rear
    assert whole.lanelets[-1].s[1] > BEFORE.front


# --- The small roads that claims about all lanes are tried on ---------------------------------------

SOME_LANELET = "every K in lanes: some l in lanelets(K): F occ(SV,l) and G occ(POV,l)"
SOME_LANE = "every K in lanes: some N in lanes: F atLane(SV,K) and G atLane(POV,N)"


def roster_of(claim: str):
    query = read_claim(specification(), claim)
    return roster_for(Atoms().abstract(query.formula), query.lanes)


@pytest.mark.parametrize("claim", ["F atLane(SV,L)", "F (some l in lanelets(L): occ(SV,l))"])
def test_without_open_quantifiers_there_is_none(claim):
    assert roster_of(claim) is None


def test_two_lanes_and_lanelets_only_where_they_are_spoken_of():
    roster = roster_of(SOME_LANE)
    assert (len(roster.lanes), dict(roster.lanelets)) == (2, {})
    roster = roster_of(SOME_LANELET)
    assert sorted(roster.lanelets.values()) == sorted(2 * roster.lanes)
    assert not set(roster.lanelets) & set(roster.lanes)


def test_lanes_of_the_claim_are_among_them():
    roster = roster_of(f"given L1, L2, L3: lane: ({SOME_LANE}) -> G atLane(SV,L1)")
    assert roster.lanes == ("L1", "L2", "L3")
    roster = roster_of(f"given L1: lane: ({SOME_LANE}) -> G atLane(SV,L1)")
    assert roster.lanes[0] == "L1"
    assert len(roster.lanes) == 2


def test_a_free_lanelet_is_in_the_last_lane():
    roster = roster_of(f"given l: lanelet: ({SOME_LANE}) -> G occ(SV,l)")
    assert roster.lanelets["l"] == roster.lanes[-1]


def test_members():
    roster = roster_of(SOME_LANELET)
    one, other = roster.lanes
    assert roster.members(f.Domain("lanes")) == [one, other]
    assert roster.members(f.Domain("adjacent", one)) == [other]
    assert [roster.lanelets[x] for x in roster.members(f.Domain("lanelets", one))] == [one, one]
    assert roster.members(f.Domain("zone", "main")) == list(roster.lanelets)
