"""Claims about motions: proved from facts that are made anew, refuted by drives, and in doubt otherwise."""

import json
import shutil
from collections.abc import Callable
from copy import deepcopy
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import roadproof as rp
from engine_calls import prove as prove_text
from evidence.folders import answer, read, write
from proving.claims import specification as known_specification
from rejection import rejection_reason
from roadproof.engines.prove.motion import axiom_choices, prove_for_motions
from roadproof.engines.prove.properties import Task, name_of_claim, template_properties
from roadproof.engines.prove.prover import prove
from roadproof.engines.search import decide as settling
from roadproof.engines.search.decide import decide_claim
from roadproof.engines.solve.smt import check_sat
from roadproof.evidence.certificate_file import certificate_data, read_certificate_data
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.library.assumption import SCHEMAS, Assumption, Axiom
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import motion
from roadproof.logic import terms as t
from roadproof.logic.rewrite import with_values
from roadproof.questions.question import QUESTION
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import judge
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import state_at

specification = bundled_library().select("base")
BEHIND = "G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) <= s(POV)"
LIMITED = "v_lon(SV) <= 20 m/s -> G[0, 2 s] v_lon(SV) <= 24 m/s"
LEAVES = "atLane(SV,L) and F not atLane(SV,L) -> atLane(SV,L) U not atLane(SV,L)"
LIMIT = "a_lon(SV) <= 2 m/s^2"
# Proved with facts of every schema.
MOVING = [
    (BEHIND, ("motion",)),
    (LIMITED, ("motion", LIMIT)),
    (LEAVES, ("motion",)),
    ("s(SV) < s(POV) and F s(SV) > s(POV) -> F s(SV) = s(POV)", ("motion",)),
    ("s(SV) <= s(POV) and F s(SV) > s(POV) -> F v_lon(SV) > v_lon(POV)", ("motion",)),
    ("v_lon(SV) <= 9 m/s and G[0, 3 s] a_lon(SV) <= -3 m/s^2 -> F[0, 3 s] v_lon(SV) <= 0 m/s", ("motion",)),
    ("v_lon(SV) <= 3 m/s and s(SV) <= 0 m -> G[2 s, 2 s] s(SV) <= 10 m", ("motion", LIMIT)),
    ("v_lon(SV) <= 3 m/s and s(SV) <= 0 m -> G[0, 2 s] s(SV) <= 10 m", ("motion", LIMIT)),
]


@cache
def proof(claim: str, said: tuple[str, ...] = ("motion",)) -> Any:
    """The certificate of a claim about motions, as data."""
    result = prove_for_motions(specification, read_claim(specification, claim), said, Effort(20))
    assert result.verdict is Verdict.PROVED, result.reason
    assert result.certificate is not None
    return certificate_data(result.certificate)


def refused(data: Any) -> str | None:
    return rejection_reason(read_certificate_data(data, "it"), specification.library, answer)


@pytest.mark.parametrize(("claim", "said"), MOVING)
def test_a_proof_of_motions_is_accepted_by_two_solvers(claim, said):
    certificate = read_certificate_data(json.loads(json.dumps(proof(claim, said))), "it")
    assert certificate.claim == claim
    assert certificate.assumed.texts == said
    assert certificate.assumed.axioms
    for solver in ("z3", "cvc5"):
        asked = [check_sat(query, solver, Effort(20).meter()) for _, query in certificate.queries]
        assert {*asked} == {"unsat"}
    assert refused(proof(claim, said)) is None


def test_all_schemas_are_used():
    used = {x["schema"] for claim, said in MOVING for x in proof(claim, said)["axioms"]}
    assert used == {*SCHEMAS}


@pytest.mark.parametrize(("claim", "said"), [x for x in MOVING if x[0] != LEAVES])
def test_the_same_is_refuted_by_a_trace_where_nothing_is_assumed(claim, said):
    found = decide_claim(specification, read_claim(specification, claim), Effort(5), seek_drive=False)
    assert (found.verdict, found.refuted_by) == (Verdict.REFUTED, "trace")


def test_what_needs_no_motion_is_proved_without():
    claim = "danger(SV,POV) -> danger(POV,SV)"
    data = proof(claim)
    assert (data["assuming"], data["axioms"]) == (["motion"], [])
    assert refused(data) is None


