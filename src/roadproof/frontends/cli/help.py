"""The parser of a command, and its help, without rare options."""

import argparse
from collections.abc import Iterable
from importlib import import_module
from typing import Any, NoReturn

from roadproof.errors import UsageError
from roadproof.frontends.cli.overview import COMMANDS
from roadproof.frontends.settings.flags import add_flags, is_rare, section


def command_parser(name: str) -> "CommandParser":
    """The parser of a sub-command."""
    parser = CommandParser(
        prog=f"roadproof {name}",
        description=COMMANDS[name].summary,
        formatter_class=_UsualHelp,
        add_help=False,
    )
    fill(parser, name)
    return parser


def written_files(parser: argparse.ArgumentParser) -> list[str]:
    """The arguments that name a file which a command writes."""
    return [x.dest for x in section(parser, "output")._group_actions if x.metavar == "FILE"]


def fill(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the examples, arguments and options of a sub-command, whose module is imported."""
    command = import_module(COMMANDS[name].module)
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
        """Return the help text, with a note on options that it leaves out."""
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
        """Add a usage line with required arguments alone."""
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
