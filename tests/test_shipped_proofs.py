"""``proofs/`` is complete, fresh, and accepted by two solvers: stale evidence must not be shipped."""

import json
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pytest

from roadproof.cli.check import Job, examine
from roadproof.effort import Effort
from roadproof.evidence.certificate import read_certificate
from roadproof.evidence.finding import Outcome
from roadproof.prove.properties import template_properties
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


@pytest.fixture(scope="module")
def pool() -> Iterator[ProcessPoolExecutor]:
    with ProcessPoolExecutor(2) as made:
        yield made


@pytest.mark.parametrize("solver", ["z3", "cvc5"])
def test_all_evidence_is_accepted(solver: str, pool: ProcessPoolExecutor) -> None:
    if solver == "cvc5":
        pytest.importorskip("cvc5", reason="cvc5 is not installed: pip install roadproof[cvc5]")
    jobs = [Job(path, (), solver, Effort()) for path in EVIDENCE]
    rejected = [
        finding for finding in pool.map(examine, jobs, chunksize=8) if finding.outcome is not Outcome.ACCEPTED
    ]
    assert not rejected
