"""The formulas of driver.spec against a simulation that steps: they differ within a step's band only."""

import random
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.drivers import stepping
from extensions.drivers.fuzzy_again import first_difference, motion
from extensions.drivers.labels import labels
from extensions.drivers.read import bound, boundary, specification, values
from extensions.drivers.test_preventable import copy, with_changed
from planting import plant
from roadproof.evidence.judged import judge_file
from roadproof.extensions.drivers import stepped
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import drive_of
from roadproof.extensions.drivers.fuzzy import Controller, Scale, scale_of
from roadproof.extensions.drivers.lines import SIDES
from roadproof.extensions.drivers.manoeuvres import CUT_IN, CUT_OUT, DECELERATION, KMH, MANOEUVRES, Plane
from roadproof.extensions.drivers.models import models_for
from roadproof.extensions.drivers.preventable.beside import judged_drive
from roadproof.extensions.drivers.stepped import course_of, labels_of, places_of, spans_of
from roadproof.frontends.cli.main import main

RATE = 1000
CASES = 20_000
RAMP_AND_ROUNDING = 1e-6


def random_cut_ins(cases: int, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.5, 40, cases) * rng.choice([1.0, 0.15], cases, p=[0.8, 0.2])
    return {
        "Ve0": v,
        "dV0": v * rng.uniform(0, 1, cases),
        "Vy": rng.uniform(0.2, 3, cases),
        "dx0": rng.uniform(0, 60, cases) * rng.choice([1.0, 0.2], cases),
        "dy0": rng.uniform(0, 2, cases),
    }


def onset_of(reading: str, x: dict[str, np.ndarray]) -> np.ndarray:
    return {
        "time": stepping.WANDER / x["Vy"] + stepping.EVALUATION,
        "distance": (stepping.WANDER + stepping.DRIFT) / x["Vy"],
        "overlap": x["dy0"] / x["Vy"],
    }[reading] + stepping.DELAY


def differing(found: np.ndarray, outcome: stepping.Outcome, band: np.ndarray) -> tuple[int, int]:
    """Labels that differ, and those of them that are farther from the boundary than a step leads."""
    other = found != outcome.collided
    return int(other.sum()), int((other & (outcome.nearest > band)).sum())


def check_cut_ins(reading: str, cases: int, seed: int) -> tuple[int, float]:
    x = random_cut_ins(cases, seed)
    formula = boundary("cut-in", "careful", cc_perception=reading)
    found = labels(CUT_IN, {"it": formula}, x)["it"]
    drive = stepping.careful(onset_of(reading, x))
    w = x["Ve0"] - x["dV0"]
    outcome = stepping.step_cut_in(
        x["Ve0"], w, x["dx0"], np.full(cases, 8.6), x["dy0"], x["Vy"], drive, RATE, 21
    )
    count, outside = differing(found, outcome, 2 * (x["Ve0"] + stepping.FULL) / RATE)
    assert outside == 0
    return count, float(found.mean())


@pytest.mark.parametrize("reading", ["time", "distance", "overlap"])
def test_cut_ins(reading):
    count, share = check_cut_ins(reading, 3_000, 5)
    assert count < 10
    assert 0.1 < share < 0.9


def test_many_cut_ins():
    count, share = check_cut_ins("time", CASES, 6)
    assert count < 0.002 * CASES
    assert 0.1 < share < 0.9


def check_decelerations(cases: int, seed: int) -> tuple[int, float]:
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.1, 40, cases) * rng.choice([1.0, 0.1], cases, p=[0.8, 0.2])
    faster = np.where(rng.random(cases) < 0.5, 0.0, np.minimum(rng.normal(0, 5, cases), v))
    x = {
        "Ve0": v,
        "dV0": faster,
        "Gx": rng.uniform(0.1, 12, cases),
        "dx0": rng.uniform(0, 60, cases) * rng.choice([1.0, 0.1], cases),
    }
    found = labels(DECELERATION, {"it": boundary("deceleration", "careful")}, x)["it"]
    onset = np.full(cases, stepping.EVALUATION + stepping.DELAY)
    outcome = stepping.step_deceleration(v, v - faster, x["dx0"], x["Gx"], stepping.careful(onset), RATE, 12)
    # A POV that still moves after 12 s could be hit later; SV stands by then.
    count, outside = differing(found, outcome, 2 * (v + stepping.FULL) / RATE)
    assert outside == 0
    return count, float(found.mean())


