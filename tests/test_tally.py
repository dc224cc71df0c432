"""The figures of docs/explanation/tests.md are right, and the faults that it calls equivalent exist."""

import json

import pytest

import tally
from fuzz.run import READERS
from lengthy import COLLECTED
from mutants import journal
from mutants.__main__ import PACKAGE
from mutants.choose import faults_of, targets


def test_no_fault_is_planted_less_than_told(request: pytest.FixtureRequest) -> None:
    """Only where all tests are collected: fewer files say nothing."""
    items = request.config.stash[COLLECTED]
    every = set(tally.ROOT.glob("tests/**/test_*.py"))
    if {item.path for item in items} != every:
        pytest.skip("not all tests were collected")
    counted = sum(tally.is_planted(item.nodeid) for item in items)
    *_, (name, told) = tally.read(tally.FOLDER / "planted.csv")
    assert name == "all"
    assert 0 < int(told) <= counted


def test_every_equivalent_fault_is_one_that_can_be_made_and_survived() -> None:
    known = journal.read()
    made = {fault.key for file in targets(PACKAGE) for fault in faults_of(PACKAGE, file)}
    for key, why in journal.equivalents().items():
        assert len(why) > 20, key
        assert key in made, f"{key}: no such fault any more, leave it out"
        assert known[key].verdict in ("survived", "unreached", "hung"), key


def test_the_fuzz_was_run_through_every_reader() -> None:
    kept = json.loads((tally.ROOT / "tests/fuzz/results.json").read_text("utf-8"))
    assert {entry["reader"] for entry in kept} == set(READERS)
    assert all(entry["disagreements"] == 0 for entry in kept)
