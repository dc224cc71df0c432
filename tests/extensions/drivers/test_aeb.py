"""AEB of the careful driver: its boundaries against a simulation that steps, and its drives."""

import random
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

import roadproof as rp
from extensions.drivers import stepping
from extensions.drivers.labels import labels
from extensions.drivers.read import boundary, specification, values
from extensions.drivers.test_stepping import RATE as STEP_RATE
from extensions.drivers.test_stepping import random_cut_ins
from roadproof.errors import InputError
from roadproof.evidence.judged import judge_file
from roadproof.extensions.drivers import laws
from roadproof.extensions.drivers.braking import AssistedBraking, Ramp
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import drive_of
from roadproof.extensions.drivers.lines import Side
from roadproof.extensions.drivers.manoeuvres import CUT_IN, CUT_OUT, DECELERATION, along_line, start_of
from roadproof.extensions.drivers.models import lemmas_for, models_for
from roadproof.extensions.drivers.preventable.beside import judged_drive
from roadproof.extensions.drivers.start_scene import StartScene
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings
from roadproof.frontends.cli.main import main
from roadproof.semantics.exact.judging import judge
from tables import read_table

RATE = 1000
FULL = 0.85 * stepping.G
CASES = 20_000
JOINED = ("replace", "max", "add")
CHANGED = ({}, {"cc_ramp": Fraction(2)}, {"aeb_braking": Fraction(14), "cc_ramp": Fraction(3, 2)})


def aided(joined, onset, wrap, full=stepping.FULL, aeb=FULL, ramp=stepping.RAMP):
    """The braking of driver and AEB as a function of time, written again."""

    def braking(time):
        driver = np.clip((time - onset) / ramp, 0, 1) * full
        if joined == "replace":
            begun = np.clip((time - np.minimum(onset, wrap)) / ramp, 0, 1) * aeb
            return np.where(time >= wrap, begun, driver)
        other = np.clip((time - wrap) / ramp, 0, 1) * aeb
        return np.maximum(driver, other) if joined == "max" else np.minimum(driver + other, aeb)

    return braking


def near_the_boundary(joined: str, cases: int, seed: int, parameters: dict[str, Fraction]):
    """Cut-ins of boxes of any width, half of them within 0.3 m of where the stepped gain ends."""
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.5, 40, cases) * rng.choice([1.0, 0.15], cases, p=[0.8, 0.2])
    x = {
        "Ve0": v,
        "dV0": v * rng.uniform(0, 1, cases),
        "Vy": rng.uniform(0.2, 3, cases),
        "dy0": rng.uniform(0, 2, cases),
        "width": rng.uniform(0.1, 2.5, cases),
    }
    known = {name: float(value) for name, value in (values() | parameters).items()}
    onset = known["cc_wander"] / x["Vy"] + known["cc_evaluation"] + known["cc_delay"]
    wrap = (x["dy0"] + x["width"]) / x["Vy"]
    drive = aided(joined, onset, wrap, known["cc_braking"], known["aeb_braking"], known["cc_ramp"])
    speed, gained, most = v.copy(), np.zeros(cases), np.zeros(cases)
    for step in range(12 * RATE):
        faster = np.maximum(speed - drive((step + 0.5) / RATE) / RATE, 0)
        gained += (speed + faster) / 2 / RATE - (v - x["dV0"]) / RATE
        speed = faster
        most = np.maximum(most, gained)
        if (speed <= v - x["dV0"]).all():
            break  # who brakes and is not the faster one gains no more
    beside = np.maximum(most + rng.uniform(-0.3, 0.3, cases), 0)
    x["dx0"] = np.where(rng.random(cases) < 0.5, beside, rng.uniform(0, 60, cases))
    return x, drive, most


def differing(
    joined: str, cases: int, seed: int, parameters: dict[str, Fraction], other: str = ""
) -> tuple[int, int]:
    """How many labels differ, and how many of them farther from what is gained at most than a step leads.

    ``other``: the reading of the formula, where that is not the one of the simulation.
    """
    x, drive, most = near_the_boundary(joined, cases, seed, parameters)
    options = {"cc_aeb": other or joined}
    formula = boundary("cut-in", "careful", parameters, **options)
    found = labels(CUT_IN, {"it": formula}, x)["it"]
    w, lengths = x["Ve0"] - x["dV0"], np.full(cases, 8.6)
    outcome = stepping.step_cut_in(x["Ve0"], w, x["dx0"], lengths, x["dy0"], x["Vy"], drive, RATE, 21)
    assert 0.1 < found.mean() < 0.9
    band = 2 * (x["Ve0"] + float(parameters.get("aeb_braking", FULL))) / RATE
    differ = found != outcome.collided
    return int(differ.sum()), int((differ & (abs(most - x["dx0"]) > band)).sum())


