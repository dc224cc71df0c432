"""``roadproof studio``: a page in the browser for writing and trying formulas."""

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
    help_text = (
        "a .spec file, drive or certificate (.json), samples (.csv, .xosc), the files of a recording, or a "
        "folder of drives and definitions (default: the working folder)"
    )
    parser.add_argument("files", metavar="FILE", nargs="*", type=Path, help=help_text)


def run(args: argparse.Namespace) -> int:
    from roadproof.errors import UsageError
    from roadproof.extensions.pages.studio.pages import read_folder, read_start_files
    from roadproof.extensions.pages.studio.server import StudioServer, serve
    from roadproof.verdict import ExitCode

    if args.port is not None and not 0 <= args.port < 65536:
        raise UsageError(f"--port {args.port}: write a number from 1 to 65535, or 0 for any that is free")
    content = read_start_files(args.files) if args.files else read_folder(Path.cwd())
    serve(StudioServer(content), args.port, args.browser, _say)
    return ExitCode.AS_EXPECTED


def _say(address: str) -> None:
    print(f"roadproof studio: {address}\nCtrl-C ends it.", flush=True)