def test_a_premise_that_no_motion_has_makes_a_claim_vacuous():
    claim = "(G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) and F s(SV) > s(POV)) -> danger(SV,POV)"
    found = decide_claim(specification, read_claim(specification, claim), Effort(5), assumed=("motion",))
    assert found.verdict is Verdict.VACUOUS
    assert refused(certificate_data(found.result.certificate)) is None


# --- refutations ---------------------------------------------------------------------------------

FALSE = "v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) <= s(POV)"


def test_only_a_drive_refutes_a_claim_about_motions():
    query = read_claim(specification, FALSE)
    with_drive = decide_claim(specification, query, Effort(10), assumed=("motion",))
    assert (with_drive.verdict, with_drive.refuted_by) == (Verdict.REFUTED, "drive")
    assert with_drive.result.countermodel is None
    without = decide_claim(specification, query, Effort(2), seek_drive=False, assumed=("motion",))
    assert without.verdict is Verdict.UNKNOWN
    assert without.refuted_by is None
    assert "no drive that refutes it was looked for" in without.result.reason


def test_a_drive_refutes_within_the_limits_that_are_said():
    query = read_claim(specification, "v_lon(SV) <= 20 m/s -> G[0, 2 s] v_lon(SV) <= 23 m/s")
    found = decide_claim(specification, query, Effort(10), assumed=("motion", LIMIT))
    assert found.refuted_by == "drive"
    assert found.drive.file.formula.startswith(f"not (G {LIMIT} -> ")
    assert all(piece.a_lon <= 2 for piece in found.drive.file.drive.vehicles["SV"].pieces)


def test_a_trace_with_all_facts_at_its_instants_refutes_nothing():
    query = read_claim(specification, FALSE)
    for axioms in axiom_choices(specification, query):
        result = prove(specification, query, Effort(0.5), assumed=Assumption(("motion",), axioms))
        assert (result.verdict, result.countermodel) == (Verdict.UNKNOWN, None)


def test_without_a_proof_and_without_a_drive_it_is_in_doubt(monkeypatch):
    monkeypatch.setattr(settling._Decider, "_quick", lambda *x: None)
    monkeypatch.setattr(settling._Decider, "_searched", lambda *x: None)
    found = decide_claim(specification, read_claim(specification, FALSE), Effort(2), assumed=("motion",))
    assert found.verdict is Verdict.UNKNOWN


# --- planted faults: certificates ----------------------------------------------------------------


def without_what_is_assumed(data):
    del data["assuming"], data["axioms"]


def without_axioms(data):
    data["axioms"] = []


def without_saying_so(data):
    del data["assuming"]


def nothing_said(data):
    data["assuming"] = []


def something_else_said(data):
    data["assuming"] = ["rest"]


def a_limit_more(data):
    data["assuming"].append("v_lon(SV) <= 0 m/s")


def a_false_limit(data):
    data["assuming"].append("false")


def another_schema(data):
    data["axioms"][0]["schema"] = "at-most"


def unknown_schema(data):
    data["axioms"][0]["schema"] = "anything"


def the_other_way_round(data):
    arguments = data["axioms"][0]["arguments"]
    arguments["left"], arguments["right"] = arguments["right"], arguments["left"]


def no_affine_combination(data):
    data["axioms"][0]["arguments"]["left"] = "s(SV)*s(SV)/(1 m)"


def of_accelerations(data):
    data["axioms"][0]["arguments"] = {"left": "a_lon(SV)", "right": "a_lon(POV)"}


def of_a_stranger(data):
    data["axioms"][0]["arguments"]["left"] = "s(POV9)"


def a_formula_for_a_term(data):
    data["axioms"][0]["arguments"]["left"] = "0 m <= 1 m and s(SV)"


def an_argument_more(data):
    data["axioms"][0]["arguments"]["speed"] = "1 m/s"


def arguments_out_of_order(data):
    data["axioms"][0]["arguments"] = dict(reversed(data["axioms"][0]["arguments"].items()))


def a_formula_of_its_own(data):
    data["axioms"][0]["formula"] = "false"


def closed_for_open(data):
    data["axioms"][0] = {"schema": "leaves", "arguments": {"inside": "s(SV) <= s(POV)"}}


def a_negative_time(data):
    arguments = {"left": "s(SV)", "right": "s(POV)", "speed": "1 m/s", "time": "-1 s"}
    data["axioms"][0] = {"schema": "after", "arguments": arguments}


