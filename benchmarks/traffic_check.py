"""Every answer of the evaluation beside the plain recursive evaluator's, on simulated traffic.

    python benchmarks/traffic_check.py --recordings 20 --seconds 60

For every disturbance trace, both roles, all scenarios of two cars, all sets and both minDanger, the
recursive evaluator is asked on the same cut trace; the two lists of matches must be equal. The same
for the triples of scenario 2 that the evaluation found. Ends with exit code 30 if any differ.
"""

import argparse
import sys
import time
from pathlib import Path

from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from extensions.traffic.reference import Reference, Row


def slow_matches(recording: Recording, findings: Findings, reference: Reference) -> set[Row]:
    index = {int(number): k for k, number in enumerate(recording.vehicle_id)}
    found: set[Row] = set()
    for t in findings.traces:
        one, other = index[t.first], index[t.second]
        found |= set(reference.match_pair(one, other, t.start_frame, t.end_frame, t.min_danger))
        found |= set(reference.match_pair(other, one, t.start_frame, t.end_frame, t.min_danger))
    triples = {(m.sv, m.pov, m.pov2) for m in findings.matches if m.pov2 is not None}
    for sv, pov1, pov2 in triples:
        rows = reference.match_triples(index[sv], index[pov2])
        found |= {row for row in rows if row[1] == pov1}
    return found


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--recordings", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    questions = compile_questions(default_settings(), 25)
    wrong = traces = matches = 0
    begun = time.perf_counter()
    for number in range(1, args.recordings + 1):
        lanes = 2 + number % 2
        recording = simulate(
            TrafficSettings(seconds=args.seconds, lanes=lanes, lane_width=3.5), args.seed, number
        )
        findings = evaluate_recording(recording, questions)
        fast: set[Row] = {
            (m.sv, m.pov, m.pov2, m.lane, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario)
            for m in findings.matches
        }
        differing = fast ^ slow_matches(recording, findings, Reference(recording, questions.settings))
        for row in sorted(differing, key=str):
            print(
                f"recording {number}: {'only the evaluation' if row in fast else 'only the reference'}: {row}"
            )
        wrong, traces, matches = wrong + len(differing), traces + len(findings.traces), matches + len(fast)
        print(f"[{number}/{args.recordings}] {len(findings.traces)} traces, {len(fast)} matches", flush=True)
    seconds = time.perf_counter() - begun
    print(f"{traces} traces, {matches} matches, {wrong} that differ from the reference, {seconds:.0f} s")
    return 30 if wrong or not matches else 0


if __name__ == "__main__":
    sys.exit(main())
