"""Decelerations in which POV's braking grows at a finite rate: exact ends, drives, refusals."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from preventing import stepping
from preventing.read import boundary, specification, values
from preventing.test_preventable import copy
from roadproof.analysis.preventable.sides import beside_boundary, first_drive, judged_drive
from roadproof.drivers import gradual
from roadproof.drivers.boundary import Plane, line
from roadproof.drivers.claims import SIDES
from roadproof.drivers.driving import DriverSettings, drive_of, motion_in_deceleration
from roadproof.drivers.manoeuvres import DECELERATION, KMH, start_of
from roadproof.evidence.judged import judge_file
from roadproof.frontends.cli.main import main
from roadproof.semantics.exact.algebraic import Root, approximate

RATE = 1000
SOFT = DriverSettings(values(), specification().options)
HARD = DriverSettings(values(), specification(cc_threshold="hard").options)


def random_decelerations(cases: int, seed: int) -> list[dict[str, Fraction]]:
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(cases):
        speed = Fraction(int(rng.integers(23, 400)), 10)
        faster = speed * Fraction(int(rng.integers(0, 20)), 40) if rng.random() < 0.5 else Fraction(0)
        found.append(
            {
                "Ve0": speed,
                "dV0": faster,
                "Gx": Fraction(int(rng.integers(5, 120)), 10),
                "dGdt": Fraction(int(rng.integers(2, 300)), 10),
            }
        )
    return found


def stepped(cases: list[dict[str, Fraction]], at: str, seconds: int) -> np.ndarray:
    """The most that SV gains, stepped; ``at``: the reading of what is perceived, or rss."""
    x = {name: np.array([float(case[name]) for case in cases]) for name in cases[0]}
    speed, other = x["Ve0"].copy(), x["Ve0"] - x["dV0"]
    gained, most = np.zeros(len(cases)), np.zeros(len(cases))
    onset = np.full(len(cases), stepping.EVALUATION + stepping.DELAY)
    if at == "hard":
        seen = 5 / x["dGdt"]
        is_seen = (x["Gx"] >= 5) & (other > x["dGdt"] * seen**2 / 2)
        onset = np.where(is_seen, onset + seen, np.inf)
    brakes = stepping.careful(onset)
    for step in range(seconds * RATE):
        time = (step + 0.5) / RATE
        change = np.where(time < 0.6, 5.0, -6.0) if at == "rss" else -brakes(time)
        faster = np.maximum(speed + change / RATE, 0)
        slower = np.maximum(other - np.minimum(x["dGdt"] * time, x["Gx"]) / RATE, 0)
        gained += (speed + faster - other - slower) / 2 / RATE
        most = np.maximum(most, gained)
        speed, other = faster, slower
    return most


def exactly(cases: list[dict[str, Fraction]], model: str, reading: DriverSettings) -> np.ndarray:
    found = []
    for case in cases:
        start = start_of(DECELERATION, DECELERATION.values(case))
        motion = motion_in_deceleration(model, start, reading)
        found.append(approximate(gradual.most_gained(motion, start)) if motion else np.inf)
    return np.array(found)


def check(cases: int, seed: int, at: str) -> None:
    given = random_decelerations(cases, seed)
    exact = exactly(given, "rss" if at == "rss" else "careful", HARD if at == "hard" else SOFT)
    step = stepped(given, at, 36 if at == "hard" else 13)
    braking = np.isfinite(exact)
    band = np.array([2 * (float(x["Ve0"]) + 12) / RATE for x in given])
    assert (abs(exact - step) <= band)[braking].all()
    assert braking.mean() > 0.3
    assert braking.all() == (at != "hard")


@pytest.mark.parametrize("at", ["any", "hard", "rss"])
def test_the_most_that_is_gained_against_a_simulation(at):
    check(1_000, 31, at)


def test_much_is_gained_against_a_simulation():
    for seed in range(32, 37):
        check(20_000, seed, "any")


def test_another_rate_shows():
    given = random_decelerations(500, 33)
    other = [x | {"dGdt": x["dGdt"] * Fraction(9, 10)} for x in given]
    exact, step = exactly(given, "careful", SOFT), stepped(other, "any", 13)
    assert (abs(exact - step) > 0.1).mean() > 0.2


def plane(lines: int = 5, **fixed: Fraction) -> Plane:
    return Plane(DECELERATION, fixed, DECELERATION.along, DECELERATION.range, lines)


def test_a_very_large_rate_is_the_formula_without_one():
    formula = boundary("deceleration", "careful")
    for speed in (30 * KMH, 90 * KMH):
        at = plane(9, Ve0=speed)
        quick = plane(9, Ve0=speed, dGdt=Fraction(10**9))
        for row in at.rows:
            ends = [cut.point for cut in line(at, formula, row).cuts[-1:]]
            others = [cut.point for cut in gradual.line(quick, "careful", SOFT, row).cuts[-1:]]
            assert np.allclose(
                [float(approximate(x)) for x in ends], [float(approximate(x)) for x in others], atol=1e-6
            )


def test_ends_where_pov_stands_in_its_ramp_are_roots():
    case = {"Ve0": Fraction(20), "dV0": Fraction(15), "Gx": Fraction(9), "dGdt": Fraction(1)}
    start = start_of(DECELERATION, DECELERATION.values(case))
    most = gradual.most_gained(motion_in_deceleration("careful", start, SOFT), start)
    assert isinstance(most, Root)
    way = np.sqrt(8 * 5.0**3 / 9)
    full = float(values()["cc_braking"])
    stop = 20 * (1.15 + 0.3) + 20**2 / (2 * full) - full * 0.36 / 24
    assert abs(approximate(most) - (stop - way)) < 1e-9


@pytest.mark.parametrize(("model", "reading"), [("careful", SOFT), ("careful", HARD), ("rss", SOFT)])
def test_drives_on_both_sides(model, reading):
    where = plane(dGdt=Fraction(5))
    true = tuple(gradual.line(where, model, reading, row) for row in where.rows)
    home = specification(**dict(reading.options))
    for side in SIDES:
        found = first_drive(where, model, beside_boundary(where, true, side), side, home, reading)
        assert not isinstance(found, str), found
        assert "follows_gradualDeceleration" in found[1].file.formula
        with pytest.raises(rp.InputError, match="does not hold on the drive"):
            judged_drive(DECELERATION, model, found[0], SIDES[side == SIDES[0]], home, reading)


@pytest.mark.parametrize("changed", ["dGdt", "Gx", "cc_delay"])
def test_a_drive_with_another_number_is_rejected(changed):
    given = DECELERATION.values({"dGdt": Fraction(5), "dx0": Fraction(30)})
    mine = judged_drive(DECELERATION, "careful", given, "preventable", specification(), SOFT)
    more = Fraction(101, 100)
    reading = SOFT
    if changed in given:
        given = given | {changed: given[changed] * more}
    else:
        reading = DriverSettings(values() | {changed: values()[changed] * more}, SOFT.options)
    made = drive_of(DECELERATION, "careful", given, reading)
    library = specification().library
    assert judge_file(mine.file, library).accepted
    assert not judge_file(replace(mine.file, drive=made), library).accepted


def test_gentle_braking_is_never_perceived_under_the_letter():
    where = plane(3, dGdt=Fraction(5))
    assert gradual.line(where, "careful", HARD, Fraction("4.9")).at(Fraction(80))
    assert not gradual.line(where, "careful", HARD, Fraction(6)).at(Fraction(80))
    assert gradual.line(plane(3, dGdt=Fraction("0.1")), "careful", HARD, Fraction(6)).at(Fraction(80))


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--at", "dGdt=0"], "dGdt=0 (SI): how fast POV's braking grows (left out: it is there at once) has"),
        (["--at", "dGdt=-1"], "dGdt=-1 (SI)"),
        (["--at", "dGdt=3m/s^2"], "dGdt"),
        (["--at", "dGdt=inf"], "dGdt"),
        (["--at", "dGdt=5", "--model", "fsm"], "model=fsm does not support a finite dGdt"),
        (
            ["--at", "dGdt=5", "--at", "Ve0=2"],
            "SV would stop before it brakes fully, which is not supported",
        ),
    ],
)
def test_mistakes_are_named(words, told, capsys):
    assert main(["preventable", "deceleration", *words, "--no-lemmas"]) in (2, 3)
    assert told in " ".join(capsys.readouterr().err.split())


def test_a_cut_in_has_no_such_rate(capsys):
    assert main(["preventable", "cut-in", "--at", "dGdt=5"]) in (2, 3)
    assert "there is no initial value of a cut-in 'dGdt'" in capsys.readouterr().err


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("gradual")
    at = {"Ve0": "60 km/h", "dGdt": 5}
    found = rp.preventable("deceleration", ["careful"], at=at, lines=5, jobs=1, out=out)
    found.add_files(False)
    assert found.exit_code == 0
    assert not found.lemmas
    assert "no formula of the state" in str(found)
    return out


def test_check_works_the_ends_out_again(folder, tmp_path):
    assert rp.check(folder).exit_code == 0
    assert "worked out from the motion" in (folder / "plates.csv").read_text("utf-8")
    out = tmp_path / "forged"
    copy(folder, out)
    index = json.loads((out / "index.json").read_text("utf-8"))
    index["plates"][0]["lines"][-1]["unpreventable"][0][1]["near"] += 1
    (out / "index.json").write_text(json.dumps(index), "utf-8")
    checked = rp.check(out)
    assert checked.exit_code != 0
    assert "says otherwise at Gx=981/100" in str(checked)


@pytest.mark.parametrize("forged", ["motion", "formula"])
def test_a_plate_that_says_it_has_a_formula_is_told(folder, tmp_path, forged):
    out = tmp_path / "forged"
    copy(folder, out)
    index = json.loads((out / "index.json").read_text("utf-8"))
    plate = index["plates"][0]
    assert plate["formula"] == "F touches(SV, POV)"
    plate["motion" if forged == "motion" else "formula"] = (
        "" if forged == "motion" else "unpreventable_deceleration_careful(SV, POV)"
    )
    (out / "index.json").write_text(json.dumps(index), "utf-8")
    assert rp.check(out).exit_code != 0


def test_rows_without_an_exact_drive_are_passed_over():
    """At 60 km/h POV stands in its ramp at most rows, at irrational instants; from 5 m/s^2 on it is seen."""
    found = rp.preventable(
        "deceleration",
        ["careful"],
        at={"dGdt": 1, "Ve0": "60 km/h"},
        using=rp.load(specs=["driver"], options={"cc_threshold": "hard"}),
        lemmas=False,
        jobs=1,
    )
    (plate,) = found.plates
    assert str(plate.verdict) == "WITNESSED"
    assert {x.side for x in plate.shown if x.drive is not None} == {*SIDES}
