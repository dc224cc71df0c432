"""Options that sub-commands share."""

import argparse
import ast
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

import roadproof
import roadproof as rp
from documents import keywords_file
from roadproof.errors import InputError, UsageError
from roadproof.evidence.claim import Engine, Objective
from roadproof.extensions.traffic.answers.monitor import View
from roadproof.extensions.traffic.settings import Evaluate, MonitorSettings, Simulate
from roadproof.extensions.traffic.simulate.traffic import Ramp
from roadproof.frontends.api.checking import Kernel, Solver
from roadproof.frontends.cli import options, prove
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.completion import _VALUES
from roadproof.frontends.cli.help import command_parser
from roadproof.frontends.cli.main import main
from roadproof.frontends.cli.overview import COMMANDS, groups
from roadproof.frontends.cli.overview import COMMANDS as SUB_COMMANDS
from roadproof.frontends.settings.flags import add_flags, is_rare, read_keywords
from roadproof.frontends.settings.groups import DefinitionsSettings
from roadproof.frontends.settings.option import Settings, function_of
from roadproof.frontends.settings.questions import Check, Prove, Witness
from roadproof.questions.prove import ProveQuestion
from roadproof.semantics.sampled.answers import Convention


def parsed(*arguments: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    add_flags(parser, DefinitionsSettings)
    return parser.parse_args(arguments)


def values_given(*arguments: str) -> Mapping[str, Fraction]:
    return read_definitions(parsed(*arguments), DefinitionsSettings).values


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
    chosen = read_definitions(parsed(*words), DefinitionsSettings).specification
    assert chosen.set_name == "mine"
    assert chosen.options["lateral_sign"] == "literal"
    assert "p" in chosen.definitions


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "answer.json"
    options.write_json({"when": "before"}, str(target))
    monkeypatch.setattr(os, "replace", _interrupted)
    with pytest.raises(KeyboardInterrupt):
        options.write_json({"when": "after"}, str(target))
    assert json.loads(target.read_text("utf-8")) == {"when": "before"}
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
    assert {x.task.scenario for x in tasks} == scenarios
    assert {x.task.id for x in tasks} == {"P1"} or "P1" not in words
    with pytest.raises(UsageError, match="no claim of P9, 4"):
        asked_of_prove(["P9", "4"])


def asked_of_prove(words: list[str]) -> ProveQuestion:
    args = command_parser("prove").parse_args(words)
    return prove._question(args, Prove.of(read_keywords(args, Prove)))


# --- Options are defined once: flags, keyword arguments and signatures follow the definitions -------


@pytest.mark.parametrize("question", keywords_file.all_questions(), ids=lambda x: x.__name__)
def test_a_function_shows_its_options(question: type) -> None:
    parameters = inspect.signature(getattr(rp, function_of(question))).parameters
    shown = {name: x for name, x in parameters.items() if x.kind is x.KEYWORD_ONLY}
    for name, option in question.options().items():
        assert (name in shown) == option.keyword
        if option.keyword:
            assert shown[name].default == getattr(question, name)


@pytest.mark.parametrize("command", ["witness 4", "prove P4", "overlap", "simulate", "evaluate x"])
def test_an_empty_folder_is_not_the_current_one(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Such as ``--out "$DIR"`` where DIR is not set."""
    assert main([*command.split(), "--out", ""]) == 2
    assert "--out '': write the path of a folder" in capsys.readouterr().err
    with pytest.raises(UsageError, match="out='': write the path of a folder"):
        rp.witness(4, out="")


def test_a_formula_that_cannot_be_asked_is_named_before_others_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["witness", "4", "F true", "--jobs", "1", "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.startswith("roadproof: F true: the formula mentions no vehicle")
    assert not (tmp_path / "out").exists()


def test_an_unknown_keyword_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'horizn'; did you mean 'horizon'"):
        rp.witness(4, horizn=6)
    with pytest.raises(TypeError, match="unexpected keyword argument 'tls_ca'"):
        rp.witness(4, tls_ca="x")


@pytest.mark.parametrize(
    ("question", "name", "kind"),
    [
        (Witness, "engine", Engine),
        (Witness, "objective", Objective),
        (MonitorSettings, "view", View),
        (MonitorSettings, "end", Convention),
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


# --- Help: commands by job, usual options first, all options on request -----------------------------


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    with pytest.raises(SystemExit) as ended:
        main([*words])
    assert ended.value.code == 0
    return capsys.readouterr().out


def flags_in(text: str) -> set[str]:
    """The flags that have a line of their own."""
    return set(re.findall(r"^  (?:-\w(?: [A-Z]+)?, )?(--[a-z-]+)", text, re.MULTILINE))


MOST_USUAL = 12
"""The options that --help shows of a command, besides those for help."""


def flags_of(name: str, rare: bool) -> set[str]:
    actions: list[argparse.Action] = command_parser(name)._actions
    return {x.option_strings[-1] for x in actions if x.option_strings and is_rare(x) <= rare}


@pytest.mark.parametrize("name", COMMANDS)
def test_usual_options_are_shown_and_all_on_request(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    usual, every = printed(capsys, name, "--help"), printed(capsys, name, "--help-all")
    assert flags_in(usual) == flags_of(name, rare=False)
    assert flags_in(every) == flags_of(name, rare=True)
    assert len(flags_of(name, rare=False) - {"--help", "--help-all"}) <= MOST_USUAL
    hidden = len(flags_of(name, True)) - len(flags_of(name, False))
    last = usual.splitlines()[-1]
    assert (last == f"{hidden} more option{'s' * (hidden > 1)}: roadproof {name} --help-all") == (hidden > 0)


def test_the_usual_options_of_witness_fit_a_screen(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert len(printed(capsys, "witness", "--help").splitlines()) <= 48


def test_every_command_stands_once_below_those_whom_it_is_for(capsys: pytest.CaptureFixture[str]) -> None:
    shown = printed(capsys, "--help")
    for title, names in groups().items():
        assert re.search(rf"^{title}:\n(  \S.*\n)+", shown, re.MULTILINE)
        assert all(re.search(rf"^  (\w+, )*{name}\b", shown, re.MULTILINE) for name in names)
    for name, command in COMMANDS.items():
        if command.extension is None:
            line = rf"^  {name} +{re.escape(command.summary)}$"
        else:
            line = rf"^  (\w+, )*{name}(, \w+)* +{re.escape(command.extension.record.title)}$"
        assert len(re.findall(line, shown, re.MULTILINE)) == 1
        assert len(command.summary) <= 80
    assert shown == printed(capsys, "-h") == printed(capsys, "--help", "witness")


# --- No error message names an option which the command that raises it does not have ----------------

SOURCE = Path(roadproof.__file__).parent
# What is raised for an option is raised only by commands that have it: these read it, or what it made.
READERS = {
    "roadproof.frontends.cli.options": {"--all", "--cluster", "--jobs", "--json", "--shard"},
    "roadproof.runtime.executors": {"--jobs"},
    "roadproof.questions.decide": {"--out", "--shard"},
    "roadproof.questions.folder": {"--out"},
    "roadproof.evidence.specifications": {"--spec"},
    "roadproof.runtime.pool": {"--jobs"},
    "roadproof.runtime.process_pool": {"--jobs"},
    "roadproof.extensions.surveys.explore.explorable": {
        *("--vary", "--steps", "--precision", "--greatest", "--least", "--when"),
    },
    "roadproof.extensions.surveys.classify.classes": {"--among"},
    "roadproof.extensions.surveys.covering": {"--wider"},
    # Divides for catalogue and falsify.
    "roadproof.extensions.surveys.classify.division": {"--no-classes"},
    "roadproof.frontends.api.relations": {"--among"},
    # Names a run of preventable.
    "roadproof.extensions.assurance.case.template": {"--model"},
}
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")


def file_of(module: str) -> Path | None:
    path = SOURCE.joinpath(*module.split(".")[1:])
    return next((p for p in (path.with_suffix(".py"), path / "__init__.py") if p.is_file()), None)


@cache
def tree_of(module: str) -> ast.Module:
    path = file_of(module)
    assert path is not None
    return ast.parse(path.read_text("utf-8"))


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """All below a node, but for what is imported for types only."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            continue
        yield child
        yield from statements(child)


@cache
def imported_by(module: str) -> frozenset[str]:
    found: set[str] = set()
    for node in statements(tree_of(module)):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("roadproof."):
            found.add(node.module)
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(name for name in found if file_of(name) is not None)


def reached_from(module: str) -> set[str]:
    reached, waiting = {module}, [module]
    while waiting:
        new = imported_by(waiting.pop()) - reached
        reached |= new
        waiting += new
    return reached


@cache
def hints_in(module: str) -> frozenset[str]:
    """The options that the error messages of a module name."""
    found: set[str] = set()
    for node in statements(tree_of(module)):
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("Error"):
            texts = [x.value for x in ast.walk(node) if isinstance(x, ast.Constant)]
            found |= {option for text in texts for option in OPTION.findall(str(text))}
    return frozenset(found)


def options_of(command: str) -> set[str]:
    parser = command_parser(command)
    return {text for option in parser._actions for text in option.option_strings}


@pytest.mark.parametrize("command", SUB_COMMANDS)
def test_errors_name_options_that_the_command_has(command: str) -> None:
    known = options_of(command)
    wrong = {
        (module, option)
        for module in reached_from(SUB_COMMANDS[command].module)
        for option in hints_in(module) - READERS.get(module, set())
        if option not in known
    }
    assert not wrong


def test_messages_are_found() -> None:
    assert "--jobs" in hints_in("roadproof.runtime.process_pool")
    assert "roadproof.engines.encode.unroll" in reached_from("roadproof.frontends.cli.witness")
    assert len({option for command in SUB_COMMANDS for option in options_of(command)}) > 40


# --- Completion on Tab, asked of each shell that is installed with the script that roadproof prints

BASH = """
eval "$(roadproof completion bash)"
COMP_LINE=$1; COMP_POINT=${#COMP_LINE}; COMP_TYPE=9
_python_argcomplete roadproof
printf '%s\\n' "${COMPREPLY[@]}"
"""
ZSH = """
autoload -Uz compinit; compinit -u -D
eval "$(roadproof completion zsh)"
_describe() { print -l -- "${(@P)2}" }
BUFFER=$1; CURSOR=${#1}; words=(${(z)1})
_python_argcomplete
"""
FISH = """
roadproof completion fish | source
complete -C $argv[1]
"""
SHELLS = {"bash": ("bash", "--norc"), "zsh": ("zsh", "-f"), "fish": ("fish", "--no-config")}
SCRIPTS = {"bash": BASH, "zsh": ZSH, "fish": FISH}
BETWEEN = {"bash": "\t", "zsh": ":", "fish": "\t"}
"""What separates a word from its description."""


def completed(shell: str, line: str, folder: Path) -> list[str]:
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    script = folder / f"script.{shell}"
    script.write_text(SCRIPTS[shell], "utf-8")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        [*SHELLS[shell], str(script), line],
        cwd=folder,
        env={**os.environ, "PATH": path, "TERM": "dumb"},
        capture_output=True,
        text=True,
        timeout=60,
    )
    return [x.split(BETWEEN[shell])[0].rstrip() for x in done.stdout.splitlines() if x.strip()]


@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("roadproof wit", ["witness"]),
        ("roadproof witness 4 --unprev", ["--unpreventable"]),
        ("roadproof witness 4 --set b", ["base"]),
        ("roadproof witness 2", ["2", "20", "21", "22", "23", "24"]),
        ("roadproof overlap --among 1,2", ["1,2", "1,20", "1,21", "1,22", "1,23", "1,24"]),
        ("roadproof prove --spec dri", ["driver", "drives/"]),
        ("roadproof witness 4 --param minD", ["minDanger="]),
        ("roadproof export drives --to highd,a", ["highd,animation"]),
    ],
)
def test_a_shell_completes(shell: str, line: str, words: list[str], tmp_path: Path) -> None:
    (tmp_path / "drives").mkdir()
    assert sorted(completed(shell, line, tmp_path)) == words


