"""How many random claims end UNKNOWN, how long answers take, and whether any answer is wrong.

    python benchmarks/answers.py [--count 400] [--seed 1] [--sample K] [--keep FILE]

Each claim is asked once, with the limits that ``roadproof prove`` has by itself. ``--keep`` writes a line of
JSON for each claim as it is answered, and goes on from there in the next run. Seconds are of the processor,
so that other work on the machine counts little.
"""

import argparse
import json
import sys
import time
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median, quantiles

from random_claims import Claim, draw

import roadproof
from roadproof.errors import RoadproofError

HOLDS = ("PROVED", "VACUOUS")


@dataclass(frozen=True)
class Answer:
    """What ``prove`` said of a claim, with seconds of the processor and of the clock."""

    claim: Claim
    verdict: str
    reason: str
    seconds: float
    wall: float

    @property
    def wrong(self) -> bool:
        """Whether the verdict contradicts how the claim was made."""
        if self.claim.truth is None:
            return self.verdict == "CROSSCHECK-FAILED"
        return self.verdict not in ("UNKNOWN", *(HOLDS if self.claim.truth else ("REFUTED",)))


def ask(claim: Claim) -> Answer:
    """The answer of a fresh question, without what earlier ones left in a cache."""
    wall, seconds = time.perf_counter(), time.process_time()
    try:
        row = roadproof.prove(claim.text, jobs=1).rows()[0]
        verdict, reason = row["verdict"], row["reason"]
    except RoadproofError as error:
        verdict, reason = "ERROR", str(error)
    return Answer(claim, verdict, reason, time.process_time() - seconds, time.perf_counter() - wall)


def kept(file: Path | None) -> dict[str, Answer]:
    """Answers of an earlier run, by the text of their claims."""
    if file is None or not file.exists():
        return {}
    rows = map(json.loads, file.read_text().splitlines())
    return {x["claim"]["text"]: Answer(Claim(**x.pop("claim")), **x) for x in rows}


def summary(answers: list[Answer]) -> str:
    """Shares, times, wrong answers and reasons, as text."""
    unknown = [x for x in answers if x.verdict == "UNKNOWN"]
    wrong = [x for x in answers if x.wrong]
    seconds = [x.seconds for x in answers]
    lines = [
        f"{len(answers)} claims, {sum(x.claim.truth is False for x in answers)} of them false,"
        f" {sum(x.claim.truth is None for x in answers)} without a label",
        f"UNKNOWN {len(unknown)} ({100 * len(unknown) / len(answers):.1f} %), wrong {len(wrong)}",
        f"processor time: median {median(seconds):.2f} s, 90 % {quantiles(seconds, n=10)[-1]:.2f} s,"
        f" greatest {max(seconds):.1f} s, sum {sum(seconds):.0f} s",
        f"clock: median {median(x.wall for x in answers):.2f} s",
        f"{'family':14} {'claims':>6} {'UNKNOWN':>7} {'true':>5} {'false':>5} {'median':>8}",
    ]
    for family in dict.fromkeys(x.claim.family for x in answers):
        of = [x for x in answers if x.claim.family == family]
        doubt = [x for x in of if x.verdict == "UNKNOWN"]
        lines.append(
            f"{family:14} {len(of):6} {len(doubt):7} {sum(x.claim.truth is True for x in doubt):5}"
            f" {sum(x.claim.truth is False for x in doubt):5} {median(x.seconds for x in of):6.2f} s"
        )
    lines += [f"{count:4} {reason}" for reason, count in Counter(x.reason for x in unknown).most_common()]
    lines += [f"WRONG {x.verdict} {x.claim.text} (made to be {x.claim.truth}) {x.reason}" for x in wrong]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sample", type=int, help="ask only the first K of them")
    parser.add_argument("--keep", type=Path, help="a file of answers, which grows")
    options = parser.parse_args()
    claims = list(draw(options.count, options.seed))[: options.sample]
    before = kept(options.keep)
    roadproof.prove("true", jobs=1)
    answers: list[Answer] = []
    for claim in claims:
        answer = before.get(claim.text) or ask(claim)
        answers.append(answer)
        if options.keep is not None and claim.text not in before:
            with options.keep.open("a") as out:
                out.write(json.dumps(asdict(answer)) + "\n")
        print(f"{answer.verdict:8} {answer.seconds:6.2f} s  {claim.text}", file=sys.stderr, flush=True)
    print(summary(answers))


if __name__ == "__main__":
    main()
