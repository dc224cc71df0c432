"""Options that several sub-commands share, and what they mean."""

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from roadproof.errors import UsageError
from roadproof.extension import entries
from roadproof.frontends.cli.streams import takes_everything
from roadproof.frontends.settings.flags import section
from roadproof.runtime.files import atomic_file, utf8, write_atomic
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.evidence.strict import JsonObject
    from roadproof.runtime.executors import Executor


class _Answer(Protocol):
    def as_data(self) -> "JsonObject": ...


def write_build_results(args: argparse.Namespace, answer: object) -> None:
    """Write files for build servers, such as that of ``--junit``, where a command has them.

    Raises ``InputError``.
    """
    files = _build_results(args)
    if files:
        from roadproof.frontends.api.build_result import BuildResult

        assert isinstance(answer, BuildResult)
        for format, file in files.items():
            write_atomic(file, utf8(answer.to(format)))


def write_ended(args: argparse.Namespace, command: str, code: ExitCode, message: str) -> None:
    """Write the same of a command that ends without an answer, so that no earlier file stands for it."""
    files = _build_results(args)
    if files:
        from roadproof.frontends.api.build_result import written
        from roadproof.frontends.report.cases import ended_case

        for format, file in files.items():
            write_atomic(file, utf8(written(format, command, (ended_case(command, code, message),), code)))


def _build_results(args: argparse.Namespace) -> dict[str, Path]:
    """The files that are asked for, by format."""
    return {x: file for x in entries("build_results") if (file := vars(args).get(x)) is not None}


def print_answer(answer: _Answer, target: str | None) -> None:
    """An answer as text, or as JSON where ``--json`` names stdout; also as JSON to the file that it names.

    Raises ``InputError``.
    """
    if target:
        write_json(answer.as_data(), target)
    if target != "-":
        print(answer)


def write_json(data: Mapping[str, object], target: str) -> None:
    """``data`` as JSON to the file ``target``, or to stdout where it is ``-``. Raises ``InputError``."""
    plain = target == "-" and not takes_everything(sys.stdout)
    text = json.dumps(data, indent=2, ensure_ascii=plain) + "\n"
    if target == "-":
        print(text, end="")
        return
    with atomic_file(Path(target)) as file:
        file.write(utf8(text))


def add_what_arguments(parser: argparse.ArgumentParser, every: str) -> None:
    """Scenarios and formulas by position, and ``--all``, of which ``every`` is the help."""
    question = section(parser, "question")
    help_text = "scenarios (4, 1,3-8 or a name) or formulas"
    question.add_argument("what", metavar="N|FORMULA", nargs="*", help=help_text)
    question.add_argument("--all", action="store_true", help=every)


def some_or_all(args: argparse.Namespace) -> list[str]:
    """Return the named scenarios and formulas, none with --all. Raises ``UsageError``."""
    if args.all == bool(args.what):
        raise UsageError("name scenarios or formulas, or use --all, but not both")
    return list(args.what)


def read_executor(args: argparse.Namespace) -> "Executor":
    """Return the executor of ``--jobs``, ``--shard`` and ``--cluster``.

    Raises ``UsageError``.
    """
    from roadproof.frontends.cli.progress import note
    from roadproof.runtime.executors import Cluster, Executor, Shard

    options = vars(args)
    names = ("ca", "cert", "key")
    ca, cert, key = files = [options.get(f"tls_{name}") for name in names]
    address, share = options.get("cluster"), options.get("shard")
    named = [f"--tls-{name}" for name, file in zip(names, files, strict=True) if file is not None]
    if named and address is None:
        raise UsageError(f"{named[0]} requires --cluster SCHEDULER")
    if address is not None and args.jobs is not None:
        raise UsageError("--jobs and --cluster exclude each other: omit one of them")
    if share is not None and args.json is not None:
        raise UsageError("--shard gives a part of the answer: use --json in the run without --shard")
    cluster = None if address is None else Cluster(address, ca, cert, key, note)
    return Executor(args.jobs, cluster, None if share is None else Shard.read(share))
