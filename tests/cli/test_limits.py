"""Work limits and the backstop on the command line: one meaning everywhere, and doubt where they end."""

import json
from pathlib import Path

import pytest

from roadproof.frontends.cli.main import main

CLOCK = "cut off by the clock after 0.0001 s, not by the count of work"
PROOF = str(Path(__file__).parents[2] / "proofs/P1-scenario-04-base.json")
# Every command that searches, with the least that it has to be asked.
SEARCHING = {
    "prove": ["P1"],
    "witness": ["4"],
    "check": [PROOF],
    "compare": ["1", "4"],
    "overlap": ["--among", "3,4"],
    "order": ["--set", "base", "--among", "3,4"],
    "redundancy": ["--among", "3"],
    "coverage": ["--set", "ext"],
    "classify": ["--among", "4"],
    "explore": ["4", "--vary", "rho=0:3"],
}
CUT_OFF = [
    ("witness", "4"),
    ("witness", "4", "--engine", "smt"),
    ("prove", "scenario_4(SV,POV,L) -> dangerArises(SV,POV)"),
    ("prove", "scenario_4(SV,POV,L) -> dangerArises(SV,POV)", "--engine", "milp"),
    ("check", PROOF),
    ("compare", "1", "4"),
    ("overlap", "--among", "3,4", "--jobs", "1"),
    ("redundancy", "--among", "3", "--jobs", "1"),
    ("order", "--set", "base", "--among", "3,4", "--jobs", "1"),
    ("explore", "4", "--vary", "rho=0:3", "--steps", "2", "--jobs", "1"),
    ("classify", "--among", "4", "--no-shares", "--jobs", "1"),
]


@pytest.mark.parametrize("line", CUT_OFF, ids=" ".join)
def test_what_the_clock_cuts_off_is_in_doubt_and_says_so(line, capfd):
    assert main([*line, "--timeout", "0.0001"]) == 20
    printed = capfd.readouterr()
    assert CLOCK in printed.out + printed.err


@pytest.mark.parametrize(
    "line", [("witness", "4", "--engine", "smt"), ("prove", "P3", "--set", "base", "--no-drive")]
)
def test_what_work_cuts_off_does_not_speak_of_the_clock(line, capfd):
    assert main([*line, "--effort", "0.0001", "--json", "-"]) == 20
    verdicts = json.loads(capfd.readouterr().out)["verdicts"]
    reasons = {x["reason"].partition(";")[0] for x in verdicts}
    assert {x["verdict"] for x in verdicts} == {"UNKNOWN"}
    assert reasons == {"no answer within 0.0001 units of work"}


@pytest.mark.parametrize("option", ["--effort", "--timeout"])
@pytest.mark.parametrize("text", ["nan", "inf", "1e300", "0", "-5", "0.0", "much", "", "1_000", "٣"])
def test_limits_that_are_no_numbers_above_zero_are_refused_by_name(option, text, capsys):
    for command, asked in SEARCHING.items():
        assert main([command, *asked, f"{option}={text}"]) == 2
        assert f"roadproof: {option} {text}: write a decimal number greater than 0" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["nan", "inf", "1e300", "0", "-5", "1.5", "many"])
def test_numbers_of_processes_are_refused_by_name(text, capsys):
    for command, asked in SEARCHING.items():
        if command != "compare":
            assert main([command, *asked, f"--jobs={text}"]) == 2
            assert f"roadproof: --jobs {text}: write a whole number greater than 0" in capsys.readouterr().err


def test_limits_are_explained_in_one_way(capsys):
    explained = set()
    for command in SEARCHING:
        with pytest.raises(SystemExit):
            main([command, "--help-all"])
        words = " ".join(capsys.readouterr().out.split())
        assert "counted, so the answer is the same on every machine" in words
        explained.add(words[words.index("--timeout S seconds") :].split(")")[0])
    assert len(explained) == 1