@pytest.mark.parametrize(("joined", "parameters"), list(product(JOINED, CHANGED)))
def test_aeb_against_a_simulation(joined, parameters):
    count, outside = differing(joined, 1_000, 21, parameters)
    assert outside == 0
    assert count <= 5


@pytest.mark.parametrize("joined", JOINED)
def test_much_aeb_against_a_simulation(joined):
    count, outside = differing(joined, CASES, 22, {})
    assert outside <= CASES / 10_000  # where POV comes in when it is just reached, or just passed
    assert count < CASES / 200


@pytest.mark.parametrize(
    ("joined", "other"),
    [("replace", "max"), ("max", "replace"), ("add", "max"), ("max", "none"), ("add", "none")],
)
def test_another_reading_shows(joined, other):
    """Half of the cases are so near to the boundary that readings which are alike are told apart."""
    _, outside = differing(joined, 1_000, 23, CHANGED[2], other)
    assert outside > 5


@pytest.mark.parametrize(
    ("joined", "gate"), list(product(("replace", "max"), ("before_perception", "before_delay")))
)
def test_aeb_behind_a_gate(joined, gate):
    x, *_ = near_the_boundary(joined, 1_000, 24, {})
    found = labels(CUT_IN, {"it": boundary("cut-in", "careful", cc_aeb=joined, cc_gate=gate)}, x)["it"]
    onset = stepping.gated_onset(x, gate)
    drive = aided(joined, onset, (x["dy0"] + x["width"]) / x["Vy"])
    w, lengths = x["Ve0"] - x["dV0"], np.full(1_000, 8.6)
    outcome = stepping.step_cut_in(x["Ve0"], w, x["dx0"], lengths, x["dy0"], x["Vy"], drive, RATE, 35)
    assert not ((found != outcome.collided) & (outcome.nearest > 2 * (x["Ve0"] + FULL) / RATE)).any()


READINGS = (
    {"cc_aeb": "replace"},
    {"cc_aeb": "max"},
    {"cc_aeb": "add"},
    {"cc_aeb": "add", "cc_perception": "overlap"},
    {"cc_aeb": "max", "cc_gate": "before_perception"},
    {"cc_aeb": "replace", "cc_perception": "distance"},
)


@pytest.mark.parametrize("options", READINGS)
def test_drives_follow_and_end_as_the_boundary_says(options):
    rng = random.Random(6)
    home, formula = specification(**options), boundary("cut-in", "careful", **options)
    reading = DriverSettings(values(), home.options)
    judged = 0
    while judged < 3:
        speed = Fraction(rng.randint(60, 400), 10)
        given = {
            "Ve0": speed,
            "dV0": speed * Fraction(rng.randint(4, 20), 20),
            "Vy": Fraction(rng.randint(5, 40), 10),
            "dy0": Fraction(rng.randint(0, 20), 10),
            "width": Fraction(rng.randint(5, 25), 10),
            "dx0": Fraction(rng.randint(0, 400), 10),
        }
        at = CUT_IN.values(given)
        if at["dV0"] * at["dy0"] / at["Vy"] > at["dx0"] and rng.random() < 0.9:
            continue  # SV may have passed POV, of which nothing is said
        hit = judge(formula, along_line(CUT_IN, at)).truth(formula).at(at["dx0"])
        side: Side = "unpreventable" if hit else "preventable"
        try:
            judged_drive(CUT_IN, "careful", at, side, home, reading)
        except InputError as error:
            if at["dV0"] * at["dy0"] / at["Vy"] <= at["dx0"] and "no fraction" not in str(error):
                raise
            continue
        judged += 1


@pytest.mark.parametrize(("joined", "other"), [x for x in product(JOINED, JOINED) if x[0] != x[1]])
def test_a_drive_of_another_reading_is_rejected(joined, other):
    given = CUT_IN.values(
        {"Ve0": Fraction(30), "dV0": Fraction(20), "Vy": Fraction(5, 2), "dx0": Fraction(70)}
    )
    home = specification(cc_aeb=joined)
    mine = judged_drive(CUT_IN, "careful", given, "preventable", home, DriverSettings(values(), home.options))
    made = drive_of(CUT_IN, "careful", given, DriverSettings(values(), specification(cc_aeb=other).options))
    assert_rejected(mine, made)


