"""``proofs/`` is complete, fresh, and accepted by two solvers: stale evidence must not be shipped."""

import json
from pathlib import Path
from typing import Literal

import pytest

from roadproof.engines.prove.properties import template_properties
from roadproof.evidence.certificate import read_certificate
from roadproof.evidence.finding import Acceptance
from roadproof.frontends.api.checking import check
from roadproof.library.loading import bundled_library
from roadproof.verdict import Verdict

PROOFS = Path(__file__).parents[1] / "proofs"
INDEX = json.loads(PROOFS.joinpath("index.json").read_text("utf-8"))
EVIDENCE = sorted(path for path in PROOFS.glob("*.json") if path.name != "index.json")


def test_index_answers_every_property_as_expected() -> None:
    answered = [
        (e["property"], e["part"], e["scenario"], e["set"], e["claim"], e["verdict"]) for e in INDEX["claims"]
    ]
    expected = [
        (x.id, x.part, x.scenario, x.set_name, x.claim, str(x.expected)) for x in template_properties()
    ]
    assert answered == expected


def test_index_names_the_definitions_at_hand() -> None:
    assert INDEX["library"] == bundled_library().fingerprint, "prove all again, into a new folder"
    assert (INDEX["options"], INDEX["specs"]) == (bundled_library().select().options, [])


def test_every_scenario_and_set_has_its_proof_that_danger_arises() -> None:
    proved = {
        (e["scenario"], e["set"])
        for e in INDEX["claims"]
        if e["property"] == "P1" and e["verdict"] == Verdict.PROVED
    }
    assert proved == {(i, s) for i in range(1, 25) for s in ("base", "extA", "ext")}


def test_every_answer_has_evidence_and_no_file_is_left_over() -> None:
    named = [e["evidence"] for e in INDEX["claims"] if e["evidence"] is not None]
    assert sorted(named) == [path.name for path in EVIDENCE]
    for entry in INDEX["claims"]:
        assert entry["evidence"] or entry["counterexample"], entry


def test_certificates_are_of_the_claims_that_the_index_names() -> None:
    for entry in INDEX["claims"]:
        if entry["verdict"] == Verdict.PROVED:
            certificate = read_certificate(PROOFS / entry["evidence"])
            assert certificate.claim == entry["claim"].strip()
            assert (certificate.set_name, certificate.scenario) == (entry["set"], entry["scenario"])


@pytest.mark.parametrize("solver", ["z3", "cvc5"])
def test_all_evidence_is_accepted(solver: Literal["z3", "cvc5"]) -> None:
    if solver == "cvc5":
        pytest.importorskip("cvc5", reason="cvc5 is not installed: pip install cvc5")
    rejected = [x for x in check(*EVIDENCE, solver=solver).findings if x.outcome is not Acceptance.ACCEPTED]
    assert not rejected
