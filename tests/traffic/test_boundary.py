"""Measured roads: what the projection is off by, and which matches depend on that."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from planting import plant as plant_fault
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Formula
from roadproof.recordings.evaluate import boundary
from roadproof.recordings.evaluate.boundary import TraceQuestion, uncertain
from roadproof.recordings.evaluate.evaluate import Findings, evaluate_recording
from roadproof.recordings.evaluate.questions import ask, default_settings
from roadproof.recordings.formats.commonroad import read_commonroad
from roadproof.recordings.formats.recording import Floats, Recording, Slack, keep_vehicles
from roadproof.recordings.simulate.plant import Place, plant
from roadproof.recordings.simulate.simulate import Traffic
from roadproof.recordings.simulate.synthetic import simulate
from traffic.drives import braking, cut_in, swerve
from traffic.make_recording import Track, cruise, make_recording
from traffic.planar import commonroad_of
from traffic.sampled import lower_road

RADIUS, LENGTH = 300.0, 300.0


def clothoid(s: Floats, d: Floats) -> tuple[Floats, Floats, Floats]:
    """Straight up to 0 m, then ever more bent to the left, down to a radius of 300 m at 300 m, and on so."""
    at = np.arange(-800.0, 1601.0, 0.25)
    bend = np.clip(at, 0, LENGTH) / (RADIUS * LENGTH)
    heading = np.concatenate(([0.0], np.cumsum((bend[1:] + bend[:-1]) / 2 * 0.25)))
    middle = (heading[1:] + heading[:-1]) / 2
    x, y = (np.concatenate(([0.0], np.cumsum(0.25 * part(middle)))) for part in (np.cos, np.sin))
    turned = np.interp(s, at, heading)
    on_x, on_y = np.interp(s, at, x), np.interp(s, at, y)
    return on_x - d * np.sin(turned), on_y + d * np.cos(turned), turned


@pytest.fixture(scope="module")
def traffic() -> Recording:
    """Lower lanes only, with planted drives; the road is moved so that the middle lane is on the line."""
    recording = simulate(Traffic(seconds=24, lane_width=3.5, section=420), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    for drive, frame in ((cut_in(), 20), (braking(), 200), (swerve(), 380)):
        recording, _ = plant(recording, drive, Place(2, frame, 6, 10.0, right))
    ours = keep_vehicles(recording, recording.direction == 2)
    return replace(ours, first_frame=ours.first_frame - ours.first_frame.min())


def found(recording: Recording) -> Findings:
    return evaluate_recording(recording, ask(default_settings(), recording.rate))


def key(findings: Findings) -> set[tuple[object, ...]]:
    return {
        (m.sv, m.pov, m.pov2, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario)
        for m in findings.matches
    }


@pytest.fixture(scope="module")
def bent(traffic: Recording, tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """The traffic bent along the clothoid, and read back from CommonRoad."""
    road = lower_road(traffic)
    middle = float(sum(road.lanelets[1].d)) / 2
    path = tmp_path_factory.mktemp("bent") / "a.xml"
    path.write_text(
        commonroad_of(traffic, road, lambda s, d: clothoid(s, d - middle), ends=(-500, 1000), step=5.0)
    )
    return read_commonroad(path)


def test_a_bent_drive_gives_the_matches_of_the_original(traffic: Recording, bent: Recording) -> None:
    assert np.diff(bent.s).max() > 0
    shift = bent.s - traffic.s
    assert np.ptp(shift) < 0.25  # chords of 5 m, and boxes that are turned by their motion
    expected, told = found(traffic), found(bent)
    assert {m.scenario for m in expected.matches} >= {1, 3, 4, 8}
    assert key(told) == key(expected)
    assert len(told.traces) == len(expected.traces)


def test_what_is_off_grows_with_the_bend(bent: Recording) -> None:
    """The reference line is the middle lane's: 3.5 m beside it a way is off by 3.5/R."""
    assert bent.slack is not None
    slack = bent.slack
    s = bent.s - bent.length[bent.row_vehicle] / 2 - 500  # of the centre; the line begins at -500 m
    far = s > LENGTH
    assert np.abs(slack.turn[far] - (LENGTH / 2 + s[far] - LENGTH) / RADIUS).max() < 0.02
    assert slack.along.max() < 0.6
    assert np.median(slack.along) < 0.05
    assert slack.off.max() < 7.5
    assert far.sum() > 1000


def test_the_way_between_two_vehicles_is_off_by_no_more_than_said() -> None:
    """On an arc, two vehicles d beside the line and an angle apart: the way between is (R - d) times it."""
    radius = 200.0
    for d in (-7.0, 0.0, 7.0):
        for apart in (0.05, 0.2, 0.4):
            slack = Slack(np.zeros(2), np.zeros(2), np.array([0.1, 0.1 + apart]), np.full(2, abs(d)))
            compare = Compare(t.subtract(t.Signal("s", "POV"), t.Signal("s", "SV")), ">", t.number(0))
            rows = {"SV": np.array([[0]]), "POV": np.array([[1]])}
            said = boundary._off(compare, slack, rows)[0, 0]
            assert abs(radius * apart - (radius - d) * apart) <= said + 1e-9


