"""Why a test shows no scenario: what is said is so, judged again, and the change makes the part true."""

import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.analysis.catalogue.asked import Questions, ScenarioQuestion
from roadproof.analysis.catalogue.nearest import first_false_part
from roadproof.analysis.catalogue.why import Course, why_none
from roadproof.evidence.answers.catalogue_index import Why
from roadproof.evidence.drive_file import load_drive
from roadproof.library.bind import bind
from roadproof.library.scenarios import Scenario, applied, name_of, vehicles_of
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.signals import DriveSignals
from roadproof.world.drive import Drive, Piece

HOME = rp.load()
FILE = load_drive(Path(__file__).parents[2] / "examples" / "catalogue" / "tests" / "drives" / "lead.json")
NUMBERS = tuple(range(1, 9))
ROLES = ((("SV", "POV"), ("SV", "POV")),)
ASKED = Questions(HOME.alone, NUMBERS, None, HOME.all_values())


def pair(speed: Fraction, other: Fraction, gap: Fraction, braking: Fraction, begin: Fraction) -> Course:
    """POV ahead of SV in its lane; it brakes from ``begin`` to a stand."""
    lane = FILE.drive.vehicles["SV"]
    steady = Piece(None, Fraction(0), Fraction(0))
    behind = replace(lane, s=Fraction(0), v_lon=speed, v_lat=Fraction(0), pieces=(steady,))
    pieces = (
        Piece(begin, Fraction(0), Fraction(0)),
        Piece(other / braking, -braking, Fraction(0)),
        steady,
    )
    ahead = replace(behind, s=gap + behind.length, v_lon=other, pieces=pieces)
    drive = Drive({"SV": behind, "POV": ahead})
    return Course(DriveSignals(drive), FILE.road, Fraction(10), ROLES, (FILE.lanes["L"],))


def why(*numbers: int | str) -> Why | None:
    speed, other, gap, braking, begin = map(Fraction, numbers)
    return why_none(pair(speed, other, gap, braking, begin), ASKED)


def test_equal_speeds_lack_a_slower_vehicle_ahead_and_count_in_another_set() -> None:
    found = why(20, 20, 60, 6, 1)
    assert found is not None
    assert found.nearest == "scenario_4"
    assert found.lacks == "fasterThan(POV, SV)"
    assert found.at == 0
    assert "v_lon(POV) = 20 m/s, v_lon(SV) = 20 m/s" in found.told
    assert "needs v_lon(POV) < v_lon(SV); lower v_lon(POV) by more than 0 m/s there" in found.told


def test_the_sets_that_count_it_are_those_in_which_a_scenario_holds() -> None:
    found = why(20, 20, 60, 6, 1)
    assert found is not None
    home, course = HOME.alone, pair(*map(Fraction, (20, 20, 60, 6, 1)))
    for name in ("extA", "ext", "complete"):
        there = home.in_set(name)
        held = {
            name_of(number)
            for number in NUMBERS
            if vehicles_of(there, Scenario(number, name)) == ("SV", "POV")
            and judge(
                bind(applied(there, Scenario(number, name)).formula, course.road, FILE.lanes, ASKED.values),
                course.signals,
            ).holds
        }
        assert {*found.sets.get(name, ())} == held
    assert found.sets == {"complete": ("scenario_4",)}


def test_a_slower_vehicle_ahead_shows_scenario_4() -> None:
    assert why(20, "19.9", 60, 6, 1) is None


@pytest.mark.parametrize("seed", range(15))
def test_the_change_makes_the_part_true_and_less_does_not(seed: int) -> None:
    rng = random.Random(seed)
    limits = ((5, 40), (5, 40), (1, 150), (1, 8), (1, 4))
    course = pair(*(Fraction(rng.randint(4 * low, 4 * high), 4) for low, high in limits))
    formulas = [
        formula
        for key, formula in ASKED.on(course.road, *ROLES[0], course.lanes[0]).items()
        if isinstance(key, ScenarioQuestion)
    ]
    for formula in formulas:
        part = first_false_part(formula, course.signals, course.horizon)
        if judge(formula, course.signals).holds:
            assert part is None
        if part is None:
            continue
        tiny = Fraction(1, 10**9)
        for by, expected in ((Fraction(0), False), (part.lack - tiny, False), (part.lack + tiny, True)):
            comparison = part.comparison
            grows = (comparison.op in (">", ">=")) is part.needed
            moved = t.Sum((comparison.left, t.Number(by if grows else -by)))
            truth = judge(f.Compare(moved, comparison.op, comparison.right), course.signals)
            assert (truth.truth(truth.formula).at(part.at) is part.needed) is expected


@pytest.mark.parametrize(
    ("text", "at_most", "lack"),
    [
        ("v_lon(SV) >= 0 m/s U v_lon(SV) > 100 m/s", 10, 80),
        ("F[0, 1 s] v_lon(POV) < 5 m/s", 1, 15),
        ("F[0, 1 s] (v_lon(SV) > 9 m/s and v_lon(POV) < 5 m/s and v_lon(POV) < 10 m/s)", 1, 15),
        ("F v_lon(SV) < 5 m/s", 10, 15),
        ("not (F[0, 1 s] v_lon(POV) > 5 m/s)", 0, 15),
    ],
)
def test_the_false_part_is_within_its_window_and_needed_as_it_stands(
    text: str, at_most: int, lack: int
) -> None:
    """POV brakes after the window; SV goes on at 20 m/s."""
    course = pair(*map(Fraction, (20, 20, 60, 6, 2)))
    formula = bind(HOME.read(text).formula, course.road, FILE.lanes, ASKED.values)
    found = first_false_part(formula, course.signals, course.horizon)
    assert found is not None
    assert 0 <= found.at <= at_most
    assert found.lack == lack
    assert found.needed is not text.startswith("not")