@pytest.mark.parametrize("joined", JOINED)
@pytest.mark.parametrize("changed", ["aeb_braking", "cc_braking", "cc_delay"])
def test_a_drive_with_another_constant_is_rejected(joined, changed):
    given = CUT_IN.values(
        {"Ve0": Fraction(30), "dV0": Fraction(20), "Vy": Fraction(5, 2), "dx0": Fraction(70)}
    )
    home = specification(cc_aeb=joined)
    mine = judged_drive(CUT_IN, "careful", given, "preventable", home, DriverSettings(values(), home.options))
    other = values() | {changed: values()[changed] * Fraction(101, 100)}
    assert_rejected(mine, drive_of(CUT_IN, "careful", given, DriverSettings(other, home.options)))


@pytest.mark.parametrize(("joined", "speed"), list(product(JOINED, (Fraction(5, 2), Fraction(9, 10)))))
@pytest.mark.parametrize("late", ["driver", "aeb"])
def test_braking_at_another_instant_is_not_followed(joined, speed, late, monkeypatch):
    """The speeds in the claim are those of the forged motion: what it says is pinned by instants."""
    plain, wrapped = laws._careful_onset, StartScene.wrapped
    given = {"Ve0": Fraction(36), "dV0": Fraction(12), "Vy": speed, "dx0": Fraction(70)}
    home = specification(cc_aeb=joined)
    reading, at = DriverSettings(values(), home.options), CUT_IN.values(given)
    judged_drive(CUT_IN, "careful", at, "preventable", home, reading)
    scene = StartScene(start_of(CUT_IN, at))
    matters = late == "aeb" or joined == "add" or plain("cut-in", scene, reading) < scene.wrapped()
    for by in (Fraction(-1, 100), Fraction(1, 100)):
        if late == "driver":
            monkeypatch.setattr(laws, "_careful_onset", lambda *x, by=by: plain(*x) + by)
        else:
            monkeypatch.setattr(StartScene, "wrapped", lambda x, by=by: wrapped(x) + by)
        if not matters:
            judged_drive(CUT_IN, "careful", at, "preventable", home, reading)
            continue
        with pytest.raises(InputError, match="does not hold on the drive"):
            judged_drive(CUT_IN, "careful", at, "preventable", home, reading)


def assert_rejected(mine, made):
    library = specification().library
    assert judge_file(mine.file, library).accepted
    assert made != mine.file.drive
    assert not judge_file(replace(mine.file, drive=made), library).accepted


def test_braking_that_jumps_is_not_followed():
    """The jerk is right at every instant, and the braking jumps: the model does not do that."""
    for options in ({}, {"cc_aeb": "max"}):
        home = specification(**options)
        given = CUT_IN.values({"dx0": Fraction(40)})
        mine = judged_drive(
            CUT_IN, "careful", given, "preventable", home, DriverSettings(values(), home.options)
        )
        drive = mine.file.drive
        pieces = list(drive.vehicles["SV"].pieces)
        ramp = next(k for k, piece in enumerate(pieces) if piece.j_lon)
        half = pieces[ramp].duration / 2
        pieces[ramp] = replace(pieces[ramp], duration=half, a_lon=pieces[ramp].j_lon * half)
        jumps = replace(drive.vehicles["SV"], pieces=tuple(pieces))
        forged = replace(mine.file, drive=replace(drive, vehicles={**drive.vehicles, "SV": jumps}))
        assert not judge_file(forged, home.library).accepted


def test_nothing_changes_but_cut_ins():
    for manoeuvre in ("cut-out", "deceleration"):
        without = boundary(manoeuvre, "careful")
        assert all(boundary(manoeuvre, "careful", cc_aeb=joined) == without for joined in JOINED)


def test_the_sum_of_two_ramps_is_capped():
    driver, aeb = Ramp(Fraction(1), Fraction(1), Fraction(6)), Ramp(Fraction(3, 2), Fraction(1), Fraction(8))
    both = AssistedBraking(driver, aeb, "add")
    assert [both.at(Fraction(k, 4)) for k in range(4, 12)] == [
        0,
        Fraction(3, 2),
        3,
        Fraction(13, 2),
        8,
        8,
        8,
        8,
    ]
    assert sum(duration for duration, _, _ in both.pieces(Fraction(30))) < 6


def test_lemmas_are_those_of_the_reading():
    careful = models_for("cut-in", ("careful",))
    names = {joined: {x.name for x in lemmas_for("cut-in", careful, joined)} for joined in ("none", *JOINED)}
    assert "aeb-at-once" in names["replace"] - names["max"]
    assert "both-greatest" in names["add"] - names["max"]
    assert not any(x.startswith("aeb") for x in names["none"])
    assert names["none"] == {x.name for x in lemmas_for("cut-in", careful)}