def test_decelerations_with_any_delay():
    """Also where POV brakes harder than SV can, and where one of them stands within the ramp."""
    cases = 400
    for delay, seed in ((0.0, 21), (0.2, 22), (0.6, 23)):
        rng = np.random.default_rng(seed)
        v = rng.uniform(0, 12, cases) * rng.choice([1.0, 0.1, 0.0], cases, p=[0.5, 0.3, 0.2])
        w = rng.uniform(0, 12, cases) * rng.choice([1.0, 0.1], cases)
        braking = rng.uniform(0.5, 20, cases)
        gap = rng.uniform(0, 6, cases) * rng.choice([1.0, 0.02], cases)
        formula = bound(
            "gainsBraking(v_lon(SV), v_lon(POV), -a_lon(POV), gapTo(SV, POV), "
            f"{delay} s, cc_ramp, cc_braking)"
        )
        x = {"Ve0": v, "dV0": v - w, "Gx": braking, "dx0": gap}
        found = labels(DECELERATION, {"it": formula}, x)["it"]
        drive = stepping.careful(np.full(cases, delay))
        outcome = stepping.step_deceleration(v, w, gap, braking, drive, RATE, 26)
        _, outside = differing(found, outcome, 2 * (v + stepping.FULL) / RATE)
        assert outside == 0
        assert 0.1 < found.mean() < 0.9


def test_decelerations():
    count, share = check_decelerations(3_000, 7)
    assert count < 10
    assert 0.1 < share < 0.9


def test_many_decelerations():
    count, share = check_decelerations(CASES, 8)
    assert count < 0.002 * CASES
    assert 0.1 < share < 0.9


def check_cut_outs(cases: int, seed: int) -> tuple[int, float]:
    rng = np.random.default_rng(seed)
    x = {
        "Ve0": rng.uniform(1, 45, cases),
        "Vf0": np.zeros(cases),
        "Vy": rng.uniform(0.1, 3, cases),
        "headway": rng.uniform(0.5, 3, cases),
        "dx0_f": rng.uniform(0, 100, cases),
    }
    found = labels(CUT_OUT, {"it": boundary("cut-out", "careful")}, x)["it"]
    onset = stepping.WANDER / x["Vy"] + stepping.EVALUATION + stepping.DELAY
    way = stepping.stopping_way(x["Ve0"], stepping.careful(onset), RATE, 13)
    left = x["headway"] * x["Ve0"] + 4.3 + x["dx0_f"] - way
    other = found != (left < 0)
    assert not (other & (np.abs(left) > 2 * (x["Ve0"] + stepping.FULL) / RATE)).any()
    return int(other.sum()), float(found.mean())


def test_cut_outs():
    count, share = check_cut_outs(3_000, 9)
    assert count < 10
    assert 0.02 < share < 0.9


def test_many_cut_outs():
    count, share = check_cut_outs(CASES, 10)
    assert count < 0.002 * CASES
    assert 0.02 < share < 0.9


@pytest.mark.parametrize(("model", "full"), [("r157", 6.0), ("eu1426", 6.0)])
def test_regulations(model, full):
    x = random_cut_ins(3_000, 11)
    found = labels(CUT_IN, {"it": boundary("cut-in", model)}, x)["it"]
    later = {"r157": 0.35, "eu1426": 0.25}[model]
    onset = (x["dy0"] / 2 + 0.3) / x["Vy"] + later
    drive = stepping.at_once(onset, full)
    outcome = stepping.step_cut_in(
        x["Ve0"], x["Ve0"] - x["dV0"], x["dx0"], np.full(3_000, 8.6), x["dy0"], x["Vy"], drive, RATE, 21
    )
    _, outside = differing(found, outcome, 3 * (x["Ve0"] + full) / RATE)
    assert outside == 0


