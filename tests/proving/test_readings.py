"""Proofs that need another reading of the claim: by names, or by lanelets; their certificates are checked."""

from dataclasses import replace

import pytest

from extensions.kernel.needs import needs_coq
from rejection import rejection_reason
from roadproof.engines.prove import prover
from roadproof.engines.prove.prover import prove
from roadproof.engines.prove.unknown import StopPoint
from roadproof.engines.solve.recall import check_sat
from roadproof.evidence.certificate_file import certificate_data, read_certificate_data
from roadproof.evidence.sites import StateLemma
from roadproof.extensions.kernel.accept import judge, prepare
from roadproof.extensions.kernel.coq import ready
from roadproof.library.assumption import NOTHING
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

LIBRARY = bundled_library()
HOME = LIBRARY.select()
SCENARIOS = [f"scenario_{number}(SV,POV,L)" for number in (1, 4, 11, 24)]
BY_NAMES = [
    "G F G F {} -> G F {}",
    "G F {} -> G F G F {}",
    "F G F G {} -> F G {}",
    "not F not F not F not F {} -> not F not F {}",
    "G F[0, 5 s] {} -> G F {}",
]
NOT_VALID = ["G F {} -> F G {}", "F {} -> G F {}", "G F G F {} -> F G {}"]


def answer(script):
    return check_sat(script, meter=Effort(5).meter())


def decided(claim):
    return prove(HOME, read_claim(HOME, claim), Effort(0.4))


@pytest.mark.parametrize("shape", BY_NAMES)
def test_a_scenario_that_is_met_twice_is_a_predicate(shape):
    for scenario in SCENARIOS:
        found = decided(shape.format(scenario, scenario))
        assert found.verdict is Verdict.PROVED
        assert found.certificate.reading in ("names", "states")
        stored = read_certificate_data(certificate_data(found.certificate), "here")
        assert stored.reading == found.certificate.reading
        assert rejection_reason(stored, LIBRARY, answer) is None


@pytest.mark.parametrize("scenario", [*SCENARIOS[:2], "danger(SV,POV)", "dangerArises(SV,POV)"])
@pytest.mark.parametrize("turn", ["G F ", "F G "])
def test_a_definition_that_is_a_predicate_costs_as_much_as_any_other(scenario, turn):
    """However deep it is nested: its own intervals and operators say nothing about the proof."""
    for depth in (3, 5, 8):
        plain, named = (decided(f"{turn * depth}{x} -> {turn}{x}") for x in ("atLane(SV,L)", scenario))
        assert {plain.verdict, named.verdict} == {Verdict.PROVED}
        again = prover._prove(
            HOME,
            read_claim(HOME, f"{turn * depth}{scenario} -> {turn}{scenario}"),
            Effort(0.4),
            NOTHING,
            "names",
        )
        assert len(again.certificate.instances) == len(plain.certificate.instances)
        assert again.work < plain.work + 0.01


@pytest.mark.parametrize("shape", NOT_VALID)
def test_what_is_not_valid_is_not_proved_by_names(shape):
    for scenario in SCENARIOS[:2]:
        assert decided(shape.format(scenario, scenario)).verdict is not Verdict.PROVED


def test_a_model_in_which_definitions_are_predicates_is_no_answer():
    """Nothing is said of states by a definition about several instants, whether it is true or false."""
    query = read_claim(HOME, f"F {SCENARIOS[1]} -> G {SCENARIOS[1]}")
    found = prover._prove(HOME, query, Effort(2), NOTHING, "names")
    assert (found.verdict, found.stop) == (Verdict.UNKNOWN, StopPoint.PLACE)


def test_different_scenarios_are_different_predicates():
    found = decided(f"G F G F {SCENARIOS[0]} -> G F {SCENARIOS[1]}")
    assert found.verdict is not Verdict.PROVED


def test_a_certificate_is_refused_in_another_reading():
    certificate = decided(BY_NAMES[0].format(SCENARIOS[1], SCENARIOS[1])).certificate
    assert certificate.reading == "names"
    for reading in ("states", "lanelets"):
        assert rejection_reason(replace(certificate, reading=reading), LIBRARY, answer) is not None


def test_a_lemma_about_several_instants_is_refused():
    certificate = decided(BY_NAMES[0].format(SCENARIOS[1], SCENARIOS[1])).certificate
    name = "scenario_4(SV, POV, L)"
    forged = replace(certificate, lemmas=(StateLemma(((name, True), (name, False)), ("0",)),))
    assert "speaks of several instants" in rejection_reason(forged, LIBRARY, answer)


@needs_coq
def test_the_kernel_accepts_proofs_by_names():
    claims = [shape.format(SCENARIOS[1], SCENARIOS[1]) for shape in BY_NAMES]
    found = {f"claim_{k}": decided(claim).certificate for k, claim in enumerate(claims)}
    with ready() as coq:
        rulings = judge(coq, {x: prepare(x, y, LIBRARY) for x, y in found.items()}).rulings
    assert {str(x) for x in rulings.values()} == {"accepted"}