def test_a_false_lemma_of_aeb_is_refuted():
    careful = models_for("cut-in", ("careful",))
    lemma = next(x for x in lemmas_for("cut-in", careful, "add") if x.name == "aeb-sum-full")
    false = lemma.claim.replace("<= cc_braking*cc_ramp)", "<= aeb_braking*cc_ramp)")
    assert false != lemma.claim
    answer = rp.prove(
        false, using=rp.load(specs=["driver"], options={"cc_aeb": "add"}), declared=True, jobs=1
    )
    assert str(answer.verdict) == "REFUTED"


def test_recordings_are_put_to_no_driver_that_is_not_worked_out():
    home = specification(cc_aeb="add", cc_gate="before_delay")
    with pytest.raises(rp.UsageError, match="cc_aeb=add, cc_gate=before_delay"):
        EvaluationSettings(home.library, home.options, values(), drivers=("careful",))
    EvaluationSettings(home.library, {**home.options, "cc_gate": "none"}, values(), drivers=("careful",))


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--param", "aeb_braking=5"], "aeb_braking=5 m/s^2: AEB brakes at least as hard as the driver"),
        (
            ["--option", "cc_gate=before_delay"],
            "cc_aeb=add, cc_gate=before_delay: this combination is not supported",
        ),
        (["--option", "cc_aeb=both"], "cc_aeb"),
        (["--param", "aeb_braking=0"], "aeb_braking"),
    ],
)
def test_mistakes_are_named(words, told, capsys):
    assert main(["preventable", "cut-in", "--option", "cc_aeb=add", *words, "--no-lemmas"]) in (2, 3)
    assert told in " ".join(capsys.readouterr().err.split())


# --- Driver models with other constants than the declared ones, against the simulation that steps ---

DRAWN = 600
LENGTHS = 8.6
# How far constants go; speeds, gaps and angles as in the other tests.
RANGES = read_table(__file__, "ranges")


def constants(seed: int) -> dict[str, Fraction]:
    dice = random.Random(seed)
    return {
        x: Fraction(dice.randint(int(100 * low), int(100 * high)), 100) for x, (low, high) in RANGES.items()
    }


def motion(model: str, known: dict[str, float], onset: np.ndarray):
    """SV's braking over time, below 0 where it accelerates."""
    if model == "careful":
        return lambda time: np.clip((time - onset) / known["cc_ramp"], 0, 1) * known["cc_braking"]
    if model == "rss":
        late = onset + known["rho"]
        return lambda time: np.where(time < onset, 0, np.where(time < late, -known["a_max"], known["b_min"]))
    return stepping.at_once(onset, known[f"{model}_braking"])


def onsets(model: str, known: dict[str, float], x: dict[str, np.ndarray], perception: str, gate: str):
    """When SV begins to brake, or to respond, in a cut-in."""
    intrusion = (x["dy0"] / 2 + known["r157_past"]) / x["Vy"]
    match model:
        case "rss":
            return x["dy0"] / x["Vy"]
        case "r157":
            return intrusion + known["r157_delay"]
        case "eu1426":
            return intrusion + known["eu1426_delay"] + known["eu1426_ramp"] / 2
    wander, drift = known["cc_wander"] / x["Vy"], known["cc_drift"] / x["Vy"]
    seen, weighed = {
        "time": (wander, known["cc_evaluation"]),
        "distance": (wander + drift, 0),  # so a gate is before the delay, whichever it is
        "overlap": (x["dy0"] / x["Vy"], 0),
    }[perception]
    with np.errstate(divide="ignore"):
        opens = np.where(x["dV0"] > 0, x["dx0"] / x["dV0"] - known["cc_ttc"], 1e9)
    match gate:
        case "before_perception":
            return np.maximum(seen, opens) + weighed + known["cc_delay"]
        case "before_delay":
            return np.maximum(seen + weighed, opens) + known["cc_delay"]
    return seen + weighed + known["cc_delay"]


def far_off(found: np.ndarray, outcome: stepping.Outcome, speed: np.ndarray) -> np.ndarray:
    """Labels that differ farther from the boundary than a step leads: SV may be faster by a_max·rho."""
    return (found != outcome.collided) & (outcome.nearest > 3 * (speed + 21) / STEP_RATE)


