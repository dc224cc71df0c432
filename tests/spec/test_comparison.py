"""The detectors of earlier works, on drives whose answer follows from what their definitions say in words."""

from dataclasses import dataclass
from fractions import Fraction as F
from itertools import pairwise

import pytest

from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.semantics.exact import judge
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

LIBRARY = bundled_library()
ROAD = load_road("main-2")
RIGHT, LEFT = F(53, 20), F(123, 20)  # the left side of a car in the middle of a lane


@dataclass(frozen=True)
class Car:
    """``across``: (seconds, lateral speed), one after the other; then straight on. ``brakes`` for so long."""

    s: F | int | str = 0
    d: F = RIGHT
    v: F | int | str = 20
    a: F | int | str = 0
    across: tuple[tuple[str, str], ...] = ()
    brakes: F | None = None

    @property
    def motion(self) -> Motion:
        """Lateral speeds are reached within a hundredth of a second."""
        flick = F(1, 100)
        speeds = [F(v) for _, v in self.across]
        pieces = []
        for (seconds, _), (now, after) in zip(self.across, pairwise([*speeds, F(0)]), strict=True):
            pieces += [Piece(F(seconds), F(self.a), F(0)), Piece(flick, F(self.a), (after - now) / flick)]
        if self.brakes is not None:
            pieces.append(Piece(self.brakes, F(self.a), F(0)))
        end = F(0) if pieces else F(self.a)
        pieces.append(Piece(None, end, F(0)))
        numbers = (F(9, 2), F(9, 5), F(self.s), self.d, F(self.v), speeds[0] if speeds else F(0))
        return Motion(*numbers, tuple(pieces))


def holds(text: str, sv: Car, pov: Car) -> bool:
    drive = Drive({"SV": sv.motion, "POV": pov.motion})
    formula = read_claim(LIBRARY.select(), text).formula
    return judge(bind(formula, ROAD, {"L": "main-1"}, default_values(LIBRARY)), drive).holds


def ahead(gap: str, **more: object) -> Car:
    """A car whose rear is ``gap`` ahead of a front at 0."""
    return Car(s=F(gap) + F(9, 2), **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "gap", "expected"),
    [
        *(("nearByTTC", gap, truth) for gap, truth in (("0", 1), ("39.9", 1), ("40", 0), ("-0.1", 0))),
        *(("nearByTHW", gap, truth) for gap, truth in (("0", 1), ("59.9", 1), ("60", 0), ("-0.1", 0))),
        *(("nearByDistance", gap, truth) for gap, truth in (("0", 1), ("100", 1), ("100.1", 0), ("-0.1", 0))),
    ],
)
def test_what_is_near(name: str, gap: str, expected: int) -> None:
    """SV comes closer by 10 m/s; 4 s to a collision, 2 s of headway at 30 m/s, 100 m."""
    assert holds(f"{name}(SV, POV)", Car(v=30), ahead(gap)) == bool(expected)
    assert not holds(f"{name}(POV, SV)", Car(v=30), ahead(gap))


def test_a_slower_vehicle_reaches_nobody() -> None:
    assert not holds("nearByTTC(SV, POV)", Car(v=20), ahead("1"))
    assert not holds("nearByTTC(SV, POV)", Car(v=15), ahead("1"))


@pytest.mark.parametrize(
    ("sv", "pov", "expected"), [(0, 1, True), (1, 0, False), (0, 0, False), (1, 1, False)]
)
def test_outside_the_lane(sv: int, pov: int, expected: bool) -> None:
    cars = (Car(d=(RIGHT, LEFT)[sv]), ahead("30", d=(RIGHT, LEFT)[pov]))
    assert holds("outsideLane(POV, SV, L)", *cars) == expected


@pytest.mark.parametrize(
    ("across", "expected"),
    [
        ((("3", "0.2"),), True),
        ((("3", "-0.2"),), True),
        ((("3", "0.1"),), False),
        ((("3", "-0.1"),), False),
        ((("0.5", "0.2"),), False),
        ((("0.5", "0.2"), ("0.5", "-0.2")), False),
        ((("1.1", "0.2"), ("1.1", "-0.2")), True),
        ((), False),
    ],
)
def test_drifting(across: tuple[tuple[str, str], ...], expected: bool) -> None:
    """To one side faster than 0.1 m/s for a second."""
    assert holds("drifts(POV)", Car(), ahead("30", across=across)) == expected


