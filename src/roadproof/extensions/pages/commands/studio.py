"""``roadproof studio``: a page in the browser in which formulas are written and tried."""

import argparse
from pathlib import Path

from roadproof.extensions.pages import options as settings

SUMMARY = "write and try formulas on a page in the browser"

EXAMPLES = """\
examples:
  roadproof studio                          opens the browser
  roadproof studio mine.spec drive.json     with definitions of yours, and a drive
  roadproof studio drives                   with the drives and definitions of a folder to choose from
  roadproof studio 01_*.csv                 with a recording: the three files of highD
  roadproof studio --no-browser --port 9000

The page is served on this machine's loopback interface only, at the address that is printed; its token is
made anew at each start. Nothing is sent anywhere else. Ctrl-C ends it. Needs starlette and uvicorn.
"""
OPTIONS = settings.Studio


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(quiet=True)  # how far it is, the page says
    told = (
        "a .spec file, drive or certificate (.json), samples (.csv, .xosc), the files of a recording, or a "
        "folder of drives and definitions (default: the working folder)"
    )
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path, help=told)


def run(args: argparse.Namespace) -> int:
    from roadproof.errors import UsageError
    from roadproof.extensions.pages.studio.pages import begin_with, found_in
    from roadproof.extensions.pages.studio.server import Studio, serve
    from roadproof.verdict import ExitCode

    if args.port is not None and not 0 <= args.port < 65536:
        raise UsageError(f"--port {args.port}: write a number from 1 to 65535, or 0 for any that is free")
    begun = begin_with(args.files) if args.files else found_in(Path.cwd())
    serve(Studio(begun), args.port, args.browser, _say)
    return ExitCode.AS_EXPECTED


def _say(address: str) -> None:
    print(f"roadproof studio: {address}\nCtrl-C ends it.", flush=True)
