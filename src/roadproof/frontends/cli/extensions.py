"""``roadproof extensions``: what is installed beyond the core, for whom, and what may be removed."""

import argparse

from roadproof.evidence.answers.extensions import Answer, ExtensionData
from roadproof.evidence.codec import write
from roadproof.extension import AUDIENCES, Installed, installed
from roadproof.frontends.cli.options import write_json
from roadproof.frontends.cli.overview import COMMANDS
from roadproof.frontends.settings.commands import Extensions
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode

SUMMARY = "list the extensions that are installed, for whom they are and what they add"

EXAMPLES = """\
examples:
  roadproof extensions                 names, labels, commands
  roadproof extensions --json -        all that each of them adds

An extension that is stable keeps its commands and files; one that is incubating may be removed, and so may
parts of a stable one that are called incubating. Packages of others add extensions by an entry point of the
group roadproof.extensions.
"""
OPTIONS = Extensions


def run(args: argparse.Namespace) -> int:
    found = installed()
    if args.json:
        write_json(write(Answer(roadproof=VERSION, extensions=tuple(map(_data, found.values())))), args.json)
    if args.json != "-":
        print("\n".join(_lines(list(found.values()))))
    return ExitCode.AS_EXPECTED


def _commands(x: Installed) -> list[str]:
    return [name for name, command in COMMANDS.items() if command.extension == x]


def _lines(found: list[Installed]) -> list[str]:
    width = max((len(x.name) for x in found), default=0)
    lines: list[str] = []
    for audience in AUDIENCES:
        mine = [x for x in found if x.record.audience == audience]
        lines += [f"for {audience}:"] * bool(mine)
        for x in mine:
            commands = ", ".join(_commands(x)) or "no command; options of others"
            lines.append(f"  {x.name:<{width}}  {x.record.label:<10}  {x.record.title}")
            lines.append(f"  {'':<{width}}  {commands}")
            lines += [f"  {'':<{width}}  incubating: {part}" for part in x.record.incubating]
    return lines or ["no extension is installed"]


def _data(x: Installed) -> ExtensionData:
    record = x.record
    return ExtensionData(
        name=x.name,
        package=x.package,
        title=record.title,
        audience=record.audience,
        label=record.label,
        incubating=record.incubating,
        needs=record.needs,
        commands=tuple(_commands(x)),
        functions=tuple(sorted(record.functions)),
        questions=tuple(sorted(record.questions)),
    )