def too_many(data):
    data["axioms"] *= 501


SPOILERS: list[Callable[[Any], None]] = [
    without_what_is_assumed,
    without_axioms,
    without_saying_so,
    nothing_said,
    something_else_said,
    a_limit_more,
    a_false_limit,
    another_schema,
    unknown_schema,
    the_other_way_round,
    no_affine_combination,
    of_accelerations,
    of_a_stranger,
    a_formula_for_a_term,
    an_argument_more,
    arguments_out_of_order,
    a_formula_of_its_own,
    closed_for_open,
    a_negative_time,
    too_many,
]


@pytest.mark.parametrize("planted", SPOILERS)
def test_a_planted_fault_in_what_is_assumed_is_noticed(planted, tmp_path):
    data = deepcopy(proof(BEHIND))
    planted(data)
    write(tmp_path / "it.json", data)
    [finding] = check(tmp_path)
    assert finding.outcome in (Acceptance.REJECTED, Acceptance.UNREADABLE)


def test_a_hand_edited_axiom_in_the_queries_is_noticed(tmp_path):
    """The facts are made of schema and arguments again: other formulas and queries do not fit them."""
    told = json.dumps(proof(BEHIND))
    edited = told.replace("v_lon(SV) <= v_lon(POV)| (not", "true| (not")
    assert edited != told
    write(tmp_path / "it.json", json.loads(edited))
    [finding] = check(tmp_path)
    assert finding.outcome is Acceptance.REJECTED


@pytest.mark.parametrize("name", [x.replace("-", "_") for x in SCHEMAS])
def test_a_mutant_of_a_schema_is_noticed_by_who_has_the_right_one(name, monkeypatch):
    """A prover whose schema says too much makes certificates that nobody else accepts."""
    claims = [(c, said) for c, said in MOVING if name.replace("_", "-") in schemas_of(c, said)]
    claim, said = claims[0]
    right = getattr(motion, name)

    def wrong(*arguments: Any) -> Any:
        made = right(*arguments)
        return type(made)(made.interval, made.body.parts[1])

    with monkeypatch.context() as patch:
        patch.setattr(motion, name, wrong)
        query = read_claim(specification, claim)
        result = prove(specification, query, Effort(5), assumed=Assumption(said, axioms_of(claim, said)))
        assert result.verdict in (Verdict.PROVED, Verdict.VACUOUS)
    assert refused(certificate_data(result.certificate)) is not None


def schemas_of(claim: str, said: tuple[str, ...]) -> set[str]:
    return {x["schema"] for x in proof(claim, said)["axioms"]}


def axioms_of(claim: str, said: tuple[str, ...]) -> tuple[Axiom, ...]:
    return read_certificate_data(proof(claim, said), "it").assumed.axioms


def test_a_rate_that_is_none_proves_nothing_to_others(monkeypatch):
    """Planted: the rate of s is taken to be v_lat."""
    claim = "G v_lat(SV) <= v_lat(POV) and s(SV) < s(POV) -> G s(SV) < s(POV)"
    query = read_claim(specification, claim)
    with monkeypatch.context() as patch:
        patch.setattr(motion, "RATES", {**motion.RATES, "s": "v_lat"})
        result = prove_for_motions(specification, query, ("motion",), Effort(5))
        assert result.verdict is Verdict.PROVED
    assert refused(certificate_data(result.certificate)) is not None
    assert prove_for_motions(specification, query, ("motion",), Effort(2)).verdict is Verdict.UNKNOWN


def test_rates_are_of_the_list_of_signals():
    assert motion.RATES == {"s": "v_lon", "d": "v_lat", "v_lon": "a_lon", "v_lat": "a_lat"}
    assert motion.rate(t.Signal("s", "SV")) == t.Signal("v_lon", "SV")