@pytest.mark.parametrize(
    ("sv", "pov", "expected"),
    [
        (Car(v=30), ahead("30", a=-1), True),
        (Car(v=30, a=-1), ahead("30", a=-1), True),
        (Car(v=30, a=1), ahead("30", a=-1), False),
        (Car(v=30), ahead("30"), False),
        (Car(v=20), ahead("30", a=-1), False),
    ],
)
def test_braking_alone(sv: Car, pov: Car, expected: bool) -> None:
    assert holds("brakesAlone(POV, SV)", sv, pov) == expected


CHANGE = (("3.4", "-1"),)
STAYS = (("0.5", "-1"),)
ONCE_NEAR = {"ttc": "40", "thw": "60", "free": "100"}


@pytest.mark.parametrize("kind", ["ttc", "thw", "free"])
def test_a_cut_in_ends_near_within_a_second(kind: str) -> None:
    """POV is in L after 0.85 s, and the gap shrinks by 10 m each second for good."""

    def cut_in(gap: float, across: tuple[tuple[str, str], ...] = CHANGE, **sv: object) -> bool:
        pov = ahead(str(gap), d=LEFT, across=across)
        return holds(f"cutIn_{kind}(SV, POV, L)", Car(v=30, **sv), pov)  # type: ignore[arg-type]

    near = float(ONCE_NEAR[kind])
    assert cut_in(near / 2)
    assert cut_in(near + 15)  # near less than a second after it is still outside
    assert not cut_in(near + 25)  # near only later
    assert not cut_in(near / 2, across=STAYS)
    assert not cut_in(-30)
    assert not cut_in(near / 2, d=LEFT)  # SV is not in L
    leaves = holds(f"cutIn_{kind}(POV, SV, L)", Car(s=40, d=LEFT, v=20, across=CHANGE), Car(v=30))
    assert leaves  # the same with names exchanged


@pytest.mark.parametrize("kind", ["ttc", "thw", "free"])
def test_a_cut_in_may_be_near_at_once_and_for_a_moment_only(kind: str) -> None:
    """POV is in L after 0.2 s, 3 m ahead, and is passed at 0.5 s."""
    pov = ahead("5", d=F(11, 2), across=(("1.5", "-1"),))
    assert holds(f"cutIn_{kind}(SV, POV, L)", Car(v=30), pov)


def test_who_does_not_drift_does_not_cut_in_freely() -> None:
    """Half a second at 1.8 m/s ends in L as well."""
    quick = (("0.6", "-1.8"),)
    assert holds("cutIn_ttc(SV, POV, L)", Car(v=30), ahead("30", d=LEFT, across=quick))
    assert not holds("cutIn_free(SV, POV, L)", Car(v=30), ahead("30", d=LEFT, across=quick))


@pytest.mark.parametrize(("kind", "near"), [("ttc", "30"), ("thw", "50")])
def test_hard_braking_near(kind: str, near: str) -> None:
    def brakes(gap: str, a: str = "-3", d: F = RIGHT) -> bool:
        pov = ahead(gap, a=a, d=d, brakes=F(1, 10))
        return holds(f"decel_{kind}(SV, POV, L)", Car(v=30), pov)

    assert brakes(near)
    assert not brakes(near, a="-2.9")
    assert not brakes(near, d=LEFT)
    assert not brakes("99")


def test_braking_ahead_for_a_second() -> None:
    def brakes(gap: str, seconds: str, d: F = RIGHT, v: int = 30) -> bool:
        pov = ahead(gap, a=-1, d=d, brakes=F(seconds))
        return holds("decel_free(SV, POV, L)", Car(v=v), pov)

    assert brakes("60", "1.1")
    assert not brakes("60", "0.9")
    assert not brakes("120", "1.1")
    assert not brakes("60", "1.1", d=LEFT)
    assert not brakes("60", "1.1", v=15)


def test_parameters_have_their_bounds() -> None:
    bounds = {name: LIBRARY.bounds[name] for name in ("ttcLimit", "thwLimit", "farthest", "hardBraking")}
    assert set(bounds.values()) == {">"}
    assert {LIBRARY.bounds[name] for name in ("leastDrift", "cutInTime", "brakeTime")} == {">="}
