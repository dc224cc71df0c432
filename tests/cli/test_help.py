"""Help: commands by job, usual options first, all options on request."""

import argparse
import re

import pytest

from roadproof.frontends.cli.help import COMMANDS, command_parser, jobs
from roadproof.frontends.cli.main import main
from roadproof.frontends.settings.flags import is_rare


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    with pytest.raises(SystemExit) as ended:
        main([*words])
    assert ended.value.code == 0
    return capsys.readouterr().out


def flags_in(text: str) -> set[str]:
    """The flags that have a line of their own."""
    return set(re.findall(r"^  (?:-\w(?: [A-Z]+)?, )?(--[a-z-]+)", text, re.MULTILINE))


def flags_of(name: str, rare: bool) -> set[str]:
    actions: list[argparse.Action] = command_parser(name)._actions
    return {x.option_strings[-1] for x in actions if x.option_strings and is_rare(x) <= rare}


@pytest.mark.parametrize("name", COMMANDS)
def test_usual_options_are_shown_and_all_on_request(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    usual, every = printed(capsys, name, "--help"), printed(capsys, name, "--help-all")
    assert flags_in(usual) == flags_of(name, rare=False)
    assert flags_in(every) == flags_of(name, rare=True)
    hidden = len(flags_of(name, True)) - len(flags_of(name, False))
    last = usual.splitlines()[-1]
    assert (last == f"{hidden} more option{'s' * (hidden > 1)}: roadproof {name} --help-all") == (hidden > 0)


def test_the_usual_options_of_witness_fit_a_screen(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert len(printed(capsys, "witness", "--help").splitlines()) <= 48


def test_every_command_stands_below_a_job_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    shown = printed(capsys, "--help")
    for job, names in jobs().items():
        assert f"\n{job}:\n  {names[0]} " in shown
    for name, summary in COMMANDS.items():
        assert len(re.findall(rf"^  {name} +{re.escape(summary)}$", shown, re.MULTILINE)) == 1
        assert len(summary) <= 65
    assert shown == printed(capsys, "-h") == printed(capsys, "--help", "witness")