@pytest.mark.parametrize("gate", ["before_perception", "before_delay"])
def test_gates(gate):
    x = random_cut_ins(3_000, 12)
    found = labels(CUT_IN, {"it": boundary("cut-in", "careful", cc_gate=gate)}, x)["it"]
    onset = stepping.gated_onset(x, gate)
    onset = np.where(np.isfinite(onset), onset, 1e9)
    outcome = stepping.step_cut_in(
        x["Ve0"],
        x["Ve0"] - x["dV0"],
        x["dx0"],
        np.full(3_000, 8.6),
        x["dy0"],
        x["Vy"],
        stepping.careful(onset),
        RATE,
        40,
    )
    late = onset > 30  # the simulation ends before such a drive does
    other = (found != outcome.collided) & ~late
    assert not (other & (outcome.nearest > 2 * (x["Ve0"] + stepping.FULL) / RATE)).any()


def test_a_planted_fault_shows():
    """With half the ramp the labels differ far from the boundary, too."""
    x = random_cut_ins(3_000, 13)
    found = labels(CUT_IN, {"it": boundary("cut-in", "careful")}, x)["it"]
    drive = stepping.careful(onset_of("time", x) - 0.15)
    outcome = stepping.step_cut_in(
        x["Ve0"], x["Ve0"] - x["dV0"], x["dx0"], np.full(3_000, 8.6), x["dy0"], x["Vy"], drive, RATE, 21
    )
    _, outside = differing(found, outcome, 2 * (x["Ve0"] + stepping.FULL) / RATE)
    assert outside > 20


# --- Drives of the fuzzy safety model: recomputed step by step, judged, and told as what they are ---


def reading() -> DriverSettings:
    home = specification()
    return DriverSettings(values(), home.options)


def some_values(manoeuvre: str, count: int, seed: int) -> list[dict[str, F]]:
    rng = random.Random(seed)

    def number(low: int, high: int) -> F:
        return F(rng.randint(low * 100, high * 100), 100)

    made = []
    for _ in range(count):
        v = number(3, 36)
        match manoeuvre:
            case "cut-in":
                given = {"Vy": number(1, 3) / 2, "dx0": number(0, 60), "dy0": number(0, 2)}
                given["dV0"] = v * number(0, 1)
            case "cut-out":
                given = {"Vy": number(1, 6) / 2, "dx0_f": number(0, 80)}
            case _:
                given = {"Gx": number(1, 10), "dx0": number(0, 60), "dV0": v * number(0, 1) / 3}
        made.append(MANOEUVRES[manoeuvre].values({"Ve0": v, **given}))
    return made


def first_look(given: dict[str, F], manoeuvre: str) -> int:
    """A cut-out is seen at the first look at which POV1 is more than 0.375 m off."""
    if manoeuvre != "cut-out":
        return 0
    return next(k for k in range(1000) if given["Vy"] * k / 10 > F("0.375"))


@pytest.mark.parametrize("manoeuvre", list(MANOEUVRES))
def test_sv_does_what_the_model_written_again_does(manoeuvre):
    """At every look of every drive, exactly."""
    touched = set()
    for given in some_values(manoeuvre, 12, 3):
        kind = MANOEUVRES[manoeuvre]
        drive = drive_of(kind, "fsm", given, reading())
        assert first_difference(drive, first_look(given, manoeuvre), 150) is None
        touched.add(course_of(kind, given).touches)
    assert touched == {True, False}


def test_an_acceleration_off_by_a_millionth_is_found():
    drive = drive_of(CUT_IN, "fsm", CUT_IN.values({}), reading())
    ego = drive.vehicles["SV"]
    for k in (0, 2, len(ego.pieces) - 2):
        pieces = list(ego.pieces)
        pieces[k] = replace(pieces[k], a_lon=pieces[k].a_lon - F(1, 10**6))
        other = replace(drive, vehicles={**drive.vehicles, "SV": replace(ego, pieces=tuple(pieces))})
        assert first_difference(other) is not None
    assert first_difference(drive) is None


