"""``roadproof report``: present results of any kind as one page that needs no network."""

import argparse
from pathlib import Path

from roadproof.extensions.pages.settings import PageSettings
from roadproof.frontends.cli.progress import Counter, clear
from roadproof.frontends.settings.flags import read_keywords, section

SUMMARY = "make one HTML page from results, to be read without a network"

EXAMPLES = """\
examples:
  roadproof report drives -o drives.html                 a folder of witness --out, each drive with its viewer
  roadproof report proofs overlap results -o all.html    folders of prove, overlap and evaluate on one page
  roadproof report answer.json -o answer.html            an answer of --json

Evidence is checked again while the page is made, as by `roadproof check`, and each claim says what was found.
The page is one file: it opens without a server, prints, and follows the system's choice of light or dark.
"""
OPTIONS = PageSettings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "results",
        metavar="RESULT",
        nargs="+",
        type=Path,
        help="a folder of --out, a file of evidence or of --json",
    )
    section(parser, "output").add_argument(
        "-o", "--out", metavar="FILE", type=Path, required=True, help="the page, NAME.html"
    )


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.pages.reporting import page

    written = page(*args.results, out=args.out, **read_keywords(args, PageSettings) | {"progress": Counter()})
    clear()
    print(written)
    return written.exit_code
