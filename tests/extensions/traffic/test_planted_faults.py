"""Wrong experiments, planted by hand: each check holds as things are, and fails on every fault beside it."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from types import ModuleType

import numpy as np
import pytest

from extensions.traffic.faults import faulty_library, plant_fault
from extensions.traffic.make_recording import Track, cruise, make_recording, near_pairs
from roadproof.errors import InputError
from roadproof.extensions.surveys.classify.cells import Cell
from roadproof.extensions.surveys.classify.classes import Class
from roadproof.extensions.surveys.classify.drives import ClassExample
from roadproof.extensions.surveys.classify.traffic_shares import Shares
from roadproof.extensions.surveys.report import classify
from roadproof.extensions.traffic.evaluate import disturbances, evaluate
from roadproof.extensions.traffic.evaluate.detectors import find_detections
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.formats import pairs
from roadproof.extensions.traffic.formats.pairs import DetectionRange, RssParameters, common_pairs
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.scenario_parts import COMPARISON
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import PAIR, TRIPLE
from roadproof.library.specification import Source
from roadproof.library.words import Words
from roadproof.verdict import Verdict
from tables import read_table


@dataclass(frozen=True)
class Fault:
    module: ModuleType
    old: str
    new: str


MODULES = {"classify": classify, "disturbances": disturbances, "evaluate": evaluate, "pairs": pairs}


def faults(name: str) -> dict[str, Fault]:
    rows = read_table(__file__, name)
    return {fault: Fault(MODULES[module], old, new) for fault, (module, old, new) in rows.items()}


def check_against(faults: dict[str, Fault]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The check as it is, and once with each fault, where it must fail."""
    return pytest.mark.parametrize("fault", [None, *faults.values()], ids=["no fault", *faults])


def judge(monkeypatch: pytest.MonkeyPatch, fault: Fault | None, check: Callable[[], None]) -> None:
    if fault is None:
        check()
        return
    plant_fault(monkeypatch, fault.module, fault.old, fault.new)
    with pytest.raises((AssertionError, InputError)):
        check()


# --- traces cut one sample early, or late -------------------------------------------------------


def near_and_far() -> Recording:
    """30 m/s each; POV is 10 m ahead in samples 40 to 59 and 70 to 74, else 200 m: danger begins and ends.

    A third car is 400 m ahead all the time.
    """
    sv = cruise(0.0, 30.0, 100)
    near = [10.0 if 40 <= k < 60 or 70 <= k < 75 else 200.0 for k in range(100)]
    pov = [(s + gap, *rest) for (s, *rest), gap in zip(sv, near, strict=True)]
    far = [(s + 400.0, *rest) for s, *rest in sv]
    return make_recording([Track(2, 1, sv), Track(2, 1, pov), Track(2, 1, far)])


LAST = {0: 74, 1: 59}
"""The last sample of the trace, by minDanger: of the last danger, and of the last that lasts for 0.6 s."""


def found_at(
    sample: int, vehicles: str, number: int, initially: str = ""
) -> set[tuple[int, int | None, int]]:
    """(sv, pov2, minDanger) of the matches of a scenario that asks for SV's place in ``sample``."""
    place = Fraction(30 * sample, 25)
    text = f"def scenario_{number}({vehicles}: vehicle, L: lane) := F (s(SV) >= {place} * 1 m)"
    library = build_library([Source("mine.spec", text + initially)], bundled_library())
    settings = replace(default_settings(), library=library, sets=("base",), scenarios=(number,))
    findings = evaluate.evaluate_recording(near_and_far(), compile_questions(settings, 25))
    return {(m.sv, m.pov2, m.min_danger) for m in findings.matches if m.sv == 1}


ENDS = faults("ends")


@check_against(ENDS)
def test_pairs_end_with_the_last_danger(fault: Fault | None, monkeypatch: pytest.MonkeyPatch) -> None:
    def check() -> None:
        for k, last in LAST.items():
            assert (1, None, k) in found_at(last, "SV, POV", 4)
            assert (1, None, k) not in found_at(last + 1, "SV, POV", 4)

    judge(monkeypatch, fault, check)


