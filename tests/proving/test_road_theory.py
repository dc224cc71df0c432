"""Prover, judge, makers of roads, formal.md and Meaning.v state one theory of roads, ``road_axioms``."""

import random
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from extensions.kernel.needs import needs_coq
from planting import plant
from proving.on_roads import random_road
from rejection import rejection_reason
from roadproof.engines.prove.prover import prove
from roadproof.engines.solve.recall import check_sat
from roadproof.evidence import road_axioms
from roadproof.evidence.refutation import fault_of
from roadproof.evidence.road_axioms import AXIOMS, ZONES, membership, road_clauses
from roadproof.extensions.kernel.accept import judge as judge_by_kernel
from roadproof.extensions.kernel.accept import prepare
from roadproof.extensions.kernel.coq import ready
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.judging import judge
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, names_of

LIBRARY = bundled_library()
HOME = LIBRARY.select()
VALUES = default_values(LIBRARY)
ROOT = Path(__file__).parents[2]
ANYWHERE = "onMainRoad(SV) or inMergeZone(SV) or inDepartZone(SV)"
# By axiom: a claim that rests on it, and one that would be valid under a stronger axiom and is false.
CLAIMS = {
    "some lanelet": (
        "(every M in lanes: atLane(SV,M)) -> (some M in lanes: atLane(SV,M))",
        "(some M in lanes: atLane(SV,M)) -> (every M in lanes: atLane(SV,M))",
    ),
    "own lane": (
        "(every M in lanes: not atLane(SV,M)) -> not onMainRoad(SV)",
        "(some M in lanes: not atLane(SV,M)) -> not onMainRoad(SV)",
    ),
    "one zone": (f"atLane(SV,L) -> {ANYWHERE}", "atLane(SV,L) -> onMainRoad(SV) or inMergeZone(SV)"),
    "beside both ways": (
        "(some M in adjacentLanes(L): every N in adjacentLanes(M): not atLane(SV,N)) -> not atLane(SV,L)",
        "(some M in adjacentLanes(L): every N in adjacentLanes(M): atLane(SV,N)) -> atLane(POV,L)",
    ),
}
# By axiom: facts about memberships that no road has.
IMPOSSIBLE = {
    "own lane": [(f.Domain("lanelets", "a"), "a", False)],
    "one zone": [(f.Domain("zone", zone), "a", False) for zone in ZONES],
    "not beside itself": [(f.Domain("adjacent", "a"), "a", True)],
    "beside both ways": [(f.Domain("adjacent", "a"), "b", True), (f.Domain("adjacent", "b"), "a", False)],
}


def decided(claim):
    return prove(HOME, read_claim(HOME, claim), Effort(5))


def answer(script):
    return check_sat(script, meter=Effort(5).meter())


def satisfiable(facts, clauses):
    names = dict.fromkeys(membership(domain, element) for domain, element, _ in facts)
    told = [f"|{membership(d, e)}|" if true else f"(not |{membership(d, e)}|)" for d, e, true in facts]
    declared = [f"(declare-const |{name}| Bool)" for name in names]
    lines = ["(set-logic QF_UFLRA)", *declared, *(f"(assert {x})" for x in [*told, *clauses]), "(check-sat)"]
    return answer("\n".join([*lines, ""])) == "sat"


def facts_of(road):
    """Every membership of a road, of lanelets by their ids; each stands for its lane, too."""
    lane = {x.id: x.lane for x in road.lanelets}
    for x in road.lanelets:
        yield from ((f.Domain("zone", zone), x.id, x.zone == zone) for zone in ZONES)
        for other, of in lane.items():
            yield f.Domain("lanelets", other), x.id, of == x.lane
            yield f.Domain("adjacent", other), x.id, frozenset((of, x.lane)) in road.adjacent


def roads():
    """Shipped roads, random ones, and those that were made for countermodels."""
    yield from map(load_road, names_of("roads"))
    rng = random.Random(39)
    yield from (random_road(rng) for _ in range(40))
    for _, near in CLAIMS.values():
        yield decided(near).countermodel.road


# --- each place ----------------------------------------------------------------------------------------


def words_of_formal():
    text = (ROOT / "docs/explanation/formal.md").read_text("utf-8")
    section = text.partition("## Roads\n")[2].partition("\n## ")[0]
    return re.findall(r"^\| (?!axiom|---)(.+?) \| (.+?) \|$", section, re.MULTILINE)


def fields_of_meaning(text):
    """The fields of ``world`` in Meaning.v that speak of elements of the road, but for names of them."""
    record = re.search(r"Record world := \{(.*?)\}\.", text, re.DOTALL)
    fields = (" ".join(x.split()) for x in re.sub(r"\(\*.*?\*\)", "", record[1], flags=re.DOTALL).split(";"))
    return [x for x in fields if re.search(r"\b(element|adjacent|lanelets)\b", x)]


def meaning():
    return (ROOT / "proofs/kernel/Meaning.v").read_text("utf-8")


def test_formal_md_states_the_axioms_in_these_words():
    assert words_of_formal() == [(x.name, x.words) for x in AXIOMS]


