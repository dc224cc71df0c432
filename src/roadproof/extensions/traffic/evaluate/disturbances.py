"""Finds danger between two vehicles: the filter and the cuts of semantics §7.

A trace starts at the first sample where initSafe holds, its whole window inside the common frames,
and ends with the last sample of the last danger interval after that.
"""

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from roadproof.extensions.traffic.evaluate.questions import SAFE, VIOLATION, DangerKey, EvaluationQuestions
from roadproof.extensions.traffic.evaluate.traces import blocks, gather, gather_rows
from roadproof.extensions.traffic.formats.pairs import Pairs, Triples, all_moments, common_pairs, near_moments
from roadproof.extensions.traffic.formats.recording import Bools, Integers, Recording, offsets
from roadproof.library.scenarios import PAIR
from roadproof.semantics.sampled.batch import Batch

NEVER = np.iinfo(np.int64).max


@dataclass(frozen=True)
class Disturbances:
    """Pairs with an rssViolation in some common frame, in order of (first, second).

    ``start`` is the frame where the trace starts (NEVER if nowhere), ``end[k]`` the frame where it
    ends under the k-th minDanger (-1 where danger does not arise). ``next_safe`` and
    ``last_danger[k]`` hold, for each common frame of each pair (pair p has entries
    ``offset[p]:offset[p + 1]``), the first frame from there on where initSafe holds (NEVER if none),
    and the last frame up to there where danger begins (-1 if none).
    """

    meeting: Pairs
    pairs: Pairs
    start: Integers
    end: tuple[Integers, ...]
    offset: Integers
    next_safe: Integers
    last_danger: tuple[Integers, ...]

    def choose(self, selected: Bools) -> "Disturbances":
        """Return the disturbances of the selected pairs."""
        if selected.all():
            return self
        rows = np.flatnonzero(np.repeat(selected, self.pairs.samples))
        pairs = self.pairs.choose(selected)
        return Disturbances(
            self.meeting,
            pairs,
            self.start[selected],
            tuple(x[selected] for x in self.end),
            offsets(pairs.samples),
            self.next_safe[rows],
            tuple(x[rows] for x in self.last_danger),
        )


def find_disturbances(recording: Recording, questions: EvaluationQuestions) -> Disturbances:
    """The disturbances between vehicles of the classes that the settings name."""
    meeting = common_pairs(recording, np.isin(recording.kind, questions.settings.classes))
    pair, frame = _violations(recording, questions, meeting)
    violating, begin = np.unique(pair, return_index=True)
    pairs, hits = meeting.choose(violating), np.append(begin, len(pair))
    offset = offsets(pairs.samples)
    next_safe = np.full(offset[-1], NEVER)
    last_danger = tuple(np.full(offset[-1], -1) for _ in questions.danger_steps)
    for index in blocks(pairs.low, pairs.high, 200_000):
        block = pairs.choose(index)
        here, within = _spread_hits(hits, index)
        truth = np.zeros((int(block.samples.max()), len(block)), bool)
        truth[frame[here] - block.low[within], within] = True
        true = questions.danger.holds(_batch(recording, questions, block, truth), at="all")
        sample = np.arange(len(truth))[:, None]
        inside = np.flatnonzero(sample < block.samples)
        frames = sample + block.low
        place = (sample + offset[:-1][index]).take(inside)
        next_safe[place] = _next(true[SAFE], frames).take(inside)
        for k, last in enumerate(last_danger):
            last[place] = _last(true[DangerKey(k)], frames).take(inside)
    start = next_safe[offset[:-1]]
    end = []
    for steps, danger in zip(questions.danger_steps, last_danger, strict=True):
        final = danger[offset[1:] - 1]
        end.append(np.where((start != NEVER) & (final >= start), final + steps, -1))
    return Disturbances(meeting, pairs, start, tuple(end), offset, next_safe, last_danger)


def _violations(
    recording: Recording, questions: EvaluationQuestions, meeting: Pairs
) -> tuple[Integers, Integers]:
    """Return where there is an rssViolation: the place in ``meeting`` and the frame, in order of pairs."""
    if not questions.violation_is_state:
        return _violations_in_time(recording, questions, meeting)
    if questions.reach is None:
        parts = all_moments(recording, meeting)
    else:
        parts = near_moments(recording, meeting, questions.reach)
    pairs, frames = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for moments in parts:
        if not len(moments):
            continue
        of_pair = (x.take(moments.pair) for x in (meeting.first, meeting.second))
        vehicles = dict(zip(PAIR, of_pair, strict=True))
        rows = dict(zip(PAIR, (moments.first[None], moments.second[None]), strict=True))
        lengths = np.ones(len(moments), np.int64)
        batch = gather_rows(recording, vehicles, rows, lengths, questions.violation.signals)
        true = np.flatnonzero(questions.violation.holds(batch)[VIOLATION])
        pairs.append(moments.pair.take(true))
        frames.append(moments.frame.take(true))
    return np.concatenate(pairs), np.concatenate(frames)


