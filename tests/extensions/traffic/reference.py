"""semantics §7 read out slowly: every pair, every triple, every sample, with the recursive evaluator.

Shares with the program only the recording, the formulas and nothing of how traces are found or cut.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from itertools import combinations

from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings
from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.library.elaborate import read_claim
from roadproof.logic.formula import Formula, transform
from roadproof.logic.rewrite import with_values, without_names

Row = tuple[int, int, int | None, str, int, int, int, str, int]
"""sv, pov, pov2, lane, start_frame, end_frame, min_danger, set, scenario."""


class Reference:
    def __init__(self, recording: Recording, settings: EvaluationSettings) -> None:
        self.recording, self.settings = recording, settings
        self.pool: dict[Formula, Formula] = {}
        self.formulas: dict[tuple[str, str, int], Formula] = {}
        self.frames = [
            range(int(a), int(b) + 1)
            for a, b in zip(recording.first_frame, recording.last_frame, strict=True)
        ]
        self.eligible = [v for v in range(recording.vehicles) if recording.kind[v] in settings.classes]

    def formula(self, set_name: str, text: str, k: int) -> Formula:
        key = (set_name, text, k)
        if key not in self.formulas:
            spec = self.settings.library.select(set_name, self.settings.options)
            values = {**self.settings.values, "minDanger": self.settings.min_danger[k]}
            formula = without_names(with_values(read_claim(spec, text).formula, values))
            # One object for equal sub-formulas: telling them apart is most of the evaluator's work.
            self.formulas[key] = transform(formula, lambda x: self.pool.setdefault(x, x))
        return self.formulas[key]

    def common(self, *vehicles: int) -> range:
        """The frames that all share; none for different directions."""
        if len({int(self.recording.direction[v]) for v in vehicles}) > 1:
            return range(0)
        low = max(self.frames[v].start for v in vehicles)
        return range(low, min(self.frames[v].stop for v in vehicles))

    def trace(self, frames: range, vehicles: dict[str, int], lanes: dict[str, int]) -> SampledTrace:
        r = self.recording
        rows = {n: [int(r.start[v] + f - r.first_frame[v]) for f in frames] for n, v in vehicles.items()}
        signals = {
            (x, n): [float(getattr(r, x)[k]) for k in at]
            for n, at in rows.items()
            for x in ("s", "d", "v_lon", "v_lat", "a_lon")
        }
        sizes = {(x, n): float(getattr(r, x)[v]) for n, v in vehicles.items() for x in ("length", "width")}
        return SampledTrace(
            Fraction(1, r.rate), len(frames), signals, sizes, dict(self.given(rows, vehicles, lanes))
        )

    def given(
        self, rows: dict[str, list[int]], vehicles: dict[str, int], lanes: dict[str, int]
    ) -> Iterator[tuple[Formula, list[bool]]]:
        """Occupancy in whole hundredths of a metre; every lane of a straight recording is main road."""
        r, base = self.recording, self.settings.sets[0]
        bands = [(lane.direction, *(round(100 * x) for x in lane.d or ())) for lane in r.lanes]
        for name, at in rows.items():
            vehicle = vehicles[name]
            left = [round(100 * float(r.d[k])) for k in at]
            width, way = round(100 * float(r.width[vehicle])), r.direction[vehicle]
            inside = [
                [way == band[0] and d > band[1] and d - width < band[2] for d in left] for band in bands
            ]
            anywhere = [any(column) for column in zip(*inside, strict=True)]
            yield self.formula(base, f"onMainRoad({name})", 0), anywhere
            for lane, k in lanes.items():
                beside = [
                    i
                    for i, band in enumerate(bands)
                    if band[0] == bands[k][0] and i != k and {band[1], band[2]} & {bands[k][1], bands[k][2]}
                ]
                yield self.formula(base, f"atLane({name}, {lane})", 0), inside[k]
                near = [any(inside[i][j] for i in beside) for j in range(len(at))]
                text = f"some M in adjacentLanes({lane}): atLane({name}, M)"
                yield self.formula(base, text, 0), near

    def lane_at(self, vehicle: int, frame: int) -> int:
        """The band that holds the centre of the box."""
        r = self.recording
        row = int(r.start[vehicle] + frame - r.first_frame[vehicle])
        centre = 2 * round(100 * float(r.d[row])) - round(100 * float(r.width[vehicle]))
        for k, lane in enumerate(r.lanes):
            assert lane.d is not None
            low, high = (200 * x for x in lane.d)
            if lane.direction == r.direction[vehicle] and round(low) <= centre < round(high):
                return k
        raise AssertionError("off the road")

    def cuts(
        self, frames: range, dangers: TraceReader, *safe: TraceReader
    ) -> tuple[int | None, list[int | None]]:
        """Start frame, and the end frame for each minDanger; None where there is none."""
        settings, text = self.settings, "initSafe(SV, POV)"
        init = self.formula(settings.sets[0], text, 0)
        start = next((k for k in range(len(frames)) if all(x.holds(init, k, "strong") for x in safe)), None)
        ends: list[int | None] = []
        for k, min_danger in enumerate(settings.min_danger):
            danger = self.formula(settings.sets[0], "danger(SV, POV)", k)
            steps = int(min_danger * self.recording.rate)
            holding = [j for j in range(start or 0, len(frames)) if dangers.holds(danger, j, "strong")]
            ends.append(frames[holding[-1]] + steps if start is not None and holding else None)
        return (None if start is None else frames[start]), ends

    @cached_property
    def violating(self) -> list[tuple[int, int, range, TraceReader]]:
        """Pairs of one direction that violate the RSS distance at some time."""
        return list(self._pairs())

    def _pairs(self) -> Iterator[tuple[int, int, range, TraceReader]]:
        violation = self.formula(self.settings.sets[0], "rssViolation(SV, POV)", 0)
        for a, b in combinations(self.eligible, 2):
            frames = self.common(a, b)
            if frames and self.ever_near(a, b, frames):
                reading = TraceReader(self.trace(frames, {"SV": a, "POV": b}, {}))
                if any(reading.holds(violation, k, "strong") for k in range(len(frames))):
                    yield a, b, frames, reading

    def place(self, vehicle: int, frame: int) -> float:
        r = self.recording
        return float(r.s[r.start[vehicle] + frame - r.first_frame[vehicle]])

    def ever_near(self, a: int, b: int, frames: range) -> bool:
        """Below 50 m/s no RSS distance and length together exceed 300 m: 30 + 0.9 + 53²/12 + 19."""
        return any(abs(self.place(a, f) - self.place(b, f)) < 300 for f in frames)

    def ever_in_order(self, frames: range, *vehicles: int) -> bool:
        """Scenario 2 begins with SV behind POV1 behind POV2, in every set."""
        return any(
            self.place(vehicles[0], f) < self.place(vehicles[1], f) < self.place(vehicles[2], f)
            for f in frames
        )

    def matches(self) -> Iterator[Row]:
        for a, b, frames, reading in self.violating:
            start, ends = self.cuts(frames, reading, reading)
            for k, end in enumerate(ends):
                if start is not None and end is not None:
                    yield from self.match_pair(a, b, start, end, k)
                    yield from self.match_pair(b, a, start, end, k)
        if 2 in self.settings.scenarios:
            for a, b, _, _ in self.violating:
                yield from self.match_triples(a, b)
                yield from self.match_triples(b, a)

    def match_pair(self, sv: int, pov: int, start: int, end: int, k: int) -> Iterator[Row]:
        lanes = {"L": self.lane_at(sv, start), "L1": self.lane_at(pov, start)}
        reading = TraceReader(self.trace(range(start, end + 1), {"SV": sv, "POV": pov}, lanes))
        ids = self.recording.vehicle_id
        for set_name in self.settings.sets:
            for number in self.settings.scenarios:
                if number == 2:
                    continue
                lane = "L1" if number == 7 else "L"
                formula = self.formula(set_name, f"scenario_{number}(SV, POV, {lane})", k)
                if reading.holds(formula, 0, "strong"):
                    name = self.recording.lanes[lanes[lane]].name
                    yield int(ids[sv]), int(ids[pov]), None, name, start, end, k, set_name, number

    def match_triples(self, sv: int, pov2: int) -> Iterator[Row]:
        r, ids = self.recording, self.recording.vehicle_id
        for pov1 in self.eligible:
            frames = self.common(sv, pov1, pov2)
            if pov1 in (sv, pov2) or not self.ever_in_order(frames, sv, pov1, pov2):
                continue
            near, far = (TraceReader(self.trace(frames, {"SV": sv, "POV": x}, {})) for x in (pov1, pov2))
            start, ends = self.cuts(frames, far, near, far)
            for k, end in enumerate(ends):
                if start is None or end is None:
                    continue
                lane = self.lane_at(sv, start)
                names = {"SV": sv, "POV1": pov1, "POV2": pov2}
                reading = TraceReader(self.trace(range(start, end + 1), names, {"L": lane}))
                for set_name in self.settings.sets:
                    formula = self.formula(set_name, "scenario_2(SV, POV1, POV2, L)", k)
                    if reading.holds(formula, 0, "strong"):
                        who = int(ids[sv]), int(ids[pov1]), int(ids[pov2])
                        yield *who, r.lanes[lane].name, start, end, k, set_name, 2

    def traces(self) -> Iterator[tuple[int, int, int, int, int]]:
        """first, second, min_danger, start_frame, end_frame of every disturbance trace."""
        ids = self.recording.vehicle_id
        for a, b, frames, reading in self.violating:
            start, ends = self.cuts(frames, reading, reading)
            for k, end in enumerate(ends):
                if start is not None and end is not None:
                    yield int(ids[a]), int(ids[b]), k, start, end
