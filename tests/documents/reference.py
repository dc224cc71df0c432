"""Reference pages that are generated from the program.

``make generated`` writes those of the checkout; the site has the others, too.
"""

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from inspect import getdoc, isclass, isfunction
from pathlib import Path
from typing import Any, get_args

import roadproof
from roadproof.frontends.api.answer import BaseAnswer
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.api.phrases import Phrase
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.cli.help import command_parser
from roadproof.frontends.cli.overview import COMMANDS, groups
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import number_in
from roadproof.library.specification import Specification
from roadproof.library.words import words_of
from roadproof.logic import syntax
from roadproof.logic.show import decimal, text
from roadproof.logic.syntax import Definition
from roadproof.verdict import ExitCode

ROOT = Path(__file__).parents[2]
WIDTH = 90


def _cell(words: str) -> str:
    """Text for a cell of a table: what Markdown would read as markup is escaped."""
    return re.sub(r"([|<>*_\[\]])", r"\\\1", " ".join(words.split()))


def _code(words: str) -> str:
    return f"`{words}`".replace("|", "\\|")


# --- commands ----------------------------------------------------------------------------------------


def commands() -> str:
    lines = [
        "# Commands and options",
        "",
        "Each section is generated from the parser of the command. `roadproof COMMAND --help-all` prints the "
        "same in a terminal, and `--help` the usual options. All commands share their "
        "[exit codes](exit-codes.md).",
        "",
        "| for | command | purpose |",
        "|---|---|---|",
    ]
    for job, names in groups().items():
        for name in names:
            lines.append(
                f"| {job if name == names[0] else ''} | [{name}](#{name}) | {_cell(COMMANDS[name].summary)} |"
            )
    for name, command in COMMANDS.items():
        summary = command.summary
        lines += ["", f"## {name}", "", f"{summary[0].upper()}{summary[1:]}.", "", *_options(name)]
    return "\n".join(lines) + "\n"


def _options(name: str) -> Iterator[str]:
    parser = command_parser(name)
    for group in parser._action_groups:
        actions = group._group_actions  # rare ones too, which --help may leave out
        if not actions:
            continue
        title = {"positional arguments": "Arguments", "options": "Options"}.get(
            group.title or "", group.title or ""
        )
        yield from (f"**{title}**", "", "| | |", "|---|---|")
        for action in actions:
            spelled = ", ".join(map(_code, spellings(action)))
            yield f"| {spelled} | {_cell(help_of(parser, action))} |"
        yield ""
    if parser.epilog:
        yield from ("```text", parser.epilog.strip(), "```")


def spellings(action: argparse.Action) -> list[str]:
    """An option by each of its names, with its value; an argument as help shows it."""
    value = action.metavar or (
        "{" + ",".join(map(str, action.choices)) + "}" if action.choices else action.dest.upper()
    )
    if isinstance(value, tuple):
        value = " ".join(value)
    if not action.option_strings:
        return [value]
    takes = "" if action.nargs == 0 else f" {value}"
    return [f"{option}{takes}" for option in action.option_strings]


