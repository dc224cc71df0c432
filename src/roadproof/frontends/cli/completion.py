"""``roadproof completion``: commands, options and their values on Tab, in bash, zsh and fish."""

import argparse
import os
import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import TypeAlias

from roadproof.extension import entries, import_entry
from roadproof.frontends.cli.help import CommandParser, fill
from roadproof.frontends.cli.overview import COMMANDS
from roadproof.verdict import ExitCode

SUMMARY = "print the script with which a shell completes roadproof on Tab"

EXAMPLES = """\
examples:
  eval "$(roadproof completion bash)"      in ~/.bashrc
  eval "$(roadproof completion zsh)"       in ~/.zshrc, after compinit
  roadproof completion fish > ~/.config/fish/completions/roadproof.fish
"""

Values: TypeAlias = Mapping[str, str]
"""Words that complete a value, each with its description, which zsh and fish show."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("shell", metavar="SHELL", choices=("bash", "zsh", "fish"), help="bash, zsh or fish")


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from argcomplete.shell_integration import shellcode

    print(shellcode(["roadproof"], shell=args.shell), end="")
    return ExitCode.AS_EXPECTED


def complete() -> None:
    """Answer the request of a completion script, and end the process."""
    import argcomplete

    words = os.environ["COMP_LINE"].split()[1:]
    chosen = next((word for word in words if not word.startswith("-")), "")
    parser = CommandParser(prog="roadproof")
    commands = parser.add_subparsers()
    for name, entry in COMMANDS.items():
        command = commands.add_parser(name, help=entry.summary, add_help=False)
        if name == chosen:
            fill(command, name)
            for action in command._actions:
                _attach(action)
    argcomplete.autocomplete(parser, always_complete_options=False)


def _attach(action: argparse.Action) -> None:
    """Attach to an option or argument how a shell completes its value: by a list, by files, or not at all."""
    from argcomplete.completers import FilesCompleter, SuppressCompleter

    metavar = action.metavar if isinstance(action.metavar, str) else ""
    values = {**_VALUES, **_of_extensions()}
    known = next((values[x] for x in (*action.option_strings, metavar) if x in values), None)
    completer: object = FilesCompleter() if _FILES.search(metavar) or metavar == "R" else SuppressCompleter()
    if known is not None:
        completer = _completer(known, files=metavar in _OR_FILES)
    if action.choices is None:
        vars(action)["completer"] = completer


def _completer(values: Callable[[str], Values], files: bool) -> Callable[..., Values]:
    def complete_value(prefix: str, **_: object) -> Values:
        """Return the completions of a value, with descriptions."""
        from argcomplete.completers import FilesCompleter

        matches = {word: about for word, about in values(prefix).items() if word.startswith(prefix)}
        return matches | dict.fromkeys(FilesCompleter()(prefix), "") if files else matches

    return complete_value


def _scenarios(prefix: str) -> Values:
    """Numbers, also behind a comma; names of ISO 34502 where a letter was typed."""
    from roadproof.library.loading import bundled_library
    from roadproof.library.words import words_by_number

    known = words_by_number(bundled_library().select())
    head = prefix[: prefix.rfind(",") + 1] if re.match(r"[\d,-]", prefix) else ""
    if head or not prefix or prefix[0].isdigit():
        return {f"{head}{number}": words.name for number, words in known.items()}
    names = {part: "" for words in known.values() for part in (words.title.partition(",")[0], words.sector)}
    return names | {_BRACKETS.sub("", x.name): f"scenario {number}" for number, x in known.items()}


def _claims(prefix: str) -> Values:
    from roadproof.engines.prove.properties import template_properties

    labels = {task.id: "template property" for task in template_properties()}
    return {**_scenarios(prefix), **labels}


def _sets(prefix: str) -> Values:
    from roadproof.library.loading import bundled_library

    return _listed(prefix, {name: block.doc for name, block in bundled_library().sets.items()})


def _readings(prefix: str) -> Values:
    from roadproof.library.loading import bundled_library

    options = bundled_library().options.values()
    return {f"{option.name}={value}": option.doc for option in options for value in option.values}


def _parameters(prefix: str) -> Values:
    from roadproof.library.loading import bundled_library

    return {f"{name}=": declared.doc for name, declared in bundled_library().parameters.items()}


def _of_extensions() -> Mapping[str, Callable[[str], Values]]:
    """Return the completions of extensions by flag."""

    def completed(entry: str, prefix: str) -> Values:
        return _listed(prefix, import_entry(entry)())

    return {flag: partial(completed, entry) for flag, entry in entries("completions").items()}


def _listed(prefix: str, values: Values, mark: str = ",") -> Values:
    """Values behind those that stand before a comma, or before another mark."""
    head = prefix[: prefix.rfind(mark) + 1]
    return {f"{head}{word}": about for word, about in values.items()}


def _models(kind: str) -> Callable[[str], Values]:
    def values(prefix: str) -> Values:
        from roadproof.world.models import names_of

        return _listed(prefix, dict.fromkeys(names_of(kind), ""), "=")

    return values


def _files_on_request(prefix: str) -> Values:
    from roadproof.library.specification import on_request

    return dict.fromkeys(on_request(), "shipped with roadproof")


_BRACKETS = re.compile(r" \([^()]*\)")
_FILES = re.compile(r"FILE|DIR|PATH|TRACE|DRIVE|RESULT")
_OR_FILES = ("FILE", "R", "[NAME=]MODEL", "PATH|N,N")

_VALUES: Mapping[str, Callable[[str], Values]] = {
    **dict.fromkeys(
        ("N|FORMULA", "FORMULA", "F1", "F2", "WHAT", "MANOEUVRE", "--among", "--plant"), _scenarios
    ),
    "CLAIM": _claims,
    **dict.fromkeys(("--set", "--plant-set", "--wider"), _sets),
    "--option": _readings,
    **dict.fromkeys(("--param", "--vary"), _parameters),
    "--road": _models("roads"),
    "--vehicle": _models("vehicles"),
    "--spec": _files_on_request,
}
"""How values are completed, by flag or by the name of the value in help."""
