"""Roads made for a layout: they are roads, and have the facts that were asked for."""

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest

from proving.on_roads import is_road, neighbours
from roadproof.engines.prove.roads import ZONES, Box, Layout, lay_road
from roadproof.world.road import Lanelet, Road


def overlap(box: Box, lanelet: Lanelet) -> bool:
    low, high = lanelet.s
    return max(box.rear, low) < min(box.front, high) and max(box.right, lanelet.d[0]) < min(
        box.left, lanelet.d[1]
    )


def is_in(place: tuple[str, str], box: Box, road: Road) -> bool:
    kind, name = place
    of = {"lane": lambda x: x.lane, "zone": lambda x: x.zone, "lanelet": lambda x: x.id}[kind]
    return any(of(lanelet) == name and overlap(box, lanelet) for lanelet in road.lanelets)


def random_layout(rng: Random) -> Layout:
    boxes = []
    for _ in range(rng.randint(1, 5)):
        rear, right = Fraction(rng.randint(0, 20)), Fraction(rng.randint(0, 6))
        boxes.append(Box(rear, rear + rng.randint(1, 5), right, right + rng.randint(1, 3)))
    lanes = tuple(f"L{k}" for k in range(rng.randint(0, 3)))
    places = [*(("lane", lane) for lane in lanes), *(("zone", zone) for zone in ZONES)]
    lanelets = {"l": (lanes[0], ZONES)} if lanes and rng.random() < 0.5 else {}
    places += [("lanelet", name) for name in lanelets]
    facts = [(place, j) for place in places for j in range(len(boxes))]
    said = {fact: rng.random() < 0.35 for fact in facts if rng.random() < 0.5}
    pairs = [frozenset((a, b)) for a in lanes for b in lanes if a < b]
    return Layout(
        tuple(boxes),
        frozenset(fact for fact, true in said.items() if true),
        frozenset(fact for fact, true in said.items() if not true),
        lanes,
        lanelets,
        frozenset(pair for pair in pairs if rng.random() < 0.5),
        rng.random() < 0.3,
    )


def test_random_layouts():
    made = 0
    for seed in range(300):
        layout = random_layout(Random(seed))
        road = lay_road(layout)
        if road is None:
            continue
        made += 1
        assert is_road(road), seed
        assert set(layout.lanes) <= set(road.lanes), seed
        assert neighbours(road) == layout.adjacent, seed
        for place, j in layout.inside:
            assert is_in(place, layout.boxes[j], road), (seed, place, j)
        for place, j in layout.outside:
            assert not is_in(place, layout.boxes[j], road), (seed, place, j)
    assert made > 150


BOX = Box(Fraction(0), Fraction(4), Fraction(0), Fraction(2))
BEFORE = replace(BOX, rear=Fraction(4), front=Fraction(8))
LEFT = replace(BOX, right=Fraction(2), left=Fraction(4))
BEHIND_IT = replace(BOX, rear=Fraction(8), front=Fraction(12))
LEFT_OF_IT = replace(BOX, right=Fraction(4), left=Fraction(6))
L = ("lane", "L")


def one_lane(boxes: tuple[Box, ...], inside: set[int], outside: set[int]) -> Layout:
    facts = [frozenset((L, j) for j in which) for which in (inside, outside)]
    return Layout(boxes, facts[0], facts[1], ("L",), {}, frozenset(), False)


@pytest.mark.parametrize(
    ("boxes", "inside", "outside", "possible"),
    [
        ((BOX,), {0}, set(), True),
        ((BOX,), set(), {0}, True),
        ((BOX, BOX), {0}, {1}, False),
        # around the middle one of a column, but not through the middle one of a row
        ((BOX, BEFORE, BEHIND_IT), {0, 2}, {1}, True),
        ((BOX, LEFT, LEFT_OF_IT), {0, 2}, {1}, False),
        # covered by two others
        ((replace(BOX, front=Fraction(8)), BOX, BEFORE), {0}, {1, 2}, False),
    ],
)
def test_what_a_lane_can_and_cannot_do(boxes, inside, outside, possible):
    assert (lay_road(one_lane(boxes, inside, outside)) is not None) == possible


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_lanelet_with_a_name_may_come_first_or_later(order):
    inside = {(L, 0), (("lanelet", "l"), 1)}
    outside = {(("lanelet", "l"), 0)}
    boxes = tuple((BOX, BEFORE)[k] for k in order)
    lanelets = {"l": ("L", ZONES)}
    road = lay_road(
        Layout(boxes, frozenset(inside), frozenset(outside), ("L",), lanelets, frozenset(), False)
    )
    assert road is not None
    assert [x.lane for x in road.lanelets if x.id == "l"] == ["L"]
    for place, j in inside:
        assert is_in(place, boxes[j], road)
    assert not is_in(("lanelet", "l"), boxes[0], road)


def test_a_short_lane_has_no_lanelet_that_it_does_not_need():
    """Else no claim about every lanelet of a lane would be false for want of one."""
    layout = one_lane((BOX, BEFORE), {1}, {0})
    whole, short = lay_road(layout), lay_road(replace(layout, short=True))
    assert all(overlap(BEFORE, x) for x in short.lanelets)
    assert len(whole.lanelets) > len(short.lanelets)
    assert whole.lanelets[0].s[0] < BOX.rear
    assert whole.lanelets[-1].s[1] > BEFORE.front
