"""The help of the program: the commands of the core, then those of each extension. It imports no command."""

from __future__ import annotations

import os
from collections.abc import Mapping

from roadproof.extension import AUDIENCES, Audience, InstalledExtension, extension_error, installed_extensions

_ORDER = ("list", "show", "prove", "witness", "compare", "overlap", "order", "check")
_HEAD = "Compiles driving scenarios to proofs, witnesses and monitors."
_FOOT = """\
options:
  -h, --help   print this text and exit; COMMAND --help explains a command
  --version    print the version and exit

examples:
  roadproof show 4            scenario 4, deceleration ahead, and the definitions that it uses
  roadproof witness 4         a drive on which it holds, judged exactly
  roadproof prove P4          a property of the scenarios, proved for all time

exit codes: 0 as expected, 10 refuted or unexpected, 20 unknown, 30 cross-check failed,
            2 usage, 3 bad input, 4 missing solver, 70 our fault, 130 interrupted, 143 ended
"""


class Command:
    """A sub-command: the module that answers it, what it does, and the extension that adds it, if one."""

    def __init__(self, module: str, summary: str, extension: InstalledExtension | None = None) -> None:
        self.module, self.summary, self.extension = module, summary, extension


def _find_commands() -> Mapping[str, Command]:
    """The sub-commands by name: the modules with a summary, first those of the core."""
    core = _commands_in(os.path.dirname(__file__), __name__.rpartition(".")[0], None)
    commands = {name: core[name] for name in (*_ORDER, *sorted({*core} - {*_ORDER})) if name in core}
    for x in installed_extensions().values():
        mine = _commands_in(os.path.join(x.folder, "commands"), f"{x.package}.commands", x)
        for name in mine:
            if name in commands:
                raise extension_error(x.name, f"the command {name} is there already; uninstall {x.package}")
        commands |= mine
    return commands


def _commands_in(folder: str, package: str, extension: InstalledExtension | None) -> dict[str, Command]:
    files = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    summaries = {x[:-3]: _summary(os.path.join(folder, x)) for x in files if x.endswith(".py")}
    return {name: Command(f"{package}.{name}", text, extension) for name, text in summaries.items() if text}


def _summary(file: str) -> str:
    """The text of ``SUMMARY`` in a module, a literal on one line without escapes; empty where it has none."""
    with open(file, encoding="utf-8") as module:
        for line in module:
            if line.startswith("SUMMARY = "):
                return line.partition('"')[2].rpartition('"')[0]
    return ""


COMMANDS = _find_commands()
DOORS: Mapping[Audience, str] = {
    "testers": "I test vehicles",
    "safety cases": "I sign a safety case",
    "researchers": "I work on logics",
}
"""The words by which a reader finds the commands of an audience, as in the README."""


def groups() -> Mapping[str, list[str]]:
    """The names of commands: of the core, then by those whom they are for."""
    by_title: dict[str, list[str]] = {"core": [name for name, x in COMMANDS.items() if x.extension is None]}
    for audience in AUDIENCES:
        mine = {name: x.extension for name, x in COMMANDS.items() if x.extension is not None}
        by_title[DOORS[audience]] = [name for name, x in mine.items() if x.record.audience == audience]
    return {title: names for title, names in by_title.items() if names}


def overview() -> str:
    """The help of the program."""
    core, *others = groups().items()
    lines = [f"  {name:<12} {COMMANDS[name].summary}" for name in core[1]]
    blocks = [
        "usage: roadproof COMMAND [OPTION ...] [ARGUMENT ...]",
        _HEAD,
        "\n".join([f"{core[0]}:", *lines]),
    ]
    added = {title: _by_extension(names) for title, names in others}
    width = max((len(names) for by_extension in added.values() for names in by_extension.values()), default=0)
    for title, by_extension in added.items():
        lines = [
            f"  {names:<{width}}  {installed_extensions()[name].record.title}"
            for name, names in by_extension.items()
        ]
        blocks.append("\n".join([f"{title}:", *lines]))
    return "\n\n".join([*blocks, _FOOT])


def _by_extension(names: list[str]) -> Mapping[str, str]:
    """Commands by the extension that adds them, in one text."""
    names_of: dict[str, str] = {}
    for name in names:
        x = COMMANDS[name].extension
        assert x is not None
        names_of[x.name] = f"{names_of[x.name]}, {name}" if x.name in names_of else name
    return names_of
