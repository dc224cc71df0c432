"""Options that sub-commands share."""

import argparse
import os
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

import pytest

from roadproof.analysis.claims import Claims
from roadproof.errors import InputError, UsageError
from roadproof.frontends.cli import options, prove
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.main import main
from roadproof.frontends.settings.flags import add_flags, read_keywords
from roadproof.frontends.settings.groups import Definitions
from roadproof.frontends.settings.questions import Prove


def parsed(*arguments: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    add_flags(parser, Definitions)
    options.add_json_option(parser)
    return parser.parse_args(arguments)


def values_given(*arguments: str) -> Mapping[str, Fraction]:
    return read_definitions(parsed(*arguments), Definitions).values


@pytest.mark.parametrize(
    ("given", "name", "value"),
    [
        ("rho=0.6", "rho", Fraction(3, 5)),
        ("rho=3/5", "rho", Fraction(3, 5)),
        ("rho=600 ms", "rho", Fraction(3, 5)),
        ("rho=600ms", "rho", Fraction(3, 5)),
        ("rho = 1 s", "rho", Fraction(1)),
        ("minDanger=0", "minDanger", Fraction(0)),
        ("b_max=8.5 m/s^2", "b_max", Fraction(17, 2)),
        ("a_max=1/3", "a_max", Fraction(1, 3)),
    ],
)
def test_parameters_are_rationals_with_units(given: str, name: str, value: Fraction) -> None:
    assert values_given("--param", given) == {name: value}
    assert values_given() == {}


def test_the_last_value_counts() -> None:
    assert values_given("--param", "rho=1", "--param", "rho=2") == {"rho": 2}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("roh=1", "there is no parameter 'roh'; did you mean 'rho'"),
        ("rho=fast", "this is no value"),
        ("rho=1e3", "there is no unit|this is no value"),
        ("rho=1/0", "the denominator is zero"),
        ("rho=-1", "the library demands rho >= 0"),
        ("b_min=0", "the library demands b_min > 0"),
        ("rho=1 m", "rho is in s, which m does not measure"),
        ("rho=1 hour", "there is no unit 'hour'"),
        ("rho=" + "9" * 4000, "this is no value"),
    ],
)
def test_parameters_that_make_no_sense(given: str, message: str) -> None:
    with pytest.raises(InputError, match=f"--param .*{message}"):
        values_given("--param", given)


@pytest.mark.parametrize("given", ["rho", "=1", "rho="])
def test_assignments_need_two_sides(given: str) -> None:
    with pytest.raises(UsageError, match="NAME=VALUE"):
        values_given("--param", given)


def test_specification_is_selected(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("set mine extends ext {}\ndef p(a: vehicle) := true", "utf-8")
    words = ("--spec", str(mine), "--set", "mine", "--option", "lateral_sign=literal")
    chosen = read_definitions(parsed(*words), Definitions).specification
    assert chosen.set_name == "mine"
    assert chosen.options["lateral_sign"] == "literal"
    assert "p" in chosen.definitions


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "answer.json"
    options.write_text(target, "before")
    monkeypatch.setattr(os, "replace", _interrupted)
    with pytest.raises(KeyboardInterrupt):
        options.write_text(target, "after")
    assert target.read_text("utf-8") == "before"
    assert list(tmp_path.iterdir()) == [target]


def _interrupted(*_: object) -> None:
    raise KeyboardInterrupt


def test_json_is_readable_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options.write_json({"schema": "x/1", "name": "größer"}, str(tmp_path / "a.json"))
    options.write_json({"schema": "x/1", "name": "größer"}, "-")
    expected = '{\n  "schema": "x/1",\n  "name": "größer"\n}\n'
    assert (tmp_path / "a.json").read_text("utf-8") == expected
    assert capsys.readouterr().out == expected
    with pytest.raises(InputError, match="cannot write"):
        options.write_json({}, str(tmp_path / "missing" / "a.json"))


@pytest.mark.parametrize("target", ["", ".", "/"])
@pytest.mark.parametrize("command", [["list"], ["overlap", "--among", "1-2"]])
def test_json_to_what_names_no_file(
    command: list[str], target: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*command, "--json", target]) == 2
    assert f"argument --json: '{target}' is not a file name" in capsys.readouterr().err


def test_a_target_that_cannot_be_written_ends_a_run_before_its_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("roadproof.frontends.cli.prove.run", lambda args: pytest.fail("the work began"))
    for target, said in ((tmp_path / "none" / "x.json", "No such file"), (tmp_path, "Is a directory")):
        assert main(["prove", "true", "--json", str(target)]) == 3
        assert said in capsys.readouterr().err
    monkeypatch.setattr("roadproof.frontends.cli.prove.run", lambda args: 0)
    out = tmp_path / "out"
    for target in ("-", str(tmp_path / "x.json"), str(out / "x.json")):
        assert main(["prove", "true", "--out", str(out), "--json", target]) == 0


@pytest.mark.parametrize(
    ("words", "scenarios"), [(["4"], {4}), (["scenario_4", "P1"], {4}), (["1-2,7", "P1"], {1, 2, 7})]
)
def test_prove_takes_scenarios_as_other_commands_do(words: list[str], scenarios: set[int]) -> None:
    tasks = asked_of_prove([*words, "--set", "base"]).tasks
    assert {task.scenario for task in tasks} == scenarios
    assert {task.id for task in tasks} == {"P1"} or "P1" not in words
    with pytest.raises(UsageError, match="no claim of P9, 4"):
        asked_of_prove(["P9", "4"])


def asked_of_prove(words: list[str]) -> Claims:
    parser = argparse.ArgumentParser()
    prove.add_arguments(parser)
    args = parser.parse_args(words)
    return prove._asked(args, Prove.of(read_keywords(args, Prove)))
