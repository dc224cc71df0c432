"""Labels of matches by driver models: when the manoeuvre begins, and whether the model prevents a collision.

Each model is put into the match: from its start on SV drives as the model does, and all else moves as in
the recording, up to the last frame that has all of its vehicles.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Literal, TypeAlias, get_args

import numpy as np

from roadproof.extensions.drivers.outcome import Result
from roadproof.extensions.drivers.sampled_replay import TRACKED, SampledScene, replay_samples
from roadproof.extensions.traffic.evaluate.courses import BEGINS, ManoeuvreTest
from roadproof.extensions.traffic.evaluate.driven import scene_of
from roadproof.extensions.traffic.evaluate.matching import Match
from roadproof.extensions.traffic.evaluate.one_trace import road_of
from roadproof.extensions.traffic.evaluate.questions import EvaluationQuestions
from roadproof.extensions.traffic.evaluate.traces import blocks, gather, gather_one
from roadproof.extensions.traffic.formats.recording import Integers, Recording
from roadproof.world.road import Road

Label: TypeAlias = Literal["preventable", "unpreventable", "undecided", "not covered"]
LABELS: tuple[Label, ...] = get_args(Label)
RESULTS: Mapping[Result, Label] = {
    Result.PREVENTED: "preventable",
    Result.COLLIDES: "unpreventable",
    Result.UNDECIDED: "undecided",
}
_NEVER = -1

# What matches have in common where a course is the same: SV, POV, POV2, and the first frame.
_Key: TypeAlias = tuple[int, int, int | None, int]


def with_driver_labels(
    recording: Recording, questions: EvaluationQuestions, matches: Sequence[Match]
) -> list[Match]:
    """The matches in their order, those of which models speak with ``frame`` and ``labels``."""
    if not questions.courses:
        return [*matches]
    labels_of: dict[tuple[int, _Key], tuple[int | None, tuple[str, ...]]] = {}
    place = {number: k for k, number in enumerate(recording.vehicle_id.tolist())}
    of = {number: k for k, course in enumerate(questions.courses) for number in course.scenarios}
    for k, course in enumerate(questions.courses):
        keys = list(dict.fromkeys(_key(x) for x in matches if of.get(x.scenario) == k))
        if keys:
            for key, label in zip(
                keys, _driver_labels(recording, questions, course, keys, place), strict=True
            ):
                labels_of[k, key] = label
    match_keys = ((of.get(x.scenario, -1), _key(x)) for x in matches)
    labelled = zip(matches, (labels_of.get(key, (None, ())) for key in match_keys), strict=True)
    return [replace(x, begun=frame, labels=labels) for x, (frame, labels) in labelled]


def _key(match: Match) -> _Key:
    return match.sv, match.pov, match.pov2, match.start_frame


def _driver_labels(
    recording: Recording,
    questions: EvaluationQuestions,
    course: ManoeuvreTest,
    keys: Sequence[_Key],
    place: Mapping[int, int],
) -> list[tuple[int | None, tuple[str, ...]]]:
    """Return for each trace the frame at which the manoeuvre begins, and a label for each driver."""
    indices = np.array([[place[x] for x in key[:3] if x is not None] for key in keys], np.int64).T
    vehicles = dict(zip(course.vehicles, indices, strict=True))
    low = np.array([key[3] for key in keys], np.int64)
    high = last_common(recording, indices)
    begins = np.full(len(keys), _NEVER)
    for block in blocks(low, high, 200_000):
        some = {name: index[block] for name, index in vehicles.items()}
        begins[block] = _first_frames(recording, course, some, low[block], high[block])
    roads: dict[int, Road] = {}
    labelled: list[tuple[int | None, tuple[str, ...]]] = []
    for k, frame in enumerate(begins.tolist()):
        indices_by_name = {name: int(index[k]) for name, index in vehicles.items()}
        scene = None
        if frame != _NEVER:
            scene = scene_in(recording, course, indices_by_name, (int(low[k]), int(high[k])), roads)
        labels = tuple(label_of(course, scene, model) for model in questions.settings.drivers)
        labelled.append((None if frame == _NEVER else frame, labels))
    return labelled


def last_common(recording: Recording, vehicles: Integers) -> Integers:
    """Return the last frame that has all vehicles of each trace; ``vehicles``: a row for each of them."""
    last: Integers = recording.last_frame[vehicles].min(axis=0)
    return last


def scene_in(
    recording: Recording,
    course: ManoeuvreTest,
    vehicles: Mapping[str, int],
    frames: tuple[int, int],
    roads: dict[int, Road],
) -> SampledScene:
    """Return the frames of some vehicles as a test for drivers; ``roads``: those known, by direction."""
    way = int(recording.direction[vehicles[course.vehicles[0]]])
    if way not in roads:
        roads[way] = road_of(recording, way)
    batch = gather_one(recording, vehicles, frames, TRACKED)
    return scene_of(batch, roads[way], course.vehicles, Fraction(0))


def label_of(course: ManoeuvreTest, scene: SampledScene | None, driver: str) -> str:
    """Return the label of a model; empty where it says nothing of the manoeuvre.

    ``scene`` is None where the manoeuvre never begins.
    """
    model = next((x for x in course.models if x == driver), None)
    if model is None:
        return ""
    if scene is None:
        return "not covered"
    return RESULTS[replay_samples(scene, course.name, model, course.settings).result]


def _first_frames(
    recording: Recording,
    course: ManoeuvreTest,
    vehicles: Mapping[str, Integers],
    low: Integers,
    high: Integers,
) -> Integers:
    """Return the first frame of each trace in which the course begins; else _NEVER."""
    batch = gather(recording, vehicles, low, high, course.begins.signals)
    begins = course.begins.evaluate(batch, at="all").answers[BEGINS].true
    return np.where(begins.any(axis=0), low + begins.argmax(axis=0), _NEVER)
