"""``roadproof SUBCOMMAND …``: finds the module of the sub-command, and turns errors into exit codes.

A sub-command is a module in this folder with ``SUMMARY`` (a plain literal), ``EXAMPLES`` for its help, and
``run(args) -> int``, where the integer is the exit code. It may have ``OPTIONS``, the settings class that its
flags are made of, and ``add_arguments(parser)`` for others. Only the one that is asked for is imported.
"""

import argparse
import atexit
import contextlib
import errno
import gc
import os
import sys
import threading
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from roadproof.errors import RoadproofError, UsageError
from roadproof.frontends.cli.help import CommandParser, command_parser, written_files
from roadproof.frontends.cli.overview import COMMANDS, overview
from roadproof.frontends.cli.progress import be_quiet, clear
from roadproof.frontends.cli.streams import FULL, forget_output, make_streams_lenient
from roadproof.frontends.cli.supervising import supervise
from roadproof.frontends.cli.terminal import dress_output
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode

TRACEBACK = "ROADPROOF_TRACEBACK"


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit code; results on stdout, complaints on stderr.

    Without ``argv`` it is that of this process, which then watches over a child that does the work.
    """
    if argv is None:
        if "_ARGCOMPLETE" in os.environ:  # a completion script asks
            from roadproof.frontends.cli.completion import complete

            complete()
        return supervise(lambda: _answer_last(sys.argv[1:]))
    return answer(list(argv))


def _answer_last(arguments: list[str]) -> int:
    """Run a command and end the process at once, without the time that Python takes to free all objects."""
    try:
        code = answer(arguments)
    finally:
        gc.freeze()
    if hasattr(os, "fork") and threading.active_count() == 1:
        atexit._run_exitfuncs()
        with contextlib.suppress(OSError, ValueError):  # what cannot be written now, the usual end tells
            for stream in (sys.stdout, sys.stderr):
                if stream is not None:
                    stream.flush()
            os._exit(code)
    return code


def answer(arguments: list[str]) -> int:
    """Run a command in this process; return its exit code."""
    make_streams_lenient()
    try:
        code = _run(arguments)
        if sys.stdout is not None:
            sys.stdout.flush()
        return code
    except BrokenPipeError:
        forget_output()  # the reader has gone away
        return ExitCode.READER_GONE
    except (Exception, KeyboardInterrupt) as error:
        message, code = _ending(error)
        if code is ExitCode.OUR_FAULT and os.environ.get(TRACEBACK):
            raise
        return _complain(message, code)


def _ending(error: BaseException) -> tuple[str, ExitCode]:
    """Return the message and the exit code for an error that ended a command."""
    if isinstance(error, RoadproofError):
        return str(error), ExitCode(error.exit_code)
    if _is_interruption(error):
        return "interrupted", ExitCode.INTERRUPTED
    if isinstance(error, OSError) and error.errno is not None:
        return _of_system(error), ExitCode.BAD_INPUT
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    remedy = f"Set {TRACEBACK}=1 to see where it happened, and report it with the command line."
    return f"this is our fault: {reason}\n{remedy}", ExitCode.OUR_FAULT


def _is_interruption(error: BaseException) -> bool:
    """Return whether an interruption is the error or its cause.

    Python turns one that comes while a class is made into a ``RuntimeError``.
    """
    cause = error.__cause__
    return isinstance(error, KeyboardInterrupt) or (cause is not None and _is_interruption(cause))


def _run(arguments: list[str]) -> int:
    at = next((i for i, word in enumerate(arguments) if not word.startswith("-")), len(arguments))
    parser = CommandParser(prog="roadproof", add_help=False)
    parser.add_argument("-h", "--help", "--help-all", action="store_true")
    parser.add_argument("--version", action="store_true")
    first = parser.parse_args(arguments[:at])
    if first.help:
        print(overview(), end="")
        parser.exit()
    if first.version:
        print(f"roadproof {VERSION}")
        return ExitCode.AS_EXPECTED
    if at == len(arguments):
        raise UsageError("name a sub-command; see roadproof --help")
    name = arguments[at]
    if name not in COMMANDS:
        from roadproof.library.specification import unknown_name

        raise UsageError(f"{unknown_name('sub-command', name, COMMANDS)}\nSee roadproof --help.")
    command = command_parser(name)
    parsed = command.parse_args(arguments[at + 1 :])
    be_quiet(getattr(parsed, "quiet", False))
    files = written_files(command)
    folder = None if "out" in files else vars(parsed).get("out")
    for option in files:
        _try_path(getattr(parsed, option), folder)
    if getattr(parsed, "json", None) != "-" and getattr(parsed, "format", "text") == "text":
        dress_output()
    try:
        code: int = import_module(COMMANDS[name].module).run(parsed)
    except (Exception, KeyboardInterrupt) as error:
        _write_ended(parsed, name, error)
        raise
    return code


def _write_ended(parsed: argparse.Namespace, name: str, error: BaseException) -> None:
    """Write into the files of ``--junit`` and ``--sarif`` that the command ended, where possible."""
    if isinstance(error, BrokenPipeError):
        return
    from roadproof.frontends.cli.options import write_ended

    with contextlib.suppress(RoadproofError, OSError):
        message, code = _ending(error)
        write_ended(parsed, name, code, message)


def _try_path(target: str | Path | None, out: Path | None) -> None:
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


def _of_system(error: OSError) -> str:
    """Return the message for a failing file or disk; a full disk loses what stdout still holds."""
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