# --- planted faults: folders ---------------------------------------------------------------------


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A claim about motions, proved, and one that is refuted, each with its file."""
    out = tmp_path_factory.mktemp("made") / "out"
    rp.prove(BEHIND, FALSE, assume="motion", jobs=1, out=out)
    return out


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    """The same, to be spoiled."""
    shutil.copytree(made, tmp_path / "out")
    return tmp_path / "out"


def check(folder: Path) -> tuple[Finding, ...]:
    return rp.check(folder, jobs=1).findings


def findings(folder: Path) -> list[Acceptance]:
    return [x.outcome for x in check(folder)]


def asked_in(folder: Path) -> list[dict[str, Any]]:
    return read(folder / QUESTION)["asked"]["claims"]


def file_of(folder: Path, claim: str, *assuming: str) -> Path:
    return folder / f"{name_of_claim(claim, 'base', assuming)}.json"


def test_what_is_assumed_is_a_part_of_the_answer(folder):
    told = [str(x) for x in check(folder)]
    assert all("assuming motion: " in x for x in told)
    assert {x["assuming"][0] for x in asked_in(folder)} == {"motion"}
    again = rp.prove(BEHIND, drive=False, jobs=1, out=folder)
    assert (again.verdict, again.answers[0].refuted_by) == (Verdict.REFUTED, "trace")
    kept = rp.prove(BEHIND, assume="motion", jobs=1, out=folder)
    assert kept.verdict is Verdict.PROVED
    assert len(asked_in(folder)) == 3
    assert findings(folder) == [Acceptance.ACCEPTED] * 3
    assert name_of_claim(BEHIND, "base") != name_of_claim(BEHIND, "base", ("motion",))
    assert name_of_claim(BEHIND, "base", ("motion",)) != name_of_claim(BEHIND, "base", ("motion", LIMIT))


def spoil(folder: Path, change: Callable[[dict[str, Any]], None], number: int) -> None:
    question = read(folder / QUESTION)
    change(question["asked"]["claims"][number])
    write(folder / QUESTION, question)


def test_a_question_that_does_not_say_what_is_assumed_is_noticed_as_a_planted_fault(folder):
    spoil(folder, lambda entry: entry.pop("assuming"), 0)
    assert Acceptance.REJECTED in findings(folder)


def test_a_question_that_says_a_limit_more_is_noticed_as_a_planted_fault(folder):
    for number in (0, 1):
        spoil(folder, lambda entry: entry["assuming"].append(LIMIT), number)
    assert findings(folder).count(Acceptance.REJECTED) >= 2


def test_a_trace_for_a_drive_is_noticed_as_a_planted_fault(folder, tmp_path):
    rp.prove(BEHIND, drive=False, jobs=1, out=tmp_path / "free")
    free = read(file_of(tmp_path / "free", BEHIND))
    write(file_of(folder, BEHIND, "motion"), free | {"assuming": ["motion"]})
    told = [x for x in check(folder) if x.outcome is Acceptance.REJECTED]
    assert any("only a drive refutes" in x.reason for x in told)


def test_a_certificate_without_what_it_assumes_is_noticed_as_a_planted_fault_of_its_folder(folder):
    path = file_of(folder, BEHIND, "motion")
    data = read(path)
    without_what_is_assumed(data)
    write(path, data)
    assert Acceptance.REJECTED in findings(folder)


# --- The RSS guarantee (P9): what is proved holds of drives, and its refuted control is a crash -----

NONE = Fraction(0)
LENGTH = Fraction(9, 2)


def moving(front: Fraction, speed: Fraction, phases: list[tuple[Fraction, Fraction]]) -> Motion:
    """A car whose front starts at ``front``; after phases of (duration, acceleration) it keeps its speed."""
    pieces = [Piece(duration, a, NONE) for duration, a in phases if duration > 0]
    return Motion(LENGTH, Fraction(9, 5), front, NONE, speed, NONE, (*pieces, Piece(None, NONE, NONE)))


def worst_case(v_r: Fraction, v_f: Fraction, gap: Fraction, p: dict[str, Fraction]) -> Drive:
    """SV accelerates for rho, then brakes by b_min; POV, ``gap`` ahead, brakes by b_max; both to a stand."""
    reached = v_r + p["a_max"] * p["rho"]
    rear = moving(NONE, v_r, [(p["rho"], p["a_max"]), (reached / p["b_min"], -p["b_min"])])
    front = moving(gap + LENGTH, v_f, [(v_f / p["b_max"], -p["b_max"])])
    return Drive({"SV": rear, "POV": front})


def is_true(claim: str, drive: Drive, parameters: dict[str, Fraction]) -> bool:
    return judge(with_values(read_claim(known_specification(), claim).formula, parameters), drive).holds


GAP = "s(POV) - length(POV) - s(SV)"
FAR_ENOUGH = f"{GAP} > dRSS_lon(v_lon(SV), v_lon(POV))"
TOUCH = f"F {GAP} <= 0 m"


@pytest.mark.parametrize("time", ["0", "0.25", "0.5", "0.75", "2", "60"])
def test_the_envelopes_are_the_distances_of_the_worst_case(time: str):
    parameters = default_values(known_specification().library) | {"rho": Fraction(1, 2)}
    drive = worst_case(Fraction(20), Fraction(30), Fraction(10), parameters)
    for name, speed, vehicle in (("rearAtMost", "20", "SV"), ("frontAtLeast", "30", "POV")):
        motion = drive.vehicles[vehicle]
        gone = state_at(motion, Fraction(time)).s - motion.s
        told = f"{name}({speed} m/s, {time} s)"
        for low, high, expected in ((-1, 1, True), (1, 2, False), (-2, -1, False)):
            least, most = (f"{float(gone) + end / 10**6:.9f}" for end in (low, high))
            assert is_true(f"{told} >= {least} m and {told} <= {most} m", drive, parameters) == expected


def test_from_a_stand_too_the_distance_is_a_promise():
    """It is not kept where the front may brake less hard than the rear does, and that has to be seen."""
    parameters = default_values(known_specification().library)
    parameters |= {"a_max": Fraction(3), "rho": Fraction(1), "b_min": Fraction(20), "b_max": Fraction(1, 10)}
    drive = worst_case(Fraction(0), Fraction(1), Fraction(10), parameters)
    assert not is_true("staysApart(0 m/s, 1 m/s, 0.01 m, 1 s)", drive, parameters)
    assert is_true("staysApart(0 m/s, 1 m/s, 0.01 m, 0 s)", drive, parameters)
    assert is_true("staysApart(0 m/s, 1 m/s, 2 m, 1 s)", drive, parameters)


def task(name: str) -> Task:
    (found,) = [task for task in template_properties() if task.id == name]
    return found


def test_the_refuted_control_is_a_crash():
    result = prove_text(known_specification(), task("C5").claim, Effort(30))
    assert result.verdict is Verdict.REFUTED, result.reason
    assert result.countermodel is not None
    parameters = dict(result.countermodel.parameters)
    values = result.countermodel.instants[0].values
    assert parameters["b_min"] > parameters["b_max"] > 0
    drive = worst_case(values["v_r"], values["v_f"], values["gap"], parameters)
    assert is_true(FAR_ENOUGH, drive, parameters)
    assert is_true(f"{GAP} > 0 m", drive, parameters)
    assert is_true(TOUCH, drive, parameters)


@pytest.mark.parametrize("b_min", [Fraction(3), Fraction(6), Fraction(8)])
@pytest.mark.parametrize("rho", [NONE, Fraction(3, 5), Fraction(2)])
@settings(max_examples=12, deadline=None, derandomize=True, database=None)
@given(st.integers(0, 40), st.integers(0, 40), st.fractions(Fraction(1, 100), 20))
def test_a_gap_above_the_distance_is_never_used_up(b_min, rho, v_r, v_f, more):
    """What P9 says, and that it says it of the very drive that comes nearest."""
    parameters = default_values(known_specification().library) | {"b_min": b_min, "rho": rho}
    reached = v_r + parameters["a_max"] * rho
    responding = v_r * rho + parameters["a_max"] * rho**2 / 2
    braking = reached**2 / (2 * b_min) - Fraction(v_f) ** 2 / (2 * parameters["b_max"])
    nearest = max(NONE, responding + braking)
    drive = worst_case(Fraction(v_r), Fraction(v_f), nearest + more, parameters)
    assert is_true(FAR_ENOUGH, drive, parameters)
    assert not is_true(TOUCH, drive, parameters)
    if nearest > 0:
        tight = worst_case(Fraction(v_r), Fraction(v_f), nearest, parameters)
        assert not is_true(FAR_ENOUGH, tight, parameters)
        assert is_true(TOUCH, tight, parameters)


def test_the_guarantee_is_not_vacuous():
    """Its premise has models: else it would say nothing."""
    premise = "b_min <= b_max and 0 <= v_r and 0 <= v_f and 0 <= t and gap > dRSS_lon(v_r, v_f)"
    result = prove_text(
        known_specification(), f"given v_r, v_f: m/s; gap: m; t: s: not ({premise})", Effort(10)
    )
    assert result.verdict is Verdict.REFUTED, result.reason
