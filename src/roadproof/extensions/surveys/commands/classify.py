"""``roadproof classify``: mutually exclusive classes that together cover the scenarios."""

import argparse

from roadproof.errors import UsageError
from roadproof.extensions.surveys.settings import Classify
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords

SUMMARY = "partition scenarios into exclusive classes, and count them"

EXAMPLES = """\
examples:
  roadproof classify --out classes                    scenarios 1-24 of base: what happens, and where
  roadproof classify --among 1-8 --out classes        those of the main road
  roadproof classify --set ext --on highd/data        shares on recordings of yours
  roadproof prove --spec classes/classes.spec --set classes --claims classes/claims.txt
  roadproof witness 'class_4_8_main(SV,POV,L)' --spec classes/classes.spec --set classes --road main-2
  roadproof classify --among 1-8 --unpreventable careful

A class is a choice of scenarios that hold together on one trace, for the same vehicles and lane, while the
others do not. Choices that are proved impossible are left out. Classes of SV and POV and of SV, POV1, POV2
are kept apart. Evidence goes to DIR, or with --json FILE alone to FILE-evidence; `roadproof check DIR`
checks it. A run that was broken off goes on where it was. Exit code 20 where a claim is not proved or a
class has no drive.
"""
OPTIONS = Classify


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.surveys.classifying import classify

    if args.on is not None and not args.shares:
        raise UsageError("--on and --no-shares contradict each other: omit one of them")
    home = read_definitions(args, OPTIONS)
    result = classify(args.among, home, **study_keywords(args, OPTIONS, beside_json=True))
    return deliver(args, result, args.pictures)