def gap(least: float) -> Formula:
    ahead = t.subtract(t.Signal("s", "POV"), t.Signal("s", "SV"))
    return Compare(ahead, ">", t.number(Fraction(str(least)), (1, 0)))


def pair(along: float) -> Recording:
    recording = make_recording([Track(2, 0, cruise(0, 30, 10)), Track(2, 0, cruise(20, 30, 10))])
    off = np.full(20, along)
    return replace(recording, slack=Slack(off, off, np.zeros(20), np.zeros(20)))


def is_uncertain(recording: Recording, formula: Formula) -> bool:
    one = np.array([0])
    asked = TraceQuestion(formula, {"SV": one, "POV": one + 1}, one, one + 9, {}, {}, "truncated")
    return bool(uncertain(recording, asked)[0])


@pytest.mark.parametrize(
    ("formula", "sure", "unsure"),
    [
        (gap(19), 0.49, 0.51),
        (f.Not(gap(21)), 0.49, 0.51),
        (f.Always(f.Interval(t.number(0), t.number(Fraction(1, 5), (0, 1))), gap(18)), 0.9, 1.1),
        (f.conjunction(gap(19), f.Not(gap(20.4))), 0.15, 0.25),
        (Compare(t.Signal("v_lon", "SV"), ">", t.number(29, (1, -1))), 9.0, math.inf),
        (Compare(t.Maximum((t.Signal("s", "SV"), t.number(0))), ">=", t.number(0)), 0.0, math.nan),
    ],
)
def test_by_hand(formula: Formula, sure: float, unsure: float) -> None:
    """The gap is 20 m at all times, and each of two vehicles may be off."""
    if math.isnan(unsure):
        assert is_uncertain(pair(0.0), formula)  # no sum of places: nothing is known
        return
    assert not is_uncertain(pair(sure), formula)
    if math.isfinite(unsure):
        assert is_uncertain(pair(unsure), formula)


def moved(recording: Recording, seed: int) -> Recording:
    """Every place moved by what it may be off by, ahead or back at random: each sample, or each vehicle."""
    random = np.random.default_rng(seed)
    assert recording.slack is not None
    if seed % 2:
        sign = random.choice([-1, 1], recording.vehicles)[recording.row_vehicle]
        return replace(recording, s=recording.s + sign * recording.slack.along)
    along, across = (
        random.choice([-1, 1], len(recording.s)) * x for x in (recording.slack.along, recording.slack.across)
    )
    return replace(recording, s=recording.s + along, d=recording.d + across)


def test_sure_matches_stay_when_places_move(traffic: Recording) -> None:
    """And of the uncertain ones some do not. The cut of the trace is kept, as the answer is about it."""
    off = np.full(len(traffic.s), 0.3)
    measured = replace(traffic, slack=Slack(off, off, np.zeros_like(off), np.zeros_like(off)))
    settings = replace(default_settings(), min_danger=(Fraction(0),))
    questions = ask(settings, 25)
    matches = [m for m in evaluate_recording(measured, questions).matches if m.pov2 is None]
    sure = [m for m in matches if not m.uncertain]
    unsure = [m for m in matches if m.uncertain]
    assert len(sure) > 5
    assert len(unsure) > 3
    index = {int(number): k for k, number in enumerate(traffic.vehicle_id)}
    lost = set()
    (monitor,) = questions.pairs
    for seed in range(12):
        other = moved(measured, seed)
        for m in matches:
            pair = sorted((index[m.sv], index[m.pov]))
            role = "first" if index[m.sv] == pair[0] else "second"
            (asked,) = [
                x for x in monitor.formulas if (x.set_name, x.number, x.sv) == (m.set_name, m.scenario, role)
            ]
            one = {name: np.array([v]) for name, v in zip(("SV", "POV"), pair, strict=True)}
            lanes = {
                name: traffic.lane[traffic.start[v] + m.start_frame - traffic.first_frame[v]]
                for name, v in (("L", one["SV"]), ("L1", one["POV"]))
            }
            low, high = np.array([m.start_frame]), np.array([m.end_frame])
            batch = boundary.gather(other, one, low, high, monitor.signals, lanes, questions.lane_atoms)
            if not monitor.evaluate(batch).answers[asked].true[0]:
                lost.add(m)
    assert not lost & set(sure)
    assert lost & set(unsure)


def test_a_wrong_polarity_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted fault: a comparison that hurts is taken as one that helps."""
    formula = f.Not(gap(21))
    assert is_uncertain(pair(0.6), formula)
    plant_fault(
        monkeypatch,
        boundary._BoundedFormula,
        "_made",
        "self._visit(body, not helps)",
        "self._visit(body, helps)",
    )
    assert not is_uncertain(pair(0.6), formula)


def test_recordings_in_road_coordinates_are_sure(traffic: Recording) -> None:
    told = found(traffic)
    assert not any(m.uncertain for m in told.matches)
    assert not any("depend" in note for note in told.notes)
