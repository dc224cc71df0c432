"""``proofs/`` is complete, fresh, and accepted by two solvers: stale evidence must not be shipped."""

import json
from pathlib import Path
from typing import Literal

import pytest

from roadproof.engines.prove.properties import template_properties
from roadproof.evidence.finding import Acceptance
from roadproof.frontends.api.checking import check
from roadproof.library.loading import bundled_library
from roadproof.questions.checking import QuestionFolder, read_folder
from roadproof.questions.prove import ProveQuestion
from roadproof.verdict import Verdict

PROOFS = Path(__file__).parents[1] / "proofs"
QUESTION = json.loads(PROOFS.joinpath("question.json").read_text("utf-8"))
EVIDENCE = sorted(path for path in PROOFS.glob("*.json") if path.name != "question.json")


@pytest.fixture(scope="module")
def folder() -> QuestionFolder:
    return read_folder(PROOFS)


def test_the_folder_answers_every_property_as_expected(folder: QuestionFolder) -> None:
    assert isinstance(folder.question, ProveQuestion)
    tasks = [x.task for x in folder.question.tasks]
    assert tasks == template_properties()
    verdicts = [folder.answers[x.name].verdict for x in folder.question.tasks]
    assert verdicts == [x.expected for x in tasks]


def test_the_question_names_the_definitions_at_hand() -> None:
    assert QUESTION["library"] == bundled_library().fingerprint, "prove all again, into a new folder"
    assert (QUESTION["basis"]["options"], QUESTION["basis"]["specs"]) == (
        bundled_library().select().options,
        [],
    )


def test_every_scenario_and_set_has_its_proof_that_danger_arises(folder: QuestionFolder) -> None:
    proved = {name for name, x in folder.answers.items() if x.verdict is Verdict.PROVED}
    expected = {f"P1-scenario-{i:02}-{s}" for i in range(1, 25) for s in ("base", "extA", "ext")}
    assert expected <= proved


def test_every_answer_has_evidence_and_no_file_is_left_over(folder: QuestionFolder) -> None:
    assert folder.problems == ()
    assert sorted(folder.files) == EVIDENCE
    assert not [*folder.undecided]


@pytest.mark.parametrize("solver", ["z3", "cvc5"])
def test_all_evidence_is_accepted(solver: Literal["z3", "cvc5"]) -> None:
    if solver == "cvc5":
        pytest.importorskip("cvc5", reason="cvc5 is not installed: pip install cvc5")
    rejected = [x for x in check(*EVIDENCE, solver=solver).findings if x.outcome is not Acceptance.ACCEPTED]
    assert not rejected
