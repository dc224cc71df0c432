"""Help texts: the program's, with commands by job, and a command's, without its rare options."""

import argparse
import ast
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any, NoReturn

from roadproof.errors import UsageError
from roadproof.frontends.settings.flags import add_flags, is_rare, section

PACKAGE = "roadproof.frontends.cli"
_JOBS: Mapping[str, Sequence[str]] = {
    "read the library": ("list", "show"),
    "ask about scenarios and formulas": ("prove", "witness", "compare", "explore", "check"),
    "analyse a set of scenarios": (
        *("overlap", "order", "redundancy", "coverage", "classify", "preventable", "catalogue"),
    ),
    "work with recordings and maps": ("monitor", "compile", "evaluate", "simulate", "convert", "road"),
    "show and share results": ("report", "trace", "assurance", "bundle", "atlas", "export", "studio"),
    "set up": ("completion", "cache"),
}
_OTHERS = "other commands"
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


def _find_commands(folder: Path) -> dict[str, str]:
    """The sub-commands with their summaries, by job: the modules in a folder that have a summary."""
    found = {x.stem: text for x in folder.glob("[a-z]*.py") if (text := _summary(x)) is not None}
    known = [name for name in chain(*_JOBS.values()) if name in found]
    return {name: found[name] for name in [*known, *sorted({*found} - {*known})]}


def _summary(file: Path) -> str | None:
    """The literal ``SUMMARY`` of a module, one line, None where it has none.

    It is read without importing the module: --help has to be quick.
    """
    for line in file.read_text("utf-8").splitlines():
        if line.startswith("SUMMARY = "):
            text: str = ast.literal_eval(line.partition("=")[2].strip())
            return text
    return None


COMMANDS = _find_commands(Path(__file__).parent)


def jobs() -> dict[str, list[str]]:
    """The sub-commands by job."""
    found = {job: [name for name in names if name in COMMANDS] for job, names in _JOBS.items()}
    others = [name for name in COMMANDS if name not in chain(*found.values())]
    return found | ({_OTHERS: others} if others else {})


def overview() -> str:
    """The help of the program."""
    blocks = ["usage: roadproof COMMAND [OPTION ...] [ARGUMENT ...]", _HEAD]
    for job, names in jobs().items():
        blocks.append("\n".join([f"{job}:", *(f"  {name:<12} {COMMANDS[name]}" for name in names)]))
    return "\n\n".join([*blocks, _FOOT])


def command_parser(name: str) -> "CommandParser":
    """The parser of a sub-command."""
    parser = CommandParser(
        prog=f"roadproof {name}", description=COMMANDS[name], formatter_class=_UsualHelp, add_help=False
    )
    fill(parser, name)
    return parser


def written_files(parser: argparse.ArgumentParser) -> list[str]:
    """The arguments that name a file which a command writes."""
    return [x.dest for x in section(parser, "output")._group_actions if x.metavar == "FILE"]


def fill(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the examples, arguments and options of a sub-command, whose module is imported."""
    command = import_module(f"{PACKAGE}.{name}")
    parser.epilog = command.EXAMPLES
    if hasattr(command, "add_arguments"):
        command.add_arguments(parser)
    if hasattr(command, "OPTIONS"):
        add_flags(parser, command.OPTIONS)
    output = section(parser, "output")
    output.add_argument("-h", "--help", action="help", help="print this text and exit")
    output.add_argument("--help-all", action=_HelpAll, nargs=0, help="print this text with all options")


class CommandParser(argparse.ArgumentParser):
    """A parser whose mistakes are errors like all others."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; see {self.prog} --help")

    def format_help(self) -> str:
        text, rare = super().format_help(), sum(map(is_rare, self._actions))
        if rare and self.formatter_class is _UsualHelp:
            return f"{text}\n{rare} more option{'s' * (rare > 1)}: {self.prog} --help-all\n"
        return text


class _AllHelp(argparse.RawDescriptionHelpFormatter):
    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=28)

    def add_usage(
        self, usage: str | None, actions: Iterable[argparse.Action], groups: Any, prefix: str | None = None
    ) -> None:
        needed = [x for x in actions if x.required or not x.option_strings]
        self._prog = f"{self._prog} [OPTION ...]"
        super().add_usage(usage, needed, (), prefix)


class _UsualHelp(_AllHelp):
    def add_arguments(self, actions: Iterable[argparse.Action]) -> None:
        super().add_arguments([x for x in actions if not is_rare(x)])


class _HelpAll(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        parser.formatter_class = _AllHelp
        parser.print_help()
        parser.exit()
