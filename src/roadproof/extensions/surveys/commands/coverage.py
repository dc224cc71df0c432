"""``roadproof coverage``: the disturbances that a spec set misses, or a proof that it misses none."""

import argparse

from roadproof.extensions.surveys.settings import Coverage
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords
from roadproof.frontends.cli.progress import Counter, tell

SUMMARY = "find disturbances that a spec set misses, or prove it has no gap"

EXAMPLES = """\
examples:
  roadproof coverage --set complete --out complete    proved to have no gap between two vehicles
  roadproof coverage --set complete --needed          and which of its definitions it needs for that
  roadproof coverage --set ext --out gaps             the classes of gaps, each with a drive or a proof
  roadproof coverage --set base --jobs 2              what base misses, and which wider set catches it
  roadproof coverage --set ext --on recordings        and how often each class occurs in traffic
  roadproof coverage --set ext --unpreventable careful   drives no careful driver survives, in no scenario

A gap: initSafe at the start, danger later, and no two-vehicle scenario for any lane and either role. Its
classes say why: scenario 4, deceleration ahead, would hold but for its component
behaviourPOV_4, or for one condition of it.
Of each class: a judged drive, or a proof that it is empty, or how far it was looked. Behind a drive's
number: the first wider set that catches it, and the smallest choice of its definitions that does.
Evidence goes to DIR, `roadproof check DIR` checks it; a run that was broken off goes on where it was.
Exit code 0 where coverage is proved, 10 where there are gaps, 20 where neither was found.
"""
OPTIONS = Coverage


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.surveys.covering import coverage

    home = read_definitions(args, OPTIONS)
    result = coverage(home, tell=tell, **study_keywords(args, OPTIONS))
    if args.out is not None and args.pictures:
        result.draw_beside(args.jobs, Counter())
    return deliver(args, result, args.pictures)