@pytest.mark.parametrize("shell", SHELLS)
def test_a_shell_completes_names_of_scenarios(shell: str, tmp_path: Path) -> None:
    found = [x.replace("\\", "") for x in completed(shell, "roadproof show cut-i", tmp_path)]
    sectors = ("main road", "merge zone", "departure zone")
    names = {f"cut-in, lane {x}, {sector}" for x in ("keep", "change") for sector in sectors}
    assert {*found} == {"cut-in", *names}


def test_completed_names_are_accepted(tmp_path: Path) -> None:
    from roadproof.frontends.cli.completion import _scenarios
    from roadproof.library.loading import bundled_library
    from roadproof.library.scenario_references import numbers_by_name

    names = _scenarios("c")
    assert len(names) > 24
    assert all(numbers_by_name(bundled_library().select(), name) for name in names)


def test_every_list_of_values_belongs_to_an_option_or_argument() -> None:
    actions = [x for name in COMMANDS for x in command_parser(name)._actions]
    assert {*_VALUES} <= {word for x in actions for word in (*x.option_strings, x.metavar)}


@pytest.mark.parametrize(
    "arguments",
    [
        ["prove", "true", "--junit", "{}"],
        ["check", "nothing", "--sarif", "{}"],
        ["report", "nothing", "--out", "{}"],
        ["bundle", "nothing", "-o", "{}"],
        ["assurance", "nothing", "--svg", "{}"],
        ["trace", "nothing", "--reqif", "{}"],
        ["road", "nothing", "--out", "{}"],
        ["monitor", "true", "nothing", "--picture", "{}"],
    ],
)
def test_every_file_is_tried_before_the_work(arguments, tmp_path, capsys):
    file = tmp_path / "none" / "x.html"
    assert main([x.format(file) for x in arguments]) == 3
    assert capsys.readouterr().err.startswith(f"roadproof: cannot write {file}: No such file or directory")