def _violations_in_time(
    recording: Recording, questions: EvaluationQuestions, meeting: Pairs
) -> tuple[Integers, Integers]:
    """Return the violations (see ``_violations``) of a formula with temporal operators."""
    pairs, frames = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for index in blocks(meeting.low, meeting.high, 400_000):
        block = meeting.choose(index)
        batch = gather(recording, block.vehicles, block.low, block.high, questions.violation.signals)
        sample, trace = np.nonzero(questions.violation.holds(batch, at="all")[VIOLATION])
        pairs.append(index[trace])
        frames.append(sample + block.low[trace])
    pair, frame = np.concatenate(pairs), np.concatenate(frames)
    order = np.lexsort((frame, pair))
    return pair[order], frame[order]


def _spread_hits(hits: Integers, index: Integers) -> tuple[Integers, Integers]:
    """The places ``hits[k]`` … ``hits[k + 1]`` of each k of ``index``, and where in ``index`` k is."""
    counts = hits[index + 1] - hits[index]
    within = np.repeat(np.arange(len(index)), counts)
    return np.arange(len(within)) + np.repeat(hits[index] - offsets(counts)[:-1], counts), within


def _batch(recording: Recording, questions: EvaluationQuestions, block: Pairs, truth: Bools) -> Batch:
    """The traces of pairs, with the ``truth`` of an rssViolation where that is a matter of one moment."""
    given = {questions.violation.formulas[VIOLATION]: truth} if questions.violation_is_state else {}
    if questions.danger.rests_on(given):
        return Batch(1 / Fraction(recording.rate), block.samples, given=given)
    batch = gather(recording, block.vehicles, block.low, block.high, questions.danger.signals)
    return replace(batch, given={**batch.given, **given})


def _next(truth: Bools, frames: Integers) -> Integers:
    """Return for each sample the frame of the first true sample from there on, down the rows."""
    return np.minimum.accumulate(np.where(truth, frames, NEVER)[::-1])[::-1]


def _last(truth: Bools, frames: Integers) -> Integers:
    """Return for each sample the frame of the last true sample up to there, down the rows."""
    return np.maximum.accumulate(np.where(truth, frames, -1))


@dataclass(frozen=True)
class CutTriples:
    """Triples in which danger between SV and POV2 arises; ``end`` as in Disturbances."""

    triples: Triples
    start: Integers
    end: tuple[Integers, ...]

    def choose(self, selected: Bools) -> "CutTriples":
        return CutTriples(
            self.triples.choose(selected), self.start[selected], tuple(x[selected] for x in self.end)
        )


def cut_triples(questions: EvaluationQuestions, disturbances: Disturbances, triples: Triples) -> CutTriples:
    """Return where each triple starts and ends; those in which no danger arises are dropped.

    The start is the first frame where initSafe holds for SV with both POVs, windows inside the
    frames that all three share (semantics §7).
    """
    near, far = (
        _Lookup(disturbances, triples.sv, triples.pov1),
        _Lookup(disturbances, triples.sv, triples.pov2),
    )
    latest = triples.high - questions.safe_steps
    start, waiting = triples.low.copy(), np.arange(len(triples))
    while len(waiting):
        now = start[waiting]
        later = far.next_safe(waiting, near.next_safe(waiting, now, latest), latest)
        start[waiting] = later
        waiting = waiting[(later != now) & (later != NEVER)]
    starts = start != NEVER
    ends = []
    for k, steps in enumerate(questions.danger_steps):
        final = far.last_danger(k, triples.high - steps)
        ends.append(np.where(starts & (final >= start), final + steps, -1))
    arises = np.logical_or.reduce([end >= 0 for end in ends])
    return CutTriples(triples, start, tuple(ends)).choose(arises)


class _Lookup:
    """Entries of Disturbances for pairs given one by one; a pair that never violates is always safe."""

    def __init__(self, disturbances: Disturbances, one: Integers, other: Integers) -> None:
        pairs = disturbances.pairs
        self.found = disturbances
        size = 1 + int(max(one.max(initial=0), other.max(initial=0), pairs.second.max(initial=0)))
        keys = pairs.first * size + pairs.second
        pair_keys = np.minimum(one, other) * size + np.maximum(one, other)
        place = np.searchsorted(keys, pair_keys)
        at = np.minimum(place, max(len(keys) - 1, 0))
        self.known = keys[at] == pair_keys if len(keys) else np.zeros(len(pair_keys), bool)
        self.low = pairs.low[at] if len(keys) else np.zeros(len(pair_keys), np.int64)
        self.shift = disturbances.offset[at] - self.low if len(keys) else self.low

    def next_safe(self, index: Integers, frame: Integers, latest: Integers) -> Integers:
        """The first safe frame from ``frame`` to ``latest`` for the pairs at ``index``; NEVER if none."""
        possible = frame <= latest[index]  # false for NEVER
        known = possible & self.known[index]
        later = frame.copy()
        later[known] = self.found.next_safe[self.shift[index][known] + frame[known]]
        later[~possible | (later > latest[index])] = NEVER
        return later

    def last_danger(self, k: int, frame: Integers) -> Integers:
        """The last frame up to ``frame`` where danger begins, -1 if none; frames before the pair give -1."""
        inside = self.known & (frame >= self.low)
        last = np.full(len(frame), -1)
        last[inside] = self.found.last_danger[k][(self.shift + frame)[inside]]
        return last
