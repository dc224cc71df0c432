"""Decelerations in which POV's braking grows at a finite rate: exact ends, drives, refusals."""

import json
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from random import Random
from types import SimpleNamespace

import numpy as np
import pytest

import roadproof as rp
from extensions.drivers import stepping
from extensions.drivers.read import boundary, specification, values
from extensions.drivers.test_preventable import copy, with_changed
from roadproof.errors import UsageError
from roadproof.evidence.judged import judge_file
from roadproof.extensions.drivers import gradual
from roadproof.extensions.drivers.braking import AssistedBraking, Ramp, pieces_of
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import drive_of, motion_under
from roadproof.extensions.drivers.lines import SIDES, PlateLine, end_of, sides_in
from roadproof.extensions.drivers.manoeuvres import DECELERATION, KMH, MANOEUVRES, Plane, line, start_of
from roadproof.extensions.drivers.models import MODELS, law_of, lemmas_for, unpreventable
from roadproof.extensions.drivers.preventable.beside import (
    beside_boundary,
    far_apart,
    first_drive,
    judged_drive,
)
from roadproof.extensions.drivers.preventable.report import as_text, shown_symbols
from roadproof.extensions.drivers.restriction import Restriction
from roadproof.extensions.drivers.words import _PARTS, legend, words_of_parts
from roadproof.extensions.pages.drive_data import strips_of
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.cli.main import main
from roadproof.logic.formula import And, Application, subformulas
from roadproof.semantics.exact.algebraic import Root, as_float

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
        motion = motion_under(law_of(model), "deceleration", start, reading)
        found.append(as_float(gradual.most_gained(motion, start)) if motion else np.inf)
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
    check(20_000, 32, "any")


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
                [float(as_float(x)) for x in ends], [float(as_float(x)) for x in others], atol=1e-6
            )


def test_ends_where_pov_stands_in_its_ramp_are_roots():
    case = {"Ve0": Fraction(20), "dV0": Fraction(15), "Gx": Fraction(9), "dGdt": Fraction(1)}
    start = start_of(DECELERATION, DECELERATION.values(case))
    most = gradual.most_gained(motion_under(law_of("careful"), "deceleration", start, SOFT), start)
    assert isinstance(most, Root)
    way = np.sqrt(8 * 5.0**3 / 9)
    full = float(values()["cc_braking"])
    stop = 20 * (1.15 + 0.3) + 20**2 / (2 * full) - full * 0.36 / 24
    assert abs(as_float(most) - (stop - way)) < 1e-9


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


PLATE = "careful-dGdt-5-Ve0-50_3"


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
    with_changed(out / f"{PLATE}.json", lambda x: x["lines"][-1]["unpreventable"][0][1].update(near=1.5))
    checked = rp.check(out)
    assert checked.exit_code == 10
    assert "says otherwise at Gx=981/100" in str(checked)


def test_a_plate_that_says_it_has_a_formula_is_told(folder, tmp_path):
    out = tmp_path / "forged"
    copy(folder, out)
    formula = "unpreventable_deceleration_careful(SV, POV)"
    assert json.loads((out / f"{PLATE}.json").read_text("utf-8"))["claim"] == "meets(SV, POV)"
    with_changed(out / f"{PLATE}.json", lambda x: x.update(claim=formula))
    assert rp.check(out).exit_code == 10


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


# --- Braking as a function of time, the motion that follows, and the places on plates that are looked at


@pytest.mark.parametrize("joined", ["max", "add"])
@pytest.mark.parametrize("seed", range(30))
def test_braking_is_affine_between_knots(joined: str, seed: int) -> None:
    """AEB brakes at least as hard as the driver, and begins before or after."""
    random = Random(f"{joined} {seed}")
    full = Fraction(random.randint(10, 80), 10)
    duration = Fraction(random.randint(1, 20), 10)
    onset, other = (Fraction(random.randint(0, 30), 10) for _ in range(2))
    harder = full + Fraction(random.randint(0, 40), 10)
    braking = AssistedBraking(Ramp(onset, duration, full), Ramp(other, duration, harder), joined)
    knots = braking.knots
    for begin, end in pairwise(knots):
        middle, near = (begin + end) / 2, end - (end - begin) / 1000
        slope = (braking.at(middle) - braking.at(begin)) / (middle - begin) if end > begin else 0
        assert braking.at(near) == braking.at(begin) + slope * (near - begin)
    assert braking.at(knots[-1]) == braking.at(knots[-1] + 10)


@pytest.mark.parametrize("model", ["rss", "r157", "eu1426"])
@pytest.mark.parametrize("onset", [Fraction(0), Fraction(1, 2), Fraction(3)])
def test_nobody_brakes_before_the_onset(model: str, onset: Fraction) -> None:
    scene = SimpleNamespace(beside=lambda: onset, past_marking=lambda metres: onset)
    response = law_of(model).respond("cut-in", scene, DriverSettings(values(), {}))
    assert response.onset >= onset
    still = [(response.onset, Fraction(0), Fraction(0))] if response.onset else []
    pieces = pieces_of(Fraction(20), [*still, *response.phases])
    assert pieces[: len(still)] == still
    _, *changes = pieces[len(still)]
    assert any(changes)


def test_lemmas_are_those_of_the_models() -> None:
    careful = {x.name for x in lemmas_for("cut-in", [MODELS["careful"]])}
    both = {x.name for x in lemmas_for("cut-in", [MODELS["careful"], MODELS["rss"]])}
    assert careful < both
    assert all(name.startswith("careful-") for name in careful)
    assert all(name.startswith("rss-") for name in both - careful)
    assert not [x for x in lemmas_for("deceleration", [MODELS["rss"]]) if not x.name.startswith("rss-")]