@pytest.mark.parametrize("manoeuvre", list(MANOEUVRES))
def test_labels_are_what_the_judge_says_of_the_drive(manoeuvre):
    """The judge reads the whole drive; a drive of the other side is rejected."""
    kind, home = MANOEUVRES[manoeuvre], specification()
    for given in some_values(manoeuvre, 10, 4):
        is_hit = course_of(kind, given, to_the_end=False).touches
        assert is_hit == course_of(kind, given).touches
        side, other = SIDES if is_hit else SIDES[::-1]
        judged = judged_drive(kind, "fsm", given, side, home, reading())
        assert judge_file(judged.file, home.library).accepted
        with pytest.raises(rp.InputError, match="does not hold on the drive"):
            judged_drive(kind, "fsm", given, other, home, reading())


def near_values(manoeuvre: str, count: int, seed: int) -> list[dict[str, F]]:
    """Close behind a vehicle that is a little slower, or brakes a little, and stands in many cases."""
    rng = random.Random(seed)
    made = []
    for _ in range(count):
        gap, faster = F(rng.randint(1, 500), 100), F(rng.randint(0, 500), 100)
        speed = faster + rng.choice([F(0), F(0), F(rng.randint(1, 1000), 100)])
        given = {"Ve0": speed, "dV0": faster, "dx0": gap}
        if manoeuvre == "cut-in":
            given |= {"dy0": F(0), "Vy": F(1)}
        else:
            given["Gx"] = F(rng.randint(1, 80), 10)
        made.append(MANOEUVRES[manoeuvre].values(given))
    return made


def differences(manoeuvre: str, cases: list[dict[str, F]]) -> tuple[int, int]:
    """Labels that are otherwise where a drive is not stepped to its end; and how many touch."""
    kind = MANOEUVRES[manoeuvre]
    whole = [course_of(kind, x).touches for x in cases]
    short = [course_of(kind, x, to_the_end=False).touches for x in cases]
    return sum(a != b for a, b in zip(whole, short, strict=True)), sum(whole)


@pytest.mark.parametrize("manoeuvre", list(MANOEUVRES))
def test_labels_need_no_drive_to_its_end(manoeuvre):
    cases = some_values(manoeuvre, 300, 5)
    if manoeuvre != "cut-out":
        cases += near_values(manoeuvre, 1_200, 6)
    wrong, touching = differences(manoeuvre, cases)
    assert wrong == 0
    assert len(cases) // 20 < touching < len(cases) - len(cases) // 20


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (stepped, "_stays_clear", "min(now.gap, controller.margin)", "3 * controller.margin"),
        (stepped, "_stays_clear", "(other.braking and now.its_speed)", "False"),
        (Controller, "needs", "TICKS * looks * faster", "0"),
        (Controller, "needs", "- self.waited", "- _WAITS"),
        (Controller, "needs", "(-faster * faster // (2 * self.comfort))", "0"),
    ],
)
def test_a_drive_that_is_left_too_early_shows(monkeypatch, owner, name, right, wrong):
    plant(monkeypatch, owner, name, right, wrong)
    found = [differences(x, near_values(x, 1_200, 6))[0] for x in ("cut-in", "deceleration")]
    assert sum(found)


def test_a_leader_far_away_is_reached_without_looking_at_each_tenth():
    """dV0 = 1/1000 m/s from 120 m: 120 000 s."""
    given = CUT_IN.values({"dx0": F(120), "dV0": F(1, 1000)})
    course = course_of(CUT_IN, given)
    assert not course.touches
    assert sum(count for count, _ in course.brakings) > 500_000
    assert len(course.brakings) < 300


def test_a_vehicle_that_sv_has_passed_is_not_hit():
    given = CUT_IN.values({"dx0": F(0), "dV0": 50 * KMH, "Vy": F(1, 2)})
    course = course_of(CUT_IN, given)
    assert not course.touches
    assert not any(braking for _, braking in course.brakings)


def test_a_scale_says_whole_numbers_only():
    assert scale_of(F(1, 3)).length(F(1, 3)) * 3 == scale_of(F(1, 3)).metre
    with pytest.raises(ValueError, match="is not whole in this scale"):
        Scale(10).length(F(1, 3))


def test_spans_join_neighbouring_places_only():
    places = tuple(map(F, range(5)))
    assert list(spans_of(places, (True, True, False, True, False))) == [(0, 1), (3, 3)]