TRIPLE_ENDS = {
    name: Fault(
        disturbances,
        "ends.append(np.where(starts & (final >= start), final + steps, -1))",
        f"ends.append(np.where(starts & (final >= start), final{change}, -1))",
    )
    for name, change in (("early", " + steps - 1"), ("late", " + steps + 1"), ("begins", ""))
}


@check_against(TRIPLE_ENDS)
def test_triples_end_with_the_last_danger(fault: Fault | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """POV1 is the far car, POV2 the one that comes near."""
    anyhow = "\ndef initialCondition_2(SV, POV1, POV2: vehicle, L: lane) := v_lon(SV) > 0 m/s"

    def check() -> None:
        for k, last in LAST.items():
            assert (1, 2, k) in found_at(last, "SV, POV1, POV2", 2, anyhow)
            assert (1, 2, k) not in found_at(last + 1, "SV, POV1, POV2", 2, anyhow)

    judge(monkeypatch, fault, check)


# --- the pre-filters with the wrong vehicle's size or speed ----------------------------------------

REACH = RssParameters(rho=0.6, a_max=5.0, b_min=6.0, b_max=8.0, a_max_lat=1.5, b_min_lat=1.5)
FILTER = faults("filter")


def two_cars(front: int, gap: float, across: float, sizes: tuple[float, float]) -> Recording:
    """A car and a lorry, the rear one faster; ``front`` says which of the two is ahead, and left.

    ``gap`` and ``across`` are between the boxes.
    """
    (length, width), (lorry_length, lorry_width) = (4.5, 1.8), sizes
    lengths, widths = (length, lorry_length), (width, lorry_width)
    places = {front: (gap + lengths[front], across + widths[front], 24.0), 1 - front: (0.0, 0.0, 30.0)}
    return make_recording(
        [
            Track(
                2,
                1,
                [(places[k][0], -26.0 + places[k][1], places[k][2], 0.0, 0.0, 0.0)],
                lengths[k],
                widths[k],
            )
            for k in (0, 1)
        ]
    )


@check_against(FILTER)
def test_the_pre_filter_is_sharp_for_cars_and_lorries(
    fault: Fault | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """30 m/s behind 24 m/s need 73.65 m along, standing still across they need 1.08 m (semantics §3)."""

    def kept(front: int, gap: float, across: float) -> bool:
        r = two_cars(front, gap, across, (12.0, 2.5))
        return len(near_pairs(r, common_pairs(r, np.ones(2, bool)), REACH)) == 1

    def check() -> None:
        for front in (0, 1):
            assert kept(front, 73.64, 0.0)
            assert not kept(front, 73.66, 0.0)
            assert kept(front, 10.0, 1.07)
            assert not kept(front, 10.0, 1.09)

    judge(monkeypatch, fault, check)


SIGHT = faults("sight")


@check_against(SIGHT)
@pytest.mark.parametrize(("sight", "most"), [((0, 2, 0), 60.0), ((5, 0, 0), 30.0), ((0, 0, 50), 50.0)])
def test_the_detectors_sight_is_sharp(
    sight: tuple[float, float, float], most: float, fault: Fault | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """30 m/s behind 24 m/s: 2 s of headway are 60 m, 5 s to collision 30 m; all to the rear of the front."""

    def kept(front: int, gap: float) -> bool:
        r = two_cars(front, gap, -1.0, (12.0, 1.8))
        return len(pairs.pairs_in_sight(r, common_pairs(r, np.ones(2, bool)), DetectionRange(*sight))[0]) == 1

    def check() -> None:
        for front in (0, 1):
            assert kept(front, most - 0.01)
            assert not kept(front, most + 0.01)

    if fault is not None and fault is not SIGHT["length of the rear"] and most == 50.0:
        return  # neither speed matters for a distance
    if fault is SIGHT["closing the other way"] and sight[0] == 0:
        return
    if fault is SIGHT["headway at the front's speed"] and sight[1] == 0:
        return
    judge(monkeypatch, fault, check)


# --- the detectors' definitions ------------------------------------------------------------------

DETECTORS = {
    "headway at the front's speed": ("thwLimit*v_lon(a)", "thwLimit*v_lon(b)"),
    "headway at the closing speed": ("thwLimit*v_lon(a)", "thwLimit*(v_lon(a) - v_lon(b))"),
    "headway from rear to rear": (":= rear(b) - front(a)", ":= rear(b) - rear(a)"),
    "headway to the front": (":= rear(b) - front(a)", ":= front(b) - front(a)"),
    "time to collision without the front's speed": ("ttcLimit*(v_lon(a) - v_lon(b))", "ttcLimit*v_lon(a)"),
    "limits exchanged": ("gapAhead(a, b) < thwLimit*v_lon(a)", "gapAhead(a, b) < ttcLimit*v_lon(a)"),
}


def detected(library_text: tuple[str, str] | None, gap: float, rear: float, front: float) -> set[str]:
    """The decel detectors that find SV behind POV, which brakes at 5 m/s², in a single sample."""
    library = bundled_library() if library_text is None else faulty_library(*library_text)
    questions = compile_questions(replace(default_settings(library), detectors=COMPARISON), 25)
    sv = [(0.0, -28.0, rear, 0.0, 0.0, 0.0)]
    pov = [(gap + 4.5, -28.0, front, 0.0, -5.0, 0.0)]
    recording = make_recording([Track(2, 1, sv), Track(2, 1, pov)])
    found = find_detections(recording, questions, common_pairs(recording, np.ones(2, bool)))
    assert all((x.sv, x.pov) == (1, 2) for x in found)
    return {x.detector for x in found}


@pytest.mark.parametrize("fault", [None, *DETECTORS.values()], ids=["no fault", *DETECTORS])
def test_headway_and_time_to_collision(fault: tuple[str, str] | None) -> None:
    """Headway is the gap by the rear car's speed (2 s), time to collision by the difference (4 s)."""
    cases = [
        (59.9, 30.0, 20.0, {"decel_thw"}),  # 2.997 s at the front's speed
        (60.1, 30.0, 20.0, set()),
        (39.9, 30.0, 20.0, {"decel_thw", "decel_ttc"}),  # 3.99 s to collision
        (40.1, 30.0, 20.0, {"decel_thw"}),
        (40.1, 20.0, 30.0, set()),  # 1.3 s at the front's speed
        (39.9, 20.0, 30.0, {"decel_thw"}),
        (70.0, 30.0, 5.0, {"decel_ttc"}),
    ]
    held = all(detected(fault, gap, rear, front) == expected for gap, rear, front, expected in cases)
    assert held == (fault is None)


# --- shares of classes ---------------------------------------------------------------------------

SHARES = faults("shares")


@check_against(SHARES)
def test_shares_are_of_situations_with_as_many_vehicles(
    fault: Fault | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """6 and 2 of 8 situations of two vehicles are 75 and 25 %, 4 of 4 of three vehicles are all."""

    def one(number: int, vehicles: tuple[str, ...]) -> ClassExample:
        cell = Cell((number,), (number,), ())
        named = Class(f"class_{number}", vehicles, (number,), cell, None, "main road", f"{number} happens")
        return ClassExample(named, verdict=Verdict.WITNESSED)

    examples = [one(1, PAIR), one(4, PAIR), one(2, TRIPLE)]
    situations = Counter({"class_1": 6, "class_4": 2, "class_2": 4})
    shares = Shares(["01"], 10, 9, situations, classified=Counter({2: 8, 3: 4}), source="here")

    def check() -> None:
        words = {number: Words(number) for number in (1, 2, 4)}
        rows = {line.split()[0]: line for line in classify.as_table(examples, shares, words).splitlines()[1:]}
        assert {name: row.split()[5] for name, row in rows.items()} == {
            "class_1": "75.0",
            "class_4": "25.0",
            "class_2": "100.0",
        }

    judge(monkeypatch, fault, check)
