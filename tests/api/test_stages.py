"""What a question is at, told while it is asked; how whoever listens ends it; compare with both at once."""

import multiprocessing

import pytest

import roadproof as rp
from roadproof.engines.search import compare as comparing
from roadproof.frontends.cli.main import main

BEFORE, AFTER = "F[0, 1.2 s] danger(SV,POV)", "F[0, 0.6 s] danger(SV,POV)"


def test_a_search_tells_its_stages_in_order():
    told: list[rp.Stage] = []
    assert rp.witness(AFTER, jobs=1, stage=told.append).verdict is rp.Verdict.WITNESSED
    assert [x.name for x in told][:2] == ["encode", "solve"]
    assert {"shape", "judge"} <= {x.name for x in told}
    assert {x.of for x in told} == {f"{AFTER} base"}
    assert told[0].told.startswith("dt=3/5 s up to 6 s, natural drives")
    assert [x.seconds for x in told] == sorted(x.seconds for x in told)
    told.clear()
    rp.prove("danger(SV,POV) -> danger(POV,SV)", jobs=1, stage=told.append)
    assert {x.name for x in told} == {"prove"}


@pytest.mark.parametrize("name", ["encode", "solve", "judge"])
def test_whoever_listens_ends_a_search_between_two_stages(name):
    def end(stage: rp.Stage) -> None:
        heard.append(stage.name)
        if stage.name == name:
            raise rp.Cancelled("enough")

    heard: list[str] = []
    with pytest.raises(rp.Cancelled, match="enough"):
        rp.witness(AFTER, jobs=1, stage=end)
    assert heard[-1] == name
    assert rp.witness(AFTER, jobs=1).verdict is rp.Verdict.WITNESSED


def test_workers_are_heard_and_ended(tmp_path):
    """Two questions in two processes: what they are at is told here, and ending it leaves none behind."""
    told: list[rp.Stage] = []
    rp.witness(BEFORE, AFTER, jobs=2, stage=told.append, pictures=False)
    assert {x.of for x in told} == {f"{BEFORE} base", f"{AFTER} base"}

    def end(stage: rp.Stage) -> None:
        raise rp.Cancelled(stage.name)

    before = multiprocessing.active_children()
    with pytest.raises(rp.Cancelled):
        rp.witness(BEFORE, AFTER, jobs=2, stage=end)
    assert multiprocessing.active_children() == before


@pytest.mark.parametrize("jobs", [1, 2])
def test_both_directions_are_answered_alike_however_they_are_asked(jobs):
    came: dict[str, str] = {}
    told: list[rp.Stage] = []
    answer = rp.compare(
        BEFORE, AFTER, jobs=jobs, each=lambda name, x: came.update({name: str(x.verdict)}), stage=told.append
    )
    assert answer.relation == "weaker"
    assert came == {"first implies second": "REFUTED", "second implies first": "PROVED"}
    assert {x.of for x in told} == {*came}
    assert answer.check().accepted


def test_the_first_answer_is_told_while_the_other_is_still_looked_for(monkeypatch):
    plain, told = comparing._imply, multiprocessing.get_context("fork").Event()

    def wait(question):
        if question.name == "first implies second":
            assert told.wait(300)
        return plain(question)

    monkeypatch.setattr(comparing, "_imply", wait)
    came: list[str] = []
    rp.compare(BEFORE, AFTER, jobs=2, each=lambda name, _: (came.append(name), told.set()))
    assert came == ["second implies first", "first implies second"]


def test_a_direction_that_is_lost_or_late_leaves_the_other(monkeypatch):
    plain = comparing._imply

    def die(question):
        if question.name == "first implies second":
            import os

            os._exit(7)
        return plain(question)

    monkeypatch.setattr(comparing, "_imply", die)
    answer = rp.compare(BEFORE, AFTER, jobs=2)
    forward, backward = answer.comparison.directions.values()
    assert (str(forward.verdict), str(backward.verdict)) == ("UNKNOWN", "PROVED")
    assert "its process ended twice" in forward.reason
    monkeypatch.setattr(comparing, "_imply", plain)
    late = rp.compare(BEFORE, AFTER, jobs=1, timeout=1e-6)
    assert {x.verdict for x in late.comparison.directions.values()} == {rp.Verdict.UNKNOWN}
    assert all("cut off by the clock" in x.reason for x in late.comparison.directions.values())


def test_the_command_line_tells_each_answer_when_it_is_there(capsys):
    assert main(["compare", BEFORE, AFTER, "--jobs", "2"]) == 0
    found = capsys.readouterr()
    assert "second implies first: PROVED (after" in found.err
    assert "first implies second: REFUTED (after" in found.err
    assert "the first is weaker" in found.out
    assert main(["compare", BEFORE, AFTER, "--quiet", "--jobs", "1"]) == 0
    assert capsys.readouterr().err == ""