def test_labels_of_a_plane_are_those_of_its_places():
    plane = Plane(DECELERATION, {}, (F(0), F(30)), (F(5), F(9)), 2)
    found = labels_of(plane)
    for row, labelled in zip(plane.rows, found, strict=True):
        for k in (0, 40, 120):
            given = plane.values(row, places_of(plane)[k])
            assert labelled[k] == course_of(DECELERATION, given).touches
    assert {x for labels in found for x in labels} == {True, False}


def test_it_is_asked_for_by_name_only():
    for manoeuvre in MANOEUVRES:
        assert "fsm" not in {x.name for x in models_for(manoeuvre)}
        assert models_for(manoeuvre, ("fsm",))[0].is_stepped


PLATE = "fsm-Ve0-50_3"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("fsm")
    found = rp.preventable("cut-out", ["fsm"], at={"Ve0": "60 km/h"}, along=(0, 40), lines=3, jobs=1, out=out)
    found.add_files(False)
    assert "between places looked at nothing is claimed" in str(found)
    assert not found.lemmas
    return out


def test_the_evidence_says_that_it_is_stepped_and_is_worked_out_again(folder, tmp_path, capsys):
    assert main(["report", str(folder), "--out", str(tmp_path / "page.html")]) == 0
    assert "stepped at 10 Hz" in (tmp_path / "page.html").read_text("utf-8")
    table = (folder / "plates.csv").read_text("utf-8").splitlines()
    assert "stepped at 10 Hz" in table[1]
    assert ",,," not in table[0]
    capsys.readouterr()
    assert main(["check", str(folder)]) == 0
    told = capsys.readouterr().out
    assert "DERIVED   fsm-Ve0-50_3, lines  meets(SV, POV2)  [worked out again" in told
    assert "3 of 3 accepted" in told


def another_place(folder: Path) -> None:
    with_changed(folder / f"{PLATE}.json", lambda x: x["lines"][0]["unpreventable"][0][1].update(near=1.5))


def exchanged_sides(folder: Path) -> None:
    a, b = (folder / f"{PLATE}-{side}.json" for side in SIDES)
    content = a.read_bytes()
    a.write_bytes(b.read_bytes())
    b.write_bytes(content)


def another_braking(folder: Path) -> None:
    """The drive is no other than that of the controller, though what its formula says is true of it."""
    file = folder / f"{PLATE}-preventable.json"
    with_changed(file, lambda x: x["vehicles"]["SV"]["pieces"][0].update(duration="1"))


def a_model_with_a_formula(folder: Path) -> None:
    with_changed(folder / f"{PLATE}.json", lambda x: x["plate"].update(model="careful"))


@pytest.mark.parametrize("change", [another_place, exchanged_sides, another_braking, a_model_with_a_formula])
def test_a_changed_plate_of_a_controller_is_rejected(change, folder, tmp_path):
    out = tmp_path / "forged"
    copy(folder, out)
    change(out)
    assert rp.check(out).exit_code == 10


def test_a_cut_out_is_seen_from_0375_m_on():
    given = CUT_OUT.values({"Vy": F(3, 8), "dx0_f": F(5)})
    first = next(count for count, braking in course_of(CUT_OUT, given).brakings if not braking)
    assert first == 11 + 8  # at 1 s it is 0.375 m off, which is not more


@pytest.mark.parametrize("gap", [110, 150, 230])
def test_sv_stops_behind_a_standing_vehicle(gap):
    """From 90 km/h and far away it brakes by about 4 m/s^2, and stops less than a metre short."""
    given = CUT_IN.values({"Ve0": 90 * KMH, "dV0": 90 * KMH, "dx0": F(gap)})
    course = course_of(CUT_IN, given)
    ego = drive_of(CUT_IN, "fsm", given, reading()).vehicles["SV"]
    looks = sum(count for count, _ in course.brakings)
    begin, end = motion(ego, F(0)), motion(ego, F(looks + 1, 10))
    assert not course.touches
    assert end[1] == 0
    assert F("0.8") < gap - (end[0] - begin[0]) < F("0.9")
