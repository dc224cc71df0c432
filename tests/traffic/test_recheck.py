"""Answers of an evaluation asked once more: what is right is not denied, and what is wrong is named."""

from dataclasses import replace

import numpy as np
import pytest

from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario, lane_owner
from roadproof.recordings.evaluate.evaluate import Findings, evaluate_recording
from roadproof.recordings.evaluate.questions import Questions, ask, default_settings
from roadproof.recordings.evaluate.recheck import recheck
from roadproof.recordings.formats.recording import Recording, keep_vehicles
from traffic.test_evaluate import planted_traffic


@pytest.fixture(scope="module")
def questions() -> Questions:
    return ask(default_settings(), 25)


@pytest.fixture(scope="module")
def recording() -> Recording:
    """A drive with two vehicles and one with three, and nobody else."""
    whole, who = planted_traffic(1)
    kept = [number for name in ("cut-in", "cut-out") for number in who[name].values()]
    return keep_vehicles(whole, np.isin(whole.vehicle_id, kept))


@pytest.fixture(scope="module")
def findings(recording: Recording, questions: Questions) -> Findings:
    found = evaluate_recording(recording, questions)
    assert {x.pov2 is None for x in found.matches} == {True, False}
    return found


def test_what_is_right_is_not_denied(recording: Recording, questions: Questions, findings: Findings) -> None:
    assert list(recheck(recording, questions, findings)) == []


def test_a_match_that_was_missed_is_named(
    recording: Recording, questions: Questions, findings: Findings
) -> None:
    for match in [x for x in findings.matches if x.pov2 is None][:3]:
        less = replace(findings, matches=tuple(x for x in findings.matches if x != match))
        (line,) = recheck(recording, questions, less)
        assert f"vehicles {match.sv}, {match.pov}, frames" in line
        assert f"scenario {match.scenario}: missed" in line


def test_a_match_too_many_is_named(recording: Recording, questions: Questions, findings: Findings) -> None:
    """Two vehicles in another scenario about the same lane, and three in another lane."""
    others = []
    for match in findings.matches:
        if match.pov2 is None:
            asked = [x.number for x in questions.pairs[match.min_danger].formulas]
            alike = [n for n in asked if _owner(n) == _owner(match.scenario)]
            others += [replace(match, scenario=n) for n in alike]
        else:
            others += [replace(match, lane=x.name) for x in recording.lanes]
    for many in (False, True):
        wrong = next(x for x in others if x not in findings.matches and (x.pov2 is not None) == many)
        (line,) = recheck(recording, questions, replace(findings, matches=(*findings.matches, wrong)))
        assert f"scenario {wrong.scenario}: found, but the recursive evaluator denies it" in line


def _owner(number: int) -> str:
    return lane_owner(bundled_library().select(), Scenario(number, "base"))
