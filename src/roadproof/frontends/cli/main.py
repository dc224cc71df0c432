"""``roadproof SUBCOMMAND …``: finds the module of the sub-command, and turns errors into exit codes.

A sub-command is a module in this folder with ``SUMMARY: str`` (a plain literal), ``add_arguments(parser)``
and ``run(args) -> int``, where the integer is the exit code. Only the one that is asked for is imported.
"""

import argparse
import ast
import contextlib
import errno
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import NoReturn

from roadproof.errors import RoadproofError, UsageError
from roadproof.frontends.cli.progress import be_quiet, clear
from roadproof.frontends.cli.streams import FULL, forget_output, make_streams_lenient
from roadproof.frontends.cli.supervising import supervise
from roadproof.verdict import ExitCode

_PACKAGE = "roadproof.frontends.cli"
# What --help shows first; other sub-commands follow by name.
_FIRST = (
    *(
        "list",
        "show",
        "studio",
        "prove",
        "check",
        "witness",
        "compare",
        "monitor",
        "evaluate",
        "simulate",
        "export",
        "report",
    ),
    *("overlap", "order", "redundancy", "coverage", "classify", "explore", "catalogue"),
)


def _summary(file: Path) -> str | None:
    """The literal ``SUMMARY`` of a module, one line, None where it has none.

    It is read without importing the module: --help has to be quick.
    """
    for line in file.read_text("utf-8").splitlines():
        if line.startswith("SUMMARY = "):
            text: str = ast.literal_eval(line.partition("=")[2].strip())
            return text
    return None


def _find_commands(folder: Path) -> dict[str, str]:
    """The sub-commands with their summaries: the modules in a folder that have one."""
    found = {x.stem: text for x in folder.glob("[a-z]*.py") if (text := _summary(x)) is not None}
    places = {name: place for place, name in enumerate(_FIRST)}
    return {name: found[name] for name in sorted(found, key=lambda x: (places.get(x, len(places)), x))}


COMMANDS = _find_commands(Path(__file__).parent)
TRACEBACK = "ROADPROOF_TRACEBACK"

_EXAMPLES = """\
examples:
  roadproof list                          what there is: scenarios, spec sets, options, parameters
  roadproof show 4                        scenario 4, deceleration ahead, and the definitions it uses
  roadproof show 4 --set ext --expand     the same as one formula
  roadproof show 'F danger(SV,POV)' --format latex

exit codes: 0 as expected, 10 refuted or unexpected, 20 unknown, 30 cross-check failed,
            2 usage, 3 bad input, 4 missing solver, 70 our fault, 130 interrupted, 143 ended
"""


class _Parser(argparse.ArgumentParser):
    """A parser whose mistakes are errors like all others."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; see {self.prog} --help")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit code; results on stdout, complaints on stderr.

    Without ``argv`` it is that of this process, which then watches over a child that does the work.
    """
    if argv is None:
        return supervise(lambda: answer(sys.argv[1:]))
    return answer(list(argv))


def answer(arguments: list[str]) -> int:
    """As ``main``, in this process."""
    make_streams_lenient()
    try:
        code = _run(arguments)
        if sys.stdout is not None:
            sys.stdout.flush()
        return code
    except RoadproofError as error:
        return _complain(str(error), error.exit_code)
    except KeyboardInterrupt:
        return _complain("interrupted", ExitCode.INTERRUPTED)
    except BrokenPipeError:
        forget_output()  # the reader has gone away
        return ExitCode.READER_GONE
    except Exception as error:
        if isinstance(error, OSError) and error.errno is not None:
            return _complain(_of_system(error), ExitCode.BAD_INPUT)
        if os.environ.get(TRACEBACK):
            raise
        reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        return _complain(
            f"this is our fault: {reason}\n"
            f"Set {TRACEBACK}=1 to see where it happened, and report it with the command line.",
            ExitCode.OUR_FAULT,
        )


def _run(arguments: list[str]) -> int:
    parser = _Parser(
        prog="roadproof",
        description="Compiles driving scenarios to proofs, witnesses and monitors.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="store_true", help="print the version and exit")
    asked = next((a for a in arguments if not a.startswith("-")), None)
    if asked is not None and asked not in COMMANDS:
        from roadproof.library.specification import unknown

        raise UsageError(f"{unknown('sub-command', asked, COMMANDS)}\nSee roadproof --help.")
    commands = parser.add_subparsers(dest="command", metavar="SUBCOMMAND", parser_class=_Parser)
    for name, summary in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=summary,
            description=summary,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name == asked:
            import_module(f"{_PACKAGE}.{name}").add_arguments(command)
    parsed = parser.parse_args(arguments)
    if parsed.version:
        return _print_version()
    if parsed.command is None:
        raise UsageError("name a sub-command; see roadproof --help")
    be_quiet(getattr(parsed, "quiet", False))
    _try_paths(getattr(parsed, "json", None), getattr(parsed, "out", None))
    code: int = import_module(f"{_PACKAGE}.{parsed.command}").run(parsed)
    return code


def _try_paths(target: str | None, out: Path | None) -> None:
    """Fail before the work where the answer could not be written. Raises ``InputError``."""
    if target in (None, "-"):
        return
    path = Path(str(target))
    if out is not None and path.parent.absolute().is_relative_to(Path(out).absolute()):
        return  # a folder that is made
    error = None
    if not path.parent.is_dir():
        error = errno.ENOENT
    elif path.is_dir():
        error = errno.EISDIR
    elif not os.access(path if path.exists() else path.parent, os.W_OK):
        error = errno.EACCES
    if error is not None:
        from roadproof.runtime.files import cannot_write

        raise cannot_write(path, OSError(error, os.strerror(error)))


def _print_version() -> int:
    from importlib.metadata import version

    print(f"roadproof {version('roadproof')}")
    return ExitCode.AS_EXPECTED


def _of_system(error: OSError) -> str:
    """What a failing file or disk is told as; what stdout still holds is lost where the disk is full."""
    reason = os.strerror(error.errno or 0)
    if error.filename is not None:
        return f"cannot use {error.filename}: {reason}"
    if error.errno in FULL:
        forget_output()
    return f"cannot write the answer: {reason[0].lower()}{reason[1:]}; make room there, or write elsewhere"


def _complain(message: str, code: int) -> int:
    with contextlib.suppress(OSError):
        clear()
        print(f"roadproof: {message}", file=sys.stderr)
    return int(code)


if __name__ == "__main__":
    sys.exit(main())