def help_of(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    if not action.help or action.help == argparse.SUPPRESS:
        return ""
    return parser._get_formatter()._expand_help(action)


# --- library -----------------------------------------------------------------------------------------


def library() -> str:
    base = bundled_library().select()
    users = _users(base)
    lines = [
        "# Library",
        "",
        "Every scenario, definition, parameter and option of the library. `roadproof show NAME` prints an "
        "entry with all definitions that it uses; `roadproof list` prints the names. The page is generated "
        "from spec set `base`; [Spec sets](#spec-sets) lists the definitions that other sets replace.",
        "",
        "## Scenarios",
    ]
    definitions = base.definitions
    for name in (x for x in definitions if number_in(x) is not None):
        words = words_of(base, number_in(name) or 0)
        head = f"{name}: {words.title}, {words.sector}" if words else name
        about = words.sentence if words else base.describe(definitions[name])
        lines += _entry(head, about, definitions[name], users[name])
    lines += ["", "## Definitions"]
    for name in sorted((x for x in definitions if number_in(x) is None), key=str.casefold):
        lines += _entry(name, base.describe(definitions[name]), definitions[name], users[name])
    return "\n".join([*lines, *_settings(base)]) + "\n"


def _entry(head: str, about: str, definition: Definition, users: list[str]) -> list[str]:
    used = f"Used by {', '.join(map(_code, users))}." if users else "No other definition uses it."
    return [
        "",
        f"### {_cell(head)}",
        "",
        _cell(about if re.match(r"\w\b", about) else about[:1].upper() + about[1:]),
        "",
        "```text",
        text(replace(definition, doc=""), WIDTH),
        "```",
        "",
        used,
    ]


def _users(base: Specification) -> dict[str, list[str]]:
    """For each definition the definitions whose text names it."""
    found: dict[str, list[str]] = {name: [] for name in base.definitions}
    for name, definition in base.definitions.items():
        own = {x.name for x in definition.parameters}
        for part in syntax.walk(definition.body):
            if isinstance(part, syntax.Call | syntax.Name):
                used = part.name.partition("@")[0]
                if used in found and used not in own and name not in found[used]:
                    found[used].append(name)
    return found


def _settings(base: Specification) -> Iterator[str]:
    library = base.library
    yield from ("", "## Spec sets", "", "| set | extends | | replaces |", "|---|---|---|---|")
    for block in library.sets.values():
        parent = _code(block.parent) if block.parent else ""
        replaced = ", ".join(_code(x.name) for x in block.definitions)
        yield f"| `{block.name}` | {parent} | {_cell(block.doc)} | {replaced} |"
    yield from ("", "## Options", "", "| option | choices, the first is the default | |", "|---|---|---|")
    for option in library.options.values():
        yield f"| `{option.name}` | {', '.join(map(_code, option.values))} | {_cell(option.doc)} |"
    yield from ("", "## Parameters", "", "| parameter | default | bound | |", "|---|---|---|---|")
    for declared in library.parameters.values():
        sign = "-" if declared.value < 0 else ""
        value = f"{sign}{decimal(abs(declared.value))} {declared.unit}".strip()
        bound = _code(f"{declared.bound} 0") if declared.bound else ""
        yield f"| `{declared.name}` | {value} | {bound} | {_cell(declared.doc)} |"


# --- exit codes, Python, JSON --------------------------------------------------------------------------

EXIT_CODES = {
    ExitCode.AS_EXPECTED: "every answer is as expected",
    ExitCode.USAGE: "the command line is wrong",
    ExitCode.BAD_INPUT: "an input cannot be read, or the output cannot be written",
    ExitCode.MISSING_SOLVER: "a solver or an optional library is not installed",
    ExitCode.UNEXPECTED: "a claim is refuted, an answer is not as expected, or a set or catalogue has gaps",
    ExitCode.UNKNOWN: "an answer is UNKNOWN, or a limit of work or time cut it off",
    ExitCode.CROSSCHECK_FAILED: "two readers of one formula disagree: a fault of roadproof",
    ExitCode.OUR_FAULT: "roadproof failed: set `ROADPROOF_TRACEBACK=1`, and report the command line",
    ExitCode.INTERRUPTED: "interrupted by Ctrl-C",
    ExitCode.READER_GONE: "the program that read the output has ended",
    ExitCode.ENDED: "ended by SIGTERM",
}


def exit_codes() -> str:
    rows = (f"| {int(code)} | `{code.name}` | {EXIT_CODES[code]} |" for code in ExitCode)
    return "\n".join(
        [
            "# Exit codes",
            "",
            "A script can rely on the exit code alone: 0 means that every answer was decided and is as "
            "expected. Where a run gives several answers, the gravest decides the code.",
            "",
            "| code | name in Python | meaning |",
            "|---:|---|---|",
            *rows,
            "",
            "[Verdicts](../explanation/meaning.md#verdicts) explains the answers behind the codes.",
            "",
        ]
    )


def python_api() -> str:
    public = {x: getattr(roadproof, x) for x in sorted(roadproof.__all__, key=str.casefold) if x[0] != "_"}
    functions = [name for name, value in public.items() if isfunction(value)]
    classes = [name for name, value in public.items() if isclass(value)]
    others = [name for name in public if name not in (*functions, *classes)]
    lines = [
        "# Python API",
        "",
        "Every public name of `import roadproof as rp`, generated from docstrings. [Python](python.md) shows "
        "them in use.",
    ]
    lines += ["", "## Questions", "", "| function | | answer | members of the answer |", "|---|---|---|---|"]
    lines += [row for name in functions if (row := _question(name, public[name]))]
    for title, names in (("Functions", functions), ("Classes", classes)):
        lines += ["", f"## {title}", "", *(f"::: roadproof.{name}\n" for name in names)]
    named = ", ".join(map(_code, others))
    lines += ["", "## Values for formulas", "", f"Vehicles, lanes and operators: {named}."]
    return "\n".join(lines) + "\n"


def _question(name: str, function: Callable[..., object]) -> str:
    """A row: a function, the first sentence about it, its answer and members; empty for parts of formulas."""
    answer: object = function.__annotations__["return"]
    if isinstance(answer, str):  # of a module whose annotations are text
        answer = vars(sys.modules[function.__module__]).get(re.split(r"[\[ ]", answer)[0], answer)
    answer = next(iter(get_args(answer)), answer)
    if not isclass(answer) or answer is Phrase or answer is Definitions:
        return ""
    about = (getdoc(function) or "").partition("\n\n")[0].replace("``", "`")
    every = _members(QuestionAnswers) if issubclass(answer, BaseAnswer) else set()
    members = sorted(x for x in _members(answer) - every if x[0] != "_")
    shown = ", ".join(map(_code, members))
    return f"| [{name}](#roadproof.{name}) | {_cell(about)} | `{answer.__name__}` | {shown} |"


def _members(of: type) -> set[str]:
    return {*dir(of), *getattr(of, "__dataclass_fields__", ())}


def json_fields() -> str:
    lines = [
        "# JSON fields",
        "",
        "The fields of every JSON document, generated from the schemas. [JSON of answers and evidence]"
        "(../schema/README.md) says which command writes which document, and links to the schemas.",
    ]
    for path in sorted(ROOT.joinpath("docs/schema").glob("*.json")):
        schema = json.loads(path.read_text("utf-8"))
        lines += ["", f"## {path.stem}", "", _cell(schema.get("title", path.name)) + "."]
        parts = {"": schema, **schema.get("$defs", {})}
        for name, part in parts.items():
            if part.get("properties"):
                lines += ["", *([f"**{name}**", ""] if name else []), *_fields(part)]
    return "\n".join(lines) + "\n"


def _fields(part: dict[str, Any]) -> Iterator[str]:
    yield from ("| field | type | required | |", "|---|---|---|---|")
    for name, content in part["properties"].items():
        field = content if isinstance(content, dict) else {}
        required = "yes" if name in part.get("required", ()) else ""
        yield f"| `{name}` | {_type(field)} | {required} | {_cell(field.get('description', ''))} |"


def _type(field: dict[str, Any]) -> str:
    if "const" in field:
        return _code(json.dumps(field["const"]))
    if "enum" in field:
        return ", ".join(_code(json.dumps(x)) for x in field["enum"])
    if "$ref" in field:
        return str(field["$ref"].rpartition("/")[2])
    if field.get("type") == "array":
        return f"list of {_type(field['items']) if isinstance(field.get('items'), dict) else 'any'}"
    for many in ("anyOf", "oneOf"):
        if many in field:
            return " or ".join(map(_type, field[many]))
    kind = field.get("type", "any")
    return " or ".join(kind) if isinstance(kind, list) else str(kind)


PAGES: dict[str, Callable[[], str]] = {
    "reference/commands.md": commands,
    "reference/library.md": library,
    "reference/api.md": python_api,
    "reference/json.md": json_fields,
}
"""The pages that are generated when the site is built, and the functions that write them."""
CHECKED_IN: dict[str, Callable[[], str]] = {"reference/exit-codes.md": exit_codes}
"""The generated pages of the checkout."""
