"""Hints about first instants of open conditions, and definitions of entering that do without."""

import random
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.frontends.cli.main import main
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.logic.first_instant import first_instant_warnings, first_instants
from roadproof.semantics.exact.judging import judge
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from roadproof.world.motion import state_at

LIBRARY = bundled_library()
HOME = LIBRARY.select()
ROAD = load_road("main-2")
VALUES = default_values(LIBRARY)
ASKING = (
    "not atLane(SV,L) U atLane(SV,L)",
    "not inMergeZone(SV) U inMergeZone(SV)",
    "F (not atLane(SV,L) U[0, 3 s] (atLane(SV,L) and danger(SV,POV)))",
    "v_lon(SV) > 3 m/s and not atLane(SV,L) U atLane(SV,L)",
    "(d(SV) <= 3 m) U d(SV) > 3 m",
    "not (d(SV) > 3 m and s(SV) > 0 m) U (d(SV) > 3 m and s(SV) > 0 m)",
    "(some M in lanes: not atLane(SV,M) U atLane(SV,M))",
    "not (not atLane(SV,L) U atLane(SV,L)) -> atLane(POV,L)",
    "not sameLane(SV,POV,L) U sameLane(SV,POV,L)",
)
SILENT = (
    "atLane(SV,L) U not atLane(SV,L)",
    "not atLane(SV,L) and F atLane(SV,L)",
    "(d(SV) < 3 m) U d(SV) >= 3 m",
    "not atLane(POV,L) U atLane(SV,L)",
    "(not atLane(SV,L) or danger(SV,POV)) U atLane(SV,L)",
    "(danger(SV,POV) or atLane(SV,L)) U atLane(SV,L)",
    "not atLane(SV,L) U (atLane(SV,L) or danger(SV,POV))",
    "a_lon(SV) <= 0 m/s^2 U a_lon(SV) > 0 m/s^2",  # accelerations jump: the first instant may exist
    "not (F atLane(SV,L)) U (F atLane(SV,L))",
)


@pytest.mark.parametrize("text", ASKING)
def test_what_asks_for_a_first_instant_is_told(text):
    (told,) = first_instant_warnings(read_claim(HOME, text).formula)
    assert "docs/explanation/entering.md" in told


@pytest.mark.parametrize("text", SILENT)
def test_all_else_is_not(text):
    assert not first_instant_warnings(read_claim(HOME, text).formula)


def test_no_scenario_asks_for_one():
    for name in ("base", "ext", "extA"):
        home = rp.load(name)
        for number in range(1, 25):
            assert not first_instant_warnings(home.read(number).formula)


def lane_change(rng):
    """A drive of SV from one lane to the other, or in one lane only."""
    d, to = rng.choice([(2, 6), (6, 2), (3, 3)])
    half = Fraction(rng.randint(5, 30), 10)
    rate = (to - d) / half**2
    wait = Fraction(rng.randint(1, 20), 10)
    still = Fraction(0)
    pieces = (
        Piece(wait, still, still),
        Piece(half, still, rate),
        Piece(half, still, -rate),
        Piece(None, still, still),
    )
    size = Fraction(9, 2), Fraction(9, 5)
    return Drive({"SV": Motion(*size, Fraction(0), Fraction(d), Fraction(30), still, pieces)})


def bound(home, text, lane, values=VALUES):
    return bind(read_claim(home, text).formula, ROAD, {"L": lane}, values)


def test_what_is_told_is_false_on_every_drive_that_enters_later():
    rng, seen = random.Random(4), 0
    for _ in range(40):
        drive, lane = lane_change(rng), rng.choice(ROAD.lanes)
        later = judge(bound(HOME, "not atLane(SV,L) and F atLane(SV,L)", lane), drive).holds
        formula = bound(HOME, ASKING[0], lane)
        assert [*first_instants(formula)]
        if later:
            seen += 1
            assert not judge(formula, drive).holds
    assert seen > 5


ENTERING = load_library([Path("entering")])


def sides(drive, lane):
    """Whether the box is in a lane at times that are close to each other."""
    ((right, left),) = {x.d for x in ROAD.lanelets if x.lane == lane}
    motion = drive.vehicles["SV"]
    places = [state_at(motion, Fraction(k, 10)).d for k in range(100)]
    return [d > right and d - motion.width < left for d in places]


def test_definitions_of_entering_mean_what_is_seen():
    home, rng, seen = ENTERING.select(), random.Random(9), set()
    values = default_values(ENTERING)
    for _ in range(20):
        drive, lane = lane_change(rng), rng.choice(ROAD.lanes)
        inside = sides(drive, lane)
        expected = {
            "entersLane(SV,L)": not inside[0] and any(inside),
            "leavesLane(SV,L)": inside[0] and not all(inside),
            "staysOutside(SV,L)": not any(inside),
            "crossesLane(SV,L)": not inside[0] and any(inside) and not inside[-1],
        }
        for text, holds in expected.items():
            assert judge(bound(home, text, lane, values), drive).holds == holds, (text, lane)
            seen.add((text, holds))
    assert {(x, True) for x in ("entersLane(SV,L)", "leavesLane(SV,L)", "staysOutside(SV,L)")} < seen


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        ("entersBefore(SV,POV,L) -> not entersBefore(POV,SV,L)", "PROVED"),
        ("entersBefore(SV,POV,L) -> entersLane(SV,L)", "PROVED"),
        ("entersLane(SV,L) <-> enteringLane(SV,L)", "PROVED"),
        ("crossesLane(SV,L) -> entersLane(SV,L)", "PROVED"),
        ("leavesLane(SV,L) -> not staysOutside(SV,L)", "PROVED"),
        ("entersLane(SV,L) -> crossesLane(SV,L)", "REFUTED"),
        ("entersBefore(SV,POV,L) -> entersLane(POV,L)", "REFUTED"),
    ],
)
def test_definitions_of_entering_relate_as_words_do(claim, verdict):
    assert rp.prove(claim, using=rp.load(specs=("entering",)), jobs=1, drive=False).verdict.value == verdict


@pytest.mark.parametrize("command", [["show"], ["prove", "--no-drive"], ["witness"]])
def test_commands_print_the_hint(command, capsys):
    main([*command, ASKING[0]])
    assert "asks for the first instant" in capsys.readouterr().out
    main([*command, SILENT[1]])
    assert "asks for the first instant" not in capsys.readouterr().out
