"""Detectors of earlier works, beside the scenarios (paper, RQ5): all pairs, all their common frames."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from roadproof.extensions.traffic.evaluate.questions import EvaluationQuestions
from roadproof.extensions.traffic.evaluate.traces import blocks, gather
from roadproof.extensions.traffic.formats.pairs import Pairs, pairs_in_sight
from roadproof.extensions.traffic.formats.recording import Masks, Recording
from roadproof.library.scenarios import LANE


@dataclass(frozen=True)
class Detection:
    """A detector that holds for SV and POV in a lane; ids are the recording's."""

    detector: str
    sv: int
    pov: int
    lane: str

    @property
    def pair(self) -> tuple[int, int]:
        """The unordered pair that it counts for."""
        return min(self.sv, self.pov), max(self.sv, self.pov)


def find_detections(
    recording: Recording, questions: EvaluationQuestions, meeting: Pairs
) -> tuple[Detection, ...]:
    """Return the detections among the pairs ``meeting``, for both roles and every lane."""
    if questions.detectors is None or not len(meeting):
        return ()
    if questions.sight is None:
        pairs, lanes = meeting, np.full(len(meeting), (1 << len(recording.lanes)) - 1, np.uint32)
    else:
        pairs, lanes = pairs_in_sight(recording, meeting, questions.sight)
    detections = _detect(recording, questions, pairs, lanes)
    return tuple(sorted(detections, key=order_of_detections))


def order_of_detections(detection: Detection) -> tuple[str, int, int, str]:
    """Return the sort key of a detection."""
    return detection.detector, detection.sv, detection.pov, detection.lane


def _detect(
    recording: Recording, questions: EvaluationQuestions, pairs: Pairs, lanes: Masks
) -> Iterator[Detection]:
    """``lanes`` holds, for each pair, the lanes to ask for, as bits."""
    assert questions.detectors is not None
    signals = questions.detectors.signals
    bits = np.arange(len(recording.lanes))
    pair, lane = np.nonzero((lanes[:, None] >> bits) & 1)
    candidates, ids = pairs.choose(pair), recording.vehicle_id
    for index in blocks(candidates.low, candidates.high, 400_000):
        block = candidates.choose(index)
        at = {LANE: lane[index]}
        batch = gather(recording, block.vehicles, block.low, block.high, signals, at, questions.lane_atoms)
        for key, true in questions.detectors.holds(batch, questions.settings.convention).items():
            for p in np.flatnonzero(true):
                ids_of_pair = int(ids[block.first[p]]), int(ids[block.second[p]])
                sv, pov = ids_of_pair if key.sv == "first" else ids_of_pair[::-1]
                yield Detection(key.detector, sv, pov, recording.lanes[at[LANE][p]].name)