def cut_ins(model: str, seed: int, off: float = 1.0, **options: str) -> tuple[int, float]:
    """Labels that are off where SV acts ``off`` times as late as it is told; the share that is hit."""
    said = constants(seed)
    x = random_cut_ins(DRAWN, seed)
    found = labels(CUT_IN, {"it": boundary("cut-in", model, said, **options)}, x)["it"]
    known = {name: float(value) for name, value in said.items()}
    perception, gate = options.get("cc_perception", "time"), options.get("cc_gate", "none")
    onset = onsets(model, known, x, perception, gate) * off
    soon = onset < 8  # a drive that begins to brake later is not over when the simulation is
    x, onset, found = {name: value[soon] for name, value in x.items()}, onset[soon], found[soon]
    speed = x["Ve0"]
    outcome = stepping.step_cut_in(
        speed, speed - x["dV0"], x["dx0"], np.full(len(speed), LENGTHS), x["dy0"], x["Vy"],
        motion(model, known, onset), STEP_RATE, 40,
    )  # fmt: skip
    return int(far_off(found, outcome, speed).sum()), float(found.mean())


VARIED = [
    (p, g) for p in ("time", "distance", "overlap") for g in ("none", "before_perception", "before_delay")
]


@pytest.mark.parametrize("number", range(len(VARIED)))
def test_cut_ins_of_a_careful_driver(number):
    perception, gate = VARIED[number]
    off, share = cut_ins("careful", 40 + number, cc_perception=perception, cc_gate=gate)
    assert off == 0
    assert 0.1 < share < 0.9


@pytest.mark.parametrize("model", ["r157", "eu1426", "rss"])
@pytest.mark.parametrize("seed", [51, 52, 53])
def test_cut_ins_of_other_models(model, seed):
    off, share = cut_ins(model, seed)
    assert off == 0
    assert 0.1 < share < 0.95


@pytest.mark.parametrize("model", ["careful", "r157", "eu1426", "rss"])
def test_another_delay_shows(model):
    """As would a response of RSS that does not last from when POV is beside SV."""
    assert cut_ins(model, 54, off=1.3)[0] > 3


@pytest.mark.parametrize(("model", "threshold"), [("careful", "any"), ("careful", "hard"), ("rss", "any")])
@pytest.mark.parametrize("seed", [61, 62, 63])
def test_decelerations(model, threshold, seed):
    said, rng = constants(seed), np.random.default_rng(seed)
    known = {name: float(value) for name, value in said.items()}
    speed = rng.uniform(0.5, 40, DRAWN)
    faster = np.where(rng.random(DRAWN) < 0.5, 0.0, np.minimum(rng.normal(0, 5, DRAWN), speed))
    x = {"Ve0": speed, "dV0": faster, "Gx": rng.uniform(0.1, 12, DRAWN), "dx0": rng.uniform(0, 80, DRAWN)}
    found = labels(DECELERATION, {"it": boundary("deceleration", model, said, cc_threshold=threshold)}, x)[
        "it"
    ]
    onset = np.full(DRAWN, 0.0 if model == "rss" else known["cc_evaluation"] + known["cc_delay"])
    unseen = x["Gx"] < known["cc_hard"] if threshold == "hard" else np.zeros(DRAWN, bool)
    assert found[unseen].all()  # SV never brakes
    outcome = stepping.step_deceleration(
        speed, speed - faster, x["dx0"], x["Gx"], motion(model, known, onset), STEP_RATE, 30
    )
    assert not far_off(found, outcome, speed)[~unseen].any()
    assert 0.05 < found.mean() < 0.98


@pytest.mark.parametrize("seed", [71, 72, 73])
def test_cut_outs(seed):
    said, rng = constants(seed), np.random.default_rng(seed)
    known = {name: float(value) for name, value in said.items()}
    x = {
        "Ve0": rng.uniform(1, 45, DRAWN),
        "Vf0": np.zeros(DRAWN),
        "Vy": rng.uniform(0.1, 3, DRAWN),
        "headway": rng.uniform(0.5, 3, DRAWN),
        "dx0_f": rng.uniform(0, 100, DRAWN),
    }
    found = labels(CUT_OUT, {"it": boundary("cut-out", "careful", said)}, x)["it"]
    onset = known["cc_wander"] / x["Vy"] + known["cc_evaluation"] + known["cc_delay"]
    way = stepping.stopping_way(x["Ve0"], motion("careful", known, onset), STEP_RATE, 45)
    left = x["headway"] * x["Ve0"] + LENGTHS / 2 + x["dx0_f"] - way
    assert not ((found != (left < 0)) & (np.abs(left) > 3 * (x["Ve0"] + 12) / STEP_RATE)).any()
    assert 0.02 < found.mean() < 0.98
