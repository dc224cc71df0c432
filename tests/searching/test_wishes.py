"""Typical drives: which wishes there are, what the answer says of them, and that they change no verdict."""

import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from itertools import combinations
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.engines.search import wishes
from roadproof.engines.search.wishes import WISHES, fulfilled_wishes
from roadproof.evidence.drive_file import DriveFile
from roadproof.frontends.report.samples import csv_of
from roadproof.frontends.report.witness import as_line
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import Scenario, apply_scenario
from roadproof.library.specification import Source
from roadproof.logic.rewrite import with_values, without_names
from roadproof.semantics.exact.judging import judge
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from roadproof.world.motion import state_at

ROOT = Path(__file__).parents[2]
LIBRARY = bundled_library()
BASE = LIBRARY.select()
RAMP, ORDER, MIDDLE, TIME, ZONE = (x.name for x in WISHES)


# --- the shipped drives ---------------------------------------------------------------------------


@pytest.fixture(scope="module")
def typical():
    """The answers that come with roadproof, by scenario."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("ROADPROOF_KNOWN")
        answers = rp.witness(jobs=1)
    return {x.scenario: x for x in answers.outcomes}


def test_the_24_drives_differ(typical):
    files = [typical[n].drives[0].file for n in range(1, 25)]
    assert all(one.drive != other.drive for one, other in combinations(files, 2))
    assert len({csv_of(file) for file in files}) == 24


@pytest.mark.parametrize(("lane", "numbers"), [("merge-1", range(9, 17)), ("departure-1", range(17, 25))])
def test_drives_in_zones_are_on_the_ramp(typical, lane, numbers):
    for number in numbers:
        file = typical[number].drives[0].file
        here = [x for x in file.drive.vehicles if holds(f"F atLane({x}, L)", file, lane)]
        assert here, f"scenario {number} has no vehicle in {lane}"
        assert typical[number].wishes[RAMP] == (True,)


def test_each_shipped_drive_fulfils_each_wish_that_says_something(typical):
    for number, result in typical.items():
        said = result.wishes
        assert {*said.values()} == {(True,)}
        zone = {RAMP, ZONE} if number > 8 else set()
        order = {ORDER} if number in (1, 5, 9, 13, 17, 21) else set()
        assert {*said} == {MIDDLE, TIME} | zone | order


def holds(text: str, file: DriveFile, lane: str) -> bool:
    formula = read_claim(BASE, text).formula
    return judge(bind(formula, file.road, {"L": lane}, default_values(LIBRARY)), file.drive).holds


# --- what the answer says -------------------------------------------------------------------------


def test_the_answer_says_which_wishes_a_drive_fulfils():
    never = "inMergeZone(SV) and atLane(SV,L) and G not (some M in adjacentLanes(L): atLane(SV,M))"
    [result] = rp.witness(never, jobs=1).outcomes
    assert result.wishes == {RAMP: (False,), MIDDLE: (True,), ZONE: (True,)}
    assert as_line(result).splitlines()[1:] == [f"  typical: {MIDDLE}, {ZONE}", f"  not typical: {RAMP}"]
    [data] = rp.witness(never, jobs=1).as_data()["verdicts"]
    assert data["wishes"] == {RAMP: [False], MIDDLE: [True], ZONE: [True]}


@pytest.mark.parametrize("objective", ["any", "smooth"])
def test_other_objectives_have_no_wishes(objective):
    first, ninth = rp.witness(1, 9, objective=objective, jobs=1).outcomes
    assert first.wishes == ninth.wishes == {}
    assert first.drives[0].file.drive == ninth.drives[0].file.drive
    assert "typical" not in as_line(first)
    assert "wishes" not in rp.witness(1, objective=objective, jobs=1).as_data()["verdicts"][0]


@pytest.mark.parametrize(
    "text",
    [
        "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)",
        "v_lon(SV) > 100 m/s and inMergeZone(SV)",
        "G (atLane(SV,L) and not onMainRoad(SV)) and inDepartZone(SV)",
        "inMergeZone(SV) and F[0, 0.6 s] d(SV) > 6 m",
        "aheadOf(POV,SV) and F aheadOf(SV,POV)",
        "F[0, 0.6 s] (v_lat(SV) > 0 m/s and G[0, 0.6 s] not danger(SV,POV))",
        "s(SV) = 400 m and inMergeZone(POV)",
    ],
)
def test_wishes_change_no_verdict(text):
    assert rp.witness(text, jobs=1).verdict is rp.witness(text, objective="smooth", jobs=1).verdict


def test_wishes_that_contradict_each_other_are_fulfilled_in_turn(monkeypatch):
    """The first of two is fulfilled, and the one after them, too."""
    made = [read_claim(BASE, f"F {x}").formula for x in ("d(SV) > 6 m", "d(SV) > 4 m", "v_lon(SV) < 28 m/s")]
    made[1] = read_claim(BASE, "G d(SV) < 4 m").formula
    rows = tuple(wishes.Wish(str(k), "", lambda _, x=x: x) for k, x in enumerate(made))
    monkeypatch.setattr(wishes, "WISHES", rows)
    [result] = rp.witness("v_lon(SV) > 20 m/s", jobs=1).outcomes
    assert result.wishes == {"0": (True,), "1": (False,), "2": (True,)}


def test_the_guide_lists_the_table_of_wishes():
    page = ROOT.joinpath("docs/how-to/typical.md").read_text("utf-8")
    rows = [f"| {x.name} | {x.meaning} |" for x in WISHES]
    assert "\n".join(["|---|---|", *rows, ""]) in page


# --- what a wish means ----------------------------------------------------------------------------

LONGER = """
set longer extends base {
  def danger(a, b: vehicle)   := G[0, 1 s] rssViolation(a, b)
  def initSafe(a, b: vehicle) := G[0, 1 s] instSafe(a, b)
}
"""


@pytest.mark.parametrize("number", range(1, 25))
def test_states_that_last_longer_are_the_scenario_with_longer_definitions(number):
    longer = build_library([Source("longer.spec", LONGER)], LIBRARY).select("longer")
    expected = apply_scenario(longer, Scenario(number, "longer")).formula
    assert time_wish(apply_scenario(BASE, Scenario(number, "base")).formula) == plain(expected)


SLOW = "G[0, 0.5 s] v_lon(SV) > 0 m/s"


@pytest.mark.parametrize(
    ("text", "longer"),
    [
        (f"not {SLOW}", None),
        (f"{SLOW} -> G[0, 0.5 s] d(SV) > 0 m", f"{SLOW} -> G[0, 1 s] d(SV) > 0 m"),
        ("F[0, 0.5 s] G[1 s, 1.5 s] d(SV) > 0 m", "F[0, 0.5 s] G[1 s, 2 s] d(SV) > 0 m"),
        ("not F[0, 1 s] not G[0, 0 s] d(SV) > 0 m", "not F[0, 1 s] not G[0, 1 s] d(SV) > 0 m"),
        ("G[0, 1 s] d(SV) > 0 m and G d(SV) > 0 m", None),
    ],
)
def test_only_required_states_last_longer(text, longer):
    changed = time_wish(read_claim(BASE, text).formula)
    assert changed == (wishes.f.TRUE if longer is None else plain(read_claim(BASE, longer).formula))


def plain(formula):
    return without_names(with_values(formula, default_values(LIBRARY)))


def time_wish(formula):
    claim = wishes.ClaimOnRoad(
        formula, (), load_road("main-2"), default_values(LIBRARY), Fraction(6), wishes.LEAST, Fraction(5)
    )
    return next(x for x in WISHES if x.name == TIME).formula(claim)


# --- an independent reading of generated drives -----------------------------------------------------

FIRST = {"main-2": 1, "merge": 9, "depart": 17}
"""The first scenario of each road."""
TIMES = [*(Fraction(k, 20) for k in range(80)), *(Fraction(k, 2) for k in range(8, 80))]
ZERO, LATE, END = Fraction(0), Fraction(5), Fraction(6)


@dataclass(frozen=True)
class Case:
    """A drive near middles of lanes and edges of zones, with a scenario and the wishes by another reading."""

    number: int
    file: DriveFile
    expected: dict[str, bool]


@cache
def cases() -> tuple[Case, ...]:
    """Return 60 generated drives with what another reading says of them."""
    made = []
    for road in FIRST:
        for seed in range(20):
            choose = random.Random(f"{road} {seed}")
            number = FIRST[road] + choose.choice((0, 3, 4, 6))
            drive = Drive({x: motion(choose, road) for x in ("SV", "POV")})
            lanes = {"L": choose.choice(load_road(road).lanes)}
            values = default_values(LIBRARY)
            file = DriveFile(number, "base", "", END, lanes, values, {}, load_road(road), drive)
            made.append(Case(number, file, read_independently(road, number, drive.vehicles)))
    return tuple(made)


def motion(choose: random.Random, road: str) -> Motion:
    """A vehicle that stays in a lane or is in another one after 4 s; some go on across the road."""
    lanes = range(0 if road == "main-2" else -1, 2)
    lane, target = choose.choice(lanes), choose.choice(lanes)
    off = Fraction(choose.randint(-8, 8), 10)
    across = (Fraction(7, 2) * (target - lane) - off * choose.choice((0, 1))) / 4
    last = Fraction(choose.choice((0, 0, 0, 1)), 10)
    pieces = (Piece(Fraction(2), ZERO, across), Piece(Fraction(2), ZERO, last / 2 - across))
    return Motion(
        Fraction(9, 2),
        Fraction(9, 5),
        Fraction(choose.choice((-97, -80, -10, 60, 140, 170)) + choose.randint(-5, 5)),
        Fraction(7, 2) * lane + Fraction(53, 20) + off,
        Fraction(choose.randint(15, 32)),
        ZERO,
        (*pieces, Piece(None, ZERO, ZERO)),
    )


def read_independently(road: str, number: int, motions: Mapping[str, Motion]) -> dict[str, bool]:
    """What the words of each wish say of a drive, read at samples and at the ends."""
    said = {MIDDLE: all(ends_in_middle(x, road) for x in motions.values())}
    if road != "main-2":
        stretch = (-100.0, 300.0) if road == "merge" else (-100.0, float("inf"))
        here = [[on_ramp(x, time, stretch) for time in TIMES] for x in motions.values()]
        leaves = any(x[0] and not all(x) for x in here)
        enters = any(not x[0] and any(x) for x in here)
        said[RAMP] = leaves if road == "merge" else enters
        ends = [(state_at(x, ZERO).s - x.length, state_at(x, LATE).s) for x in motions.values()]
        said[ZONE] = all(rear >= -90 and front <= stretch[1] - 10 for rear, front in ends)
    if (number - 1) % 8 in (0, 4):  # cut-ins
        said[ORDER] = motions["SV"].s <= motions["POV"].s - motions["POV"].length
    return said


def on_ramp(motion: Motion, time: Fraction, stretch: tuple[float, float]) -> bool:
    state = state_at(motion, time)
    front, left = float(state.s), float(state.d)
    return front > stretch[0] and front - 4.5 < stretch[1] and left > -3.5 and left - 1.8 < 0


def ends_in_middle(motion: Motion, road: str) -> bool:
    lanes = (0, 1) if road == "main-2" else (-1, 0, 1)
    centres = [Fraction(7, 4) + Fraction(7, 2) * lane for lane in lanes]
    here = [state_at(motion, time).d - motion.width / 2 for time in (ZERO, END)]
    is_near = all(any(abs(x - centre) <= Fraction(1, 2) for centre in centres) for x in here)
    return is_near and state_at(motion, END).v_lat == 0


def disagreements() -> Iterator[str]:
    """Yield each wish of which the judge and the other reading disagree."""
    for case in cases():
        query = apply_scenario(BASE, Scenario(case.number, "base"))
        judged = fulfilled_wishes(query, case.file, LIBRARY)
        del judged[TIME]
        assert {*judged} == {*case.expected}
        yield from (x for x, value in judged.items() if value != case.expected[x])


def test_the_wishes_of_generated_drives_are_those_of_another_reading():
    assert [*disagreements()] == []


def test_some_generated_drives_fulfil_each_wish_and_some_do_not():
    said = {
        x: {case.expected[x] for case in cases() if x in case.expected} for x in (RAMP, ORDER, MIDDLE, ZONE)
    }
    assert all(x == {False, True} for x in said.values())


def mirrored(true):
    def orders(formula, later):
        for x, is_later in true(formula, later):
            yield replace(x, left=x.right, right=x.left), is_later

    return orders


@pytest.mark.parametrize(
    ("wish", "part", "fault"),
    [
        (RAMP, "_changes", lambda true: lambda x, lane, leaves: true(x, lane, not leaves)),
        (ORDER, "_orders", mirrored),
        (MIDDLE, "NEAR", lambda _: Fraction(1)),
        (ZONE, "AWAY", lambda _: Fraction(40)),
    ],
)
def test_a_wrong_reading_of_a_wish_is_caught(monkeypatch, wish, part, fault):
    monkeypatch.setattr(wishes, part, fault(getattr(wishes, part)))
    assert {*disagreements()} == {wish}


def test_a_wrong_duration_is_caught(monkeypatch):
    monkeypatch.setattr(wishes, "LEAST", Fraction(1, 2))
    with pytest.raises(AssertionError):
        test_states_that_last_longer_are_the_scenario_with_longer_definitions(1)