def test_a_single_place_is_a_side_of_a_controller_only() -> None:
    along = (Fraction(0), Fraction(10))
    place = end_of(Fraction(4))
    lines = [PlateLine(Fraction(1), ((place, place),))]
    assert sides_in(lines, along, is_stepped=True) == {"unpreventable", "preventable"}
    assert sides_in(lines, along, is_stepped=False) == {"preventable"}
    whole = [PlateLine(Fraction(1), ((end_of(along[0]), end_of(along[1])),))]
    assert sides_in(whole, along, is_stepped=False) == {"unpreventable"}


def test_the_first_and_the_last_four_places_of_a_row_are_looked_at() -> None:
    kind = MANOEUVRES["cut-in"]
    plane = Plane(kind, {}, (Fraction(0), Fraction(60)), (Fraction(0), Fraction(20)))
    candidates = [{kind.across: Fraction(row), kind.line: Fraction(k)} for row in range(6) for k in range(7)]
    chosen = far_apart(plane, candidates, 3)
    assert [(int(x[kind.across]), int(x[kind.line])) for x in chosen] == [
        (row, k) for row in (0, 2, 4) for k in (0, 3, 4, 5, 6)
    ]


def test_drives_in_no_scenario_are_asked_for_as_drives() -> None:
    Restriction("preventable", "careful", "drives").check_drives()
    with pytest.raises(UsageError, match="would all be gaps"):
        Restriction("preventable", "careful", "scenarios").check_drives()


# --- Words for symbols of initial values, and for parts of driver models in pictures ----------------


@pytest.fixture(scope="module")
def drivers() -> Definitions:
    return rp.load(specs=["driver"])


def test_all_words_are_of_definitions(drivers: Definitions) -> None:
    for name in _PARTS:
        assert name in drivers.specification.definitions


@pytest.mark.parametrize("manoeuvre", MANOEUVRES)
def test_the_side_of_each_model_has_words(manoeuvre: str, drivers: Definitions) -> None:
    """The first vehicle is the one that is driven, whatever it is called."""
    for model in (x for x in MODELS if manoeuvre in MODELS[x].manoeuvres and not MODELS[x].is_stepped):
        for vehicles in (MANOEUVRES[manoeuvre].vehicles, MANOEUVRES[manoeuvre].vehicles[::-1]):
            formula = drivers.read(unpreventable(manoeuvre, model, vehicles)).formula
            told = words_of_parts(formula)[formula]
            assert told.startswith(f"{vehicles[0]}, ")
            assert "cannot prevent a collision (unpreventable_" in told


def test_parts_speak_of_the_vehicles_around_them(drivers: Definitions) -> None:
    for one, other in (("SV", "POV"), ("POV", "SV")):
        formula = drivers.read(f"unpreventable_cutIn_careful({one}, {other})").formula
        words = {x.name.partition("@")[0]: told for x, told in words_of_parts(formula).items()}
        assert words["careful_hits"] == f"{one}, driven as the careful driver, hits {other} (careful_hits)"
        assert words["comesIn"] == f"{other}, ahead of {one} and beside its way, comes into it (comesIn)"
    both = drivers.read("unpreventable_cutIn_rss(SV, POV) or unpreventable_cutIn_rss(POV, SV)").formula
    hits = {told for x, told in words_of_parts(both).items() if x.name.startswith("rss_hits")}
    assert hits == {
        f"{a}, which responds as RSS asks, hits {b} (rss_hits)" for a, b in (("SV", "POV"), ("POV", "SV"))
    }


def test_other_parts_keep_their_names() -> None:
    formula = rp.load().read("scenario_4(SV,POV,L)").formula
    assert any(isinstance(x, Application) for x in subformulas(formula))
    assert words_of_parts(formula) == {}
    assert words_of_parts(And(())) == {}


def test_symbols_and_strips_of_a_plate() -> None:
    """The text ends with all symbols that it shows; strips of its drives have words in place of numbers."""
    found = rp.preventable(
        "cut-in", models=["careful"], at={"Ve0": "60km/h", "Vy": "1"}, lines=3, lemmas=False, jobs=1
    )
    told = as_text(found.question, found.plates, ()).splitlines()[-1]
    for symbol in (
        "Ve0: the speed of SV (km/h)",
        "dV0: how much faster SV is",
        "dx0: the gap along the road (m)",
    ):
        assert symbol in told
    assert {x.name for x in shown_symbols(found.question)} == {"Ve0", "dV0", "Vy", "dx0"}
    drives = [x.drive for plate in found.plates for x in plate.shown if x.drive is not None]
    assert len(drives) == 2
    for drive in drives:
        names = [x.name for x in strips_of(drive.judgement, Fraction(6))]
        assert "SV, driven as the careful driver, hits POV (careful_hits)" in names
        assert not any(name.startswith("careful_hits(") for name in names)


@pytest.mark.parametrize("manoeuvre", MANOEUVRES)
def test_every_symbol_has_words_and_a_unit(manoeuvre: str) -> None:
    told = legend(MANOEUVRES[manoeuvre].quantities.values())
    for name, x in MANOEUVRES[manoeuvre].quantities.items():
        assert f"{name}: {x.doc} ({x.unit})" in told.split("; ")
