"""Options are defined once: flags, keyword arguments and signatures follow the definitions."""

import argparse
import inspect
from typing import get_args

import pytest

import roadproof as rp
from roadproof.engines.search.question import Engine, Objective
from roadproof.evidence.answers.monitor import View
from roadproof.frontends.api.checking import Kernel, Solver
from roadproof.frontends.cli.main import main
from roadproof.frontends.settings import keywords_file
from roadproof.frontends.settings.evidence import Check
from roadproof.frontends.settings.flags import add_flags, read_keywords
from roadproof.frontends.settings.option import Settings
from roadproof.frontends.settings.questions import Witness
from roadproof.frontends.settings.recordings import Evaluate, Monitor, Simulate
from roadproof.recordings.simulate.traffic import Ramp
from roadproof.semantics.sampled.answers import Convention


def test_the_file_of_keyword_arguments_follows_the_definitions() -> None:
    remake = "run: python -m roadproof.frontends.settings.keywords_file"
    assert keywords_file.FILE.read_text("utf-8") == keywords_file.text(), remake


@pytest.mark.parametrize("question", keywords_file.all_questions(), ids=lambda x: x.__name__)
def test_a_function_shows_its_options(question: type) -> None:
    parameters = inspect.signature(getattr(rp, question.__name__.lower())).parameters
    shown = {name: x for name, x in parameters.items() if x.kind is x.KEYWORD_ONLY}
    for name, option in question.options().items():
        assert (name in shown) == option.keyword
        if option.keyword:
            assert shown[name].default == getattr(question, name)


def test_an_unknown_keyword_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'horizn'"):
        rp.witness(4, horizn=6)
    with pytest.raises(TypeError, match="unexpected keyword argument 'tls_ca'"):
        rp.witness(4, tls_ca="x")


@pytest.mark.parametrize(
    ("question", "name", "kind"),
    [
        (Witness, "engine", Engine),
        (Witness, "objective", Objective),
        (Monitor, "view", View),
        (Monitor, "end", Convention),
        (Evaluate, "end", Convention),
        (Simulate, "ramp", Ramp),
        (Check, "solver", Solver),
        (Check, "kernel", Kernel),
    ],
)
def test_choices_are_those_of_the_types(question: type[Settings], name: str, kind: object) -> None:
    assert question.options()[name].choices == get_args(kind)


@pytest.mark.parametrize(
    ("command", "code", "told"),
    [
        ("simulate --out x --recordings 1000", 2, "--recordings 1000: write a whole number greater than 0"),
        ("simulate", 2, "required: --out"),
        ("export x.json --out x", 2, "required: --to"),
        ("monitor 4 x.json --frames 5-", 2, "--frames 5-: write the first and the last frame"),
        ("evaluate x --out x --min-danger 0,", 2, "--min-danger 0,: write values separated by commas"),
        ("evaluate x --out x --min-safe -1", 2, "--min-safe -1: write seconds, 0 or more"),
    ],
)
def test_values_that_are_none(command: str, code: int, told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command.split()) == code
    assert told in capsys.readouterr().err


def test_a_flag_that_is_repeated_replaces_the_default() -> None:
    parser = argparse.ArgumentParser()
    add_flags(parser, Evaluate)
    assert read_keywords(parser.parse_args([]), Evaluate)["classes"] == ("Car",)
    given = parser.parse_args(["--class", "Truck", "--class", "Car"])
    assert read_keywords(given, Evaluate)["classes"] == ("Truck", "Car")
