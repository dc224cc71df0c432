"""``roadproof extensions``: what is installed beyond the core, for whom, and what may be removed."""

import argparse

from roadproof.evidence.answers.extensions import ExtensionData, ExtensionsData
from roadproof.evidence.codec import write
from roadproof.extension import AUDIENCES, InstalledExtension, installed_extensions
from roadproof.frontends.cli.options import write_json
from roadproof.frontends.cli.overview import COMMANDS
from roadproof.frontends.settings.commands import Extensions
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode

SUMMARY = "list the extensions that are installed, for whom they are and what they add"

EXAMPLES = """\
examples:
  roadproof extensions                 names, labels, commands, pages of the documentation
  roadproof extensions --json -        all that each of them adds

An extension that is stable keeps its commands and files; one that is incubating may be removed, and so may
parts of a stable one that are called incubating. Packages of others add extensions by an entry point of the
group roadproof.extensions.
"""
OPTIONS = Extensions


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    extensions = installed_extensions()
    if args.json:
        write_json(
            write(ExtensionsData(roadproof=VERSION, extensions=tuple(map(_data, extensions.values())))),
            args.json,
        )
    if args.json != "-":
        print("\n".join(_lines(list(extensions.values()))))
    return ExitCode.AS_EXPECTED


def _commands(x: InstalledExtension) -> list[str]:
    return [name for name, command in COMMANDS.items() if command.extension == x]


def _lines(extensions: list[InstalledExtension]) -> list[str]:
    width = max((len(x.name) for x in extensions), default=0)
    lines: list[str] = []
    for audience in AUDIENCES:
        mine = [x for x in extensions if x.record.audience == audience]
        lines += [f"for {audience}:"] * bool(mine)
        for x in mine:
            commands = ", ".join(_commands(x)) or "no command; options of others"
            lines.append(f"  {x.name:<{width}}  {x.record.label:<10}  {x.record.title}")
            lines.append(f"  {'':<{width}}  {commands}")
            lines += [f"  {'':<{width}}  incubating: {part}" for part in x.record.incubating]
            lines += [f"  {'':<{width}}  {x.record.page}"] * bool(x.record.page)
    return lines or ["no extension is installed"]


def _data(x: InstalledExtension) -> ExtensionData:
    record = x.record
    return ExtensionData(
        name=x.name,
        package=x.package,
        title=record.title,
        audience=record.audience,
        label=record.label,
        incubating=record.incubating,
        page=record.page,
        needs=record.needs,
        commands=tuple(_commands(x)),
        functions=tuple(sorted(record.functions)),
        questions=tuple(sorted(record.questions)),
    )