def test_the_world_of_meaning_has_these_axioms_and_no_other():
    stated = [field for axiom in AXIOMS for field in axiom.coq]
    assert sorted(fields_of_meaning(meaning())) == sorted(stated)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("zone_of : element -> zone", "zone_of : element -> option zone"),
        ("lanelets_reflexive : forall l, lanelets l l;", ""),
        ("forall l, ~ adjacent l l", "forall l, adjacent l l"),
        ("shape : element -> extent", "occupies : vehicle -> element -> R -> Prop"),
    ],
)
def test_a_difference_in_meaning_is_noticed(right, wrong):
    changed = meaning().replace(right, wrong)
    assert changed != meaning()
    assert sorted(fields_of_meaning(changed)) != sorted(y for x in AXIOMS for y in x.coq)


def test_the_box_of_motions_is_that_of_traces():
    """Motion.v adds nothing about occupancy, which Meaning.v defines by boxes."""
    motion = (ROOT / "proofs/kernel/Motion.v").read_text("utf-8")
    record = re.search(r"Record motion .*?\{(.*?)\}\.", motion, re.DOTALL)
    assert "occupies" not in record[1]
    assert re.search(r"Definition occupies \(W : world\)", meaning())


def test_every_road_obeys_every_axiom():
    for road in roads():
        facts = [*facts_of(road)]
        assert satisfiable(facts, road_clauses([(x, y) for x, y, _ in facts])), road


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_an_axiom_excludes_what_no_road_has_and_no_other_axiom_does(name):
    facts = IMPOSSIBLE[name]
    known = [(x, y) for x, y, _ in facts]
    assert not satisfiable(facts, road_clauses(known))
    others = [x for x in AXIOMS if x.name != name]
    assert satisfiable(facts, [clause for x in others for clause in x.instances(known)])


# --- claims that rest on an axiom ----------------------------------------------------------------------


@pytest.mark.parametrize("name", CLAIMS)
def test_a_claim_that_rests_on_an_axiom_is_proved_and_a_near_miss_refuted(name):
    claim, near = CLAIMS[name]
    proved = decided(claim)
    assert proved.verdict is Verdict.PROVED
    assert rejection_reason(proved.certificate, LIBRARY, answer) is None
    refuted = decided(near)
    assert refuted.verdict is Verdict.REFUTED
    assert fault_of(refuted.countermodel, read_claim(HOME, near).formula, LIBRARY.bounds) is None


@needs_coq
def test_the_kernel_accepts_what_rests_on_the_axioms():
    found = {name.replace(" ", "_"): decided(claim).certificate for name, (claim, _) in CLAIMS.items()}
    with ready() as coq:
        rulings = judge_by_kernel(coq, {x: prepare(x, y, LIBRARY) for x, y in found.items()}).rulings
    assert {str(x) for x in rulings.values()} == {"accepted"}


@pytest.mark.parametrize("name", ["own lane", "one zone", "beside both ways"])
def test_without_its_axiom_nothing_is_proved_and_the_certificate_refused(monkeypatch, name):
    claim = CLAIMS[name][0]
    certificate = decided(claim).certificate
    weaker = tuple(replace(x, instances=lambda _: ()) if x.name == name else x for x in AXIOMS)
    monkeypatch.setattr(road_axioms, "AXIOMS", weaker)
    assert decided(claim).verdict is Verdict.UNKNOWN
    assert rejection_reason(certificate, LIBRARY, answer) is not None


@pytest.mark.parametrize(
    ("function", "right", "wrong"),
    [
        ("_own_lane", "_fact(domain, element)", 'f"(not {_fact(domain, element)})"'),
        ("_own_lane", "domain.of == element", "domain.of != element"),
        ("_one_zone", "(not (and {a} {b}))", "(not (or {a} {b}))"),
        ("_one_zone", "len(facts) == len(ZONES)", "len(facts) > 0"),
        ("_not_beside_itself", "(not {_fact(domain, element)})", "{_fact(domain, element)}"),
        ("_not_beside_itself", "domain.of == element", "domain.of != element"),
        ("_beside_both_ways", "(= {_fact", "(distinct {_fact"),
    ],
)
def test_a_planted_axiom_that_some_road_does_not_obey_is_noticed(monkeypatch, function, right, wrong):
    axiom = next(x for x in AXIOMS if x.instances.__name__ == function)
    plant(monkeypatch, road_axioms, function, right, wrong)
    planted = replace(axiom, instances=getattr(road_axioms, function))
    broken = 0
    for road in map(load_road, names_of("roads")):
        facts = [*facts_of(road)]
        known = dict.fromkeys((x, y) for x, y, _ in facts)
        some = [*known] if "len" not in right else [x for x in known if x[0].of != "main"]
        broken += not satisfiable(facts, planted.instances(some))
    assert broken


@pytest.mark.parametrize("name", CLAIMS)
def test_the_judge_finds_the_claim_true_on_random_roads_and_the_near_miss_false_on_some(name):
    rng, false = random.Random(7), dict.fromkeys(CLAIMS[name], 0)
    for _ in range(80):
        road, drive = random_road(rng), standing(rng)
        for claim in CLAIMS[name]:
            for lane in road.lanes:
                bound = bind(read_claim(HOME, claim).formula, road, {"L": lane}, VALUES)
                false[claim] += not judge(bound, drive).holds
    assert [bool(x) for x in false.values()] == [False, True]


def standing(rng):
    """Two vehicles that stand anywhere on the small grid of random roads."""
    still = (Piece(None, Fraction(0), Fraction(0)),)
    places = {name: [Fraction(rng.randint(low, 9)) for low in (1, 1, 0, 0)] for name in ("SV", "POV")}
    return Drive({x: Motion(*y, Fraction(0), Fraction(0), still) for x, y in places.items()})
