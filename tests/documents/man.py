"""Manual pages, made from the parsers as ``--help`` is: ``make man`` writes them into out/man/man1."""

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import roadproof
from documents.reference import EXIT_CODES, help_of, spellings
from roadproof.frontends.cli.help import command_parser
from roadproof.frontends.cli.overview import COMMANDS, groups

_HEADED = re.compile(r"(?P<title>[a-z][a-z ]*):\n(?P<body> .*)", re.DOTALL)


def pages() -> dict[str, str]:
    """The pages by file name: one of the program, and one of each command."""
    return {"roadproof.1": _program()} | {f"roadproof-{name}.1": _command(name) for name in COMMANDS}


def _program() -> str:
    lines = [
        *_head("roadproof", "compile driving scenarios to proofs, drives and monitors"),
        *(".SH SYNOPSIS", r".B roadproof", "COMMAND [OPTION ...] [ARGUMENT ...]"),
        ".SH COMMANDS",
    ]
    for job, names in groups().items():
        lines.append(f".SS {_plain(job)}")
        for name in names:
            lines += [".TP", rf".BR roadproof\-{name} (1)", _plain(COMMANDS[name].summary)]
    lines += [".SH EXIT STATUS"]
    for code, meaning in EXIT_CODES.items():
        lines += [".TP", f".B {int(code)}", _plain(meaning)]
    return "\n".join(lines) + "\n"


def _command(name: str) -> str:
    parser = command_parser(name)
    needed = " ".join(_value(x) for x in parser._actions if not x.option_strings)
    blocks = re.split(r"\n\s*\n", (parser.epilog or "").strip("\n"))
    headed = [found for block in blocks if (found := _HEADED.fullmatch(block))]
    lines = [
        *_head(f"roadproof-{name}", COMMANDS[name].summary),
        *(".SH SYNOPSIS", rf".B roadproof {name}", _plain(f"[OPTION ...] {needed}")),
        ".SH OPTIONS",
    ]
    for group in parser._action_groups:
        if group._group_actions:
            lines.append(f".SS {_plain(group.title or '')}")
        for action in group._group_actions:
            spelled = ", ".join(spellings(action))
            lines += [".TP", rf"\fB{_plain(spelled)}\fR", _plain(help_of(parser, action))]
    prose = [block for block in blocks if not _HEADED.fullmatch(block)]
    if prose:
        lines += [".SH NOTES", "\n.PP\n".join(_plain(" ".join(block.split())) for block in prose)]
    for found in headed:
        body = [line.removeprefix("  ") for line in found["body"].splitlines()]
        lines += [f".SH {found['title'].upper()}", ".nf", *map(_plain, body), ".fi"]
    return "\n".join([*lines, ".SH SEE ALSO", ".BR roadproof (1)"]) + "\n"


def _head(name: str, summary: str) -> Iterator[str]:
    version = f"roadproof {roadproof.__version__}"
    yield rf'.TH {_plain(name.upper())} 1 "" "{version}" "roadproof manual"'
    yield from (".SH NAME", rf"{_plain(name)} \- {_plain(summary)}")


def _value(action: argparse.Action) -> str:
    [name] = spellings(action)
    return {"*": "[{} ...]", "+": "{} ...", "?": "[{}]"}.get(str(action.nargs), "{}").format(name)


def _plain(text: str) -> str:
    """Text of which roff takes no sign for one of its own."""
    shown = text.replace("\\", "\\e").replace("-", "\\-")
    shown = "".join(sign if sign.isascii() else f"\\[u{ord(sign):04X}]" for sign in shown)
    return f"\\&{shown}" if shown.startswith((".", "'")) else shown


def write(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        (folder / name).write_text(text, "utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
