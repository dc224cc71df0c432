"""What becomes of matches under driver models: when a manoeuvre begins in one, and whether SV can prevent it.

A manoeuvre begins at the first sample of the match's trace at which the formula of its beginning holds, up
to the sample at which danger first begins. The state there is what the models are asked about: POV is
supposed to go on as it moves there, whatever it does later in the recording.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal, TypeAlias

import numpy as np

from roadproof.library.scenarios import PAIR, endangered
from roadproof.recordings.evaluate.courses import BEGINS, Course
from roadproof.recordings.evaluate.matching import Match
from roadproof.recordings.evaluate.questions import Danger, Questions
from roadproof.recordings.evaluate.traces import blocks, gather
from roadproof.recordings.formats.recording import Bools, Integers, Recording

Label: TypeAlias = Literal["preventable", "unpreventable", "not foreseen"]
LABELS: tuple[Label, ...] = ("preventable", "unpreventable", "not foreseen")
_NEVER = -1

# What matches have in common where a course is the same: SV, POV, POV2, first and last frame, minDanger.
_Key: TypeAlias = tuple[int, int, int | None, int, int, int]


def foretell(recording: Recording, questions: Questions, matches: Sequence[Match]) -> list[Match]:
    """The matches in their order, those of which models speak with ``begun`` and ``labels``."""
    if not questions.courses:
        return [*matches]
    found: dict[tuple[int, _Key], tuple[int | None, tuple[str, ...]]] = {}
    place = {number: k for k, number in enumerate(recording.vehicle_id.tolist())}
    of = {number: k for k, course in enumerate(questions.courses) for number in course.scenarios}
    for k, course in enumerate(questions.courses):
        keys = list(dict.fromkeys(_key(x) for x in matches if of.get(x.scenario) == k))
        if keys:
            for key, label in zip(keys, _labels(recording, questions, course, keys, place), strict=True):
                found[k, key] = label
    asked = ((of.get(x.scenario, -1), _key(x)) for x in matches)
    labelled = zip(matches, (found.get(key, (None, ())) for key in asked), strict=True)
    return [replace(x, begun=begun, labels=labels) for x, (begun, labels) in labelled]


def _key(match: Match) -> _Key:
    return match.sv, match.pov, match.pov2, match.start_frame, match.end_frame, match.min_danger


def _labels(
    recording: Recording, questions: Questions, course: Course, keys: Sequence[_Key], place: Mapping[int, int]
) -> list[tuple[int | None, tuple[str, ...]]]:
    """For each trace the frame at which the course begins, and a label for each driver that is asked for."""
    who = [[place[x] for x in key[:3] if x is not None] for key in keys]
    vehicles = dict(zip(course.vehicles, np.array(who, np.int64).T, strict=True))
    low, high, danger = np.array([key[3:] for key in keys], np.int64).T
    begun = np.full(len(keys), _NEVER)
    for block in blocks(low, high, 200_000):
        some = {name: index[block] for name, index in vehicles.items()}
        begun[block] = _begun(recording, questions, course, some, low[block], high[block], danger[block])
    collides = _collides(recording, course, vehicles, begun)
    return [
        (
            None if frame == _NEVER else frame,
            tuple(_label(frame, collides.get(x), k) for x in questions.settings.drivers),
        )
        for k, frame in enumerate(begun.tolist())
    ]


def _label(frame: int, collides: Bools | None, k: int) -> str:
    """Empty where the model says nothing of the manoeuvre."""
    if collides is None:
        return ""
    return LABELS[2] if frame == _NEVER else LABELS[int(collides[k])]


def _begun(
    recording: Recording,
    questions: Questions,
    course: Course,
    vehicles: Mapping[str, Integers],
    low: Integers,
    high: Integers,
    danger: Integers,
) -> Integers:
    """The first frame of each trace in which the course begins, up to where danger does; else _NEVER."""
    batch = gather(recording, vehicles, low, high, course.begins.signals)
    begins = course.begins.evaluate(batch, at="all").answers[BEGINS].true
    pair = {name: vehicles[x] for name, x in zip(PAIR, endangered(course.vehicles), strict=True)}
    batch = gather(recording, pair, low, high, questions.danger.signals)
    answers = questions.danger.evaluate(batch, at="all").answers
    arises = np.zeros(begins.shape, bool)
    for k in range(len(questions.danger_steps)):
        arises[:, danger == k] = answers[Danger(k)].true[:, danger == k]
    before = np.cumsum(arises, axis=0) - arises == 0
    hits = begins & before
    return np.where(hits.any(axis=0), low + hits.argmax(axis=0), _NEVER)


def _collides(
    recording: Recording, course: Course, vehicles: Mapping[str, Integers], begun: Integers
) -> dict[str, Bools]:
    """Whether each model that speaks of the course collides; False where it never begins."""
    there = np.flatnonzero(begun != _NEVER)
    found = {model: np.zeros(len(begun), bool) for model in course.collides.formulas}
    if len(there):
        some = {name: index[there] for name, index in vehicles.items()}
        batch = gather(recording, some, begun[there], begun[there], course.collides.signals)
        for model, answer in course.collides.evaluate(batch).answers.items():
            found[model][there] = answer.true
    return found
