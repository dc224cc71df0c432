"""``roadproof bundle``: pack evidence, and everything that checks it again, into one file for auditors."""

import argparse
from pathlib import Path

from roadproof.extensions.assurance.settings import BundleSettings
from roadproof.frontends.cli.options import print_answer
from roadproof.frontends.cli.progress import Counter, clear
from roadproof.frontends.settings.flags import read_keywords, section

SUMMARY = "pack evidence for auditors, with a script that checks it again"

EXAMPLES = """\
examples:
  roadproof bundle proofs drives -o safety.tar.gz           folders of --out
  roadproof bundle proofs --spec ours.spec -o safety.tar.gz
  roadproof bundle report case.toml -o safety.tar.gz        the tests of a catalogue come with its answer
  roadproof bundle proofs -o safety.tar.gz --wheels         all packages are inside: no network is needed
  roadproof bundle proofs -o safety.tar.gz --sign key.pem   and a signature, safety.tar.gz.sig
  tar xzf safety.tar.gz && sh safety/check.sh               what the auditor types

The bundle has the evidence under the paths that are named, a page (index.html), the versions and digests of
all packages, and check.sh, which checks all digests, and the evidence with z3, cvc5 and, where coqc is
installed, Coq, in a fresh environment. The same content gives the same bundle, byte by byte.
A key is made by openssl genpkey -algorithm ed25519 -out key.pem; a signature is verified by
openssl pkeyutl -verify -pubin -inkey public.pem -rawin -in safety.tar.gz -sigfile safety.tar.gz.sig
It runs roadproof assurance and trace on cases and requirements inside, and fails when these fail.
Exit code: the gravest of roadproof check, assurance and trace.
"""
OPTIONS = BundleSettings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("results", metavar="DIR|FILE", nargs="+", type=Path, help="evidence, and other files")
    section(parser, "output").add_argument(
        "-o", "--out", metavar="FILE", type=Path, required=True, help="NAME.tar.gz"
    )


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.assurance.bundling import bundle

    written = bundle(
        *args.results, out=args.out, **read_keywords(args, BundleSettings) | {"progress": Counter()}
    )
    clear()
    print_answer(written, args.json)
    return written.exit_code
