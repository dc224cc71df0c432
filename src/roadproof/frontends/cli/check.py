"""``roadproof check``: certificates and drive files, checked again without what made them."""

import argparse
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.extension import entries, import_entry
from roadproof.frontends.cli.options import print_answer, write_build_results
from roadproof.frontends.cli.progress import Counter
from roadproof.frontends.settings.flags import read_keywords
from roadproof.frontends.settings.questions import Check
from roadproof.verdict import ExitCode

SUMMARY = "check certificates and drive files again, independently"

EXAMPLES = """\
examples:
  roadproof check proofs/                          every claim of a folder
  roadproof check proofs/ --solver cvc5            ask another solver
  roadproof check drives/scenario-04-base.json     judge a drive again, exactly
  roadproof check proofs/ --kernel coq             certificates and drives are put to Coq, and to no solver
  roadproof check proofs/ --kernel coq --write v/  what would be put to Coq, to be read
  roadproof check proofs/ --kernel extracted       by a program that Coq made of its checkers
  roadproof check proofs/ --strict                 for a pipeline: no answer may be without evidence
  roadproof check mine/ --spec mine.spec           claims that were made with definitions of yours
  roadproof check case.toml                        all evidence of an assurance case, as roadproof assurance

A certificate is accepted when two things hold: the claim and the certificate's instances, read with the
present library, give the stored query; and the solver answers unsat to it. A drive file is accepted when
its formula holds on its drive, judged exactly in dense time. A NONE-WITHIN is accepted when its tree refutes
the question, which is encoded again in exact numbers. In a folder of answers the claims are listed again
from question.json, and NAME.json must answer the claim of that name; other JSON files are rejected, and a
claim without a file is UNKNOWN. If question.json names specification files beside it, such as classes.spec,
they are added to the library, unless they would change its definitions.

A line for each claim lists the checked and unchecked parts. Files that nothing is compared with follow, and
what the accepted answers of a folder show together, such as the verdict of coverage. Exit codes: 10 if
something is rejected; 20 if the solver did not decide, or no evidence was accepted; 3 if a file is damaged or
needs definitions that are missing. For pipelines: with --strict also 20 if an answer has no evidence, such as
UNKNOWN or NONE-WITHIN.
"""
OPTIONS = Check
_THERE = {
    "coq": "coqc -Q Roadproof Roadproof FILE.v, after the theories in Roadproof",
    "extracted": "ocamlopt -I ocaml -o check ocaml/{checker,reader,certificates,main}.ml; ./check <FILE.txt",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("paths", metavar="FILE|DIR", nargs="+", type=Path, help="evidence, or folders of it")


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.frontends.api.checking import check

    if args.kernel is not None and args.solver != "z3":
        raise UsageError(f"--kernel {args.kernel} uses no solver: omit --solver or --kernel")
    others = entries("checked_files")
    for path in args.paths:
        if path.suffix in others:
            code: int = import_entry(others[path.suffix])(args)
            return code
    if args.write is not None:
        return _write(args)
    checked = check(*args.paths, **read_keywords(args, Check) | {"progress": Counter()})
    write_build_results(args, checked)
    print_answer(checked, args.json)
    return checked.exit_code


def _write(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.checking import write_sources

    if args.kernel is None or args.json or args.junit or args.sarif:
        remedy = "add --kernel, and omit --json, --junit and --sarif"
        raise UsageError(f"--write DIR only writes files for a kernel: {remedy}")
    written = write_sources(
        *args.paths, folder=args.write, specs=args.specs or (), jobs=args.jobs, kernel=args.kernel
    )
    for path, reason in written.reasons.items():
        print(f"no file for {path}: {reason}")
    count = f"{written.count} file{'s' * (written.count != 1)}"
    print(f"wrote {count} for {args.kernel} to {args.write}, and checked no evidence")
    print(f"to check them there: {_THERE[args.kernel]}")
    return ExitCode.UNKNOWN if written.reasons else ExitCode.AS_EXPECTED
