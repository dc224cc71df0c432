"""The help of the program: the commands of the core, then those of each extension. It imports no command."""

import os
from collections.abc import Mapping

from roadproof.extension import AUDIENCES, Installed, installed
from roadproof.runtime.records import dataclass

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


@dataclass(frozen=True)
class Command:
    """A sub-command: the module that answers it, what it does, and the extension that adds it, if one."""

    module: str
    summary: str
    extension: Installed | None = None


def _find_commands() -> Mapping[str, Command]:
    """The sub-commands by name: the modules with a summary, first those of the core."""
    core = _commands_in(os.path.dirname(__file__), __name__.rpartition(".")[0], None)
    found = {name: core[name] for name in (*_ORDER, *sorted({*core} - {*_ORDER})) if name in core}
    for x in installed().values():
        found |= _commands_in(os.path.join(x.folder, "commands"), f"{x.package}.commands", x)
    return found


def _commands_in(folder: str, package: str, extension: Installed | None) -> dict[str, Command]:
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


def overview() -> str:
    """The help of the program."""
    core = [f"  {name:<12} {x.summary}" for name, x in COMMANDS.items() if x.extension is None]
    blocks = ["usage: roadproof COMMAND [OPTION ...] [ARGUMENT ...]", _HEAD, "\n".join(["core:", *core])]
    width = max((len(", ".join(x)) for x in _of_extensions().values()), default=0)
    for audience in AUDIENCES:
        lines = [
            f"  {', '.join(names):<{width}}  {installed()[name].record.title}"
            for name, names in _of_extensions().items()
            if installed()[name].record.audience == audience
        ]
        blocks += ["\n".join([f"for {audience}:", *lines])] if lines else []
    return "\n\n".join([*blocks, _FOOT])


def _of_extensions() -> Mapping[str, list[str]]:
    """The commands of each extension that has any."""
    found: dict[str, list[str]] = {}
    for name, x in COMMANDS.items():
        if x.extension is not None:
            found.setdefault(x.extension.name, []).append(name)
    return found
