"""The paper's Table of formulas and its definitions, written a second time by hand as formula trees.

Nothing here reads a specification text: tests compare what the library elaborates to with this.
Vehicles are SV and POV (POV1, POV2 in rows 2, 10 and 18) and the lane is L.
"""

from fractions import Fraction

from roadproof.logic import terms as t
from roadproof.logic.formula import (
    FOREVER,
    ZERO,
    Always,
    And,
    Compare,
    Domain,
    Eventually,
    Formula,
    Interval,
    Not,
    Occupies,
    Or,
    Some,
    Until,
)
from roadproof.logic.terms import Term

ACCELERATION, SECONDS, METRES = (1, -2), (0, 1), (1, 0)
RHO = t.Parameter("rho", SECONDS)
A_MAX, B_MIN, B_MAX = (t.Parameter(name, ACCELERATION) for name in ("a_max", "b_min", "b_max"))
A_LAT, B_LAT = (t.Parameter(name, ACCELERATION) for name in ("a_max_lat", "b_min_lat"))
NOUGHT = t.Number(Fraction(0), (0, 0))
TWO = t.number(2)


def s(a: str) -> Term:
    return t.Signal("s", a)


def d(a: str) -> Term:
    return t.Signal("d", a)


def v(a: str) -> Term:
    return t.Signal("v_lon", a)


def to_the_right(a: str) -> Term:
    """Lateral velocity as RSS counts it; our d grows to the left (semantics §3)."""
    return t.negate(t.Signal("v_lat", a))


def plus(*parts: Term) -> Term:
    total, *others = parts
    for part in others:
        total = t.Sum((total, part))
    return total


def times(left: Term, right: Term) -> Term:
    return t.Product((left, right))


def square(term: Term) -> Term:
    return t.Power(term, 2)


def d_rss_lon(rear: str, front: str) -> Term:
    """Eq. lon_RSS."""
    distance = plus(
        times(v(rear), RHO),
        t.Quotient(times(A_MAX, square(RHO)), TWO),
        t.Quotient(square(plus(v(rear), times(A_MAX, RHO))), times(TWO, B_MIN)),
        t.negate(t.Quotient(square(v(front)), times(TWO, B_MAX))),
    )
    return t.Maximum((NOUGHT, distance))


def d_rss_lat(left: str, right: str) -> Term:
    """Eq. lat_RSS with the arguments of semantics §3."""
    one, two, gain = to_the_right(left), to_the_right(right), times(RHO, A_LAT)
    distance = plus(
        times(t.subtract(one, two), RHO),
        times(A_LAT, square(RHO)),
        t.Quotient(plus(square(plus(one, gain)), square(t.subtract(two, gain))), times(TWO, B_LAT)),
    )
    return t.Maximum((NOUGHT, distance))


def danger_ahead(a: str, b: str) -> Formula:
    gap = t.subtract(s(b), s(a))
    return And((Compare(gap, ">=", NOUGHT), Compare(gap, "<=", plus(t.Size("length", b), d_rss_lon(a, b)))))


def danger_left(a: str, b: str) -> Formula:
    gap = t.subtract(d(b), d(a))
    return And((Compare(gap, ">=", NOUGHT), Compare(gap, "<=", plus(t.Size("width", b), d_rss_lat(b, a)))))


def violation(a: str, b: str) -> Formula:
    along = Or((danger_ahead(a, b), danger_ahead(b, a)))
    across = Or((danger_left(a, b), danger_left(b, a)))
    return And((along, across))


def up_to(parameter: str) -> Interval:
    return Interval(ZERO, t.Parameter(parameter, SECONDS))


def danger(a: str, b: str) -> Formula:
    return Always(up_to("minDanger"), violation(a, b))


def init_safe(a: str, b: str) -> Formula:
    return Always(up_to("minSafe"), Not(violation(a, b)))


def eventually(body: Formula) -> Formula:
    return Eventually(FOREVER, body)


def until(left: Formula, right: Formula) -> Formula:
    return Until(left, FOREVER, right)


def danger_arises(a: str, b: str) -> Formula:
    return eventually(And((init_safe(a, b), eventually(danger(a, b)))))


def at_lane(a: str, lane: str = "L") -> Formula:
    return Some("l", Domain("lanelets", lane), Occupies(a, "l"))


def in_zone(zone: str, a: str) -> Formula:
    return Some("l", Domain("zone", zone), Occupies(a, "l"))


def same_lane(a: str, b: str) -> Formula:
    return And((at_lane(a), at_lane(b)))


def adjacent(a: str, b: str) -> Formula:
    return And((at_lane(a), Some("M", Domain("adjacent", "L"), at_lane(b, "M"))))


class Table:
    """Rows 1 to 24 of the Table of formulas for one of the three spec sets."""

    def __init__(self, set_name: str) -> None:
        self.by_acceleration = set_name in ("extA", "ext")
        self.by_fronts = set_name == "ext"

    def ahead(self, a: str, b: str) -> Formula:
        """aheadOf(a, b): b is ahead of a."""
        if self.by_fronts:
            return Compare(s(a), "<", s(b))
        return Compare(s(a), "<=", t.subtract(s(b), t.Size("length", b)))

    def accel(self, a: str, b: str) -> Formula:
        """POV a, SV b: a is faster than b."""
        return And((self._or_accelerates(Compare(v(b), "<", v(a)), a, ">"), at_lane(a)))

    def decel(self, a: str, b: str) -> Formula:
        return And((self._or_accelerates(Compare(v(a), "<", v(b)), a, "<"), at_lane(a)))

    def _or_accelerates(self, faster: Formula, a: str, op: str) -> Formula:
        if not self.by_acceleration:
            return faster
        way = t.Signal("a_lon", a)
        return Or((faster, Compare(way, ">" if op == ">" else "<", NOUGHT)))

    def cut_in(self) -> Formula:
        there = same_lane("SV", "POV")
        goal = there if self.by_fronts else And((there, self.ahead("SV", "POV")))
        then = eventually(And((danger("SV", "POV"), Eventually(up_to("minDanger"), goal))))
        return And((Not(same_lane("POV", "SV")), then))

    def cut_out(self) -> Formula:
        gone = Eventually(up_to("minDanger"), Not(at_lane("POV")))
        return And((same_lane("POV", "SV"), eventually(And((danger("POV", "SV"), gone)))))

    def row(self, i: int) -> list[Formula]:
        """initialCondition (left out where it is true), behaviourSV, behaviourPOV of rows 1 to 8."""
        dangerous = danger("SV", "POV")
        keeps = until(at_lane("SV"), dangerous)
        leaves = And((at_lane("SV"), eventually(Not(at_lane("SV")))))
        enters = And((Not(at_lane("SV")), eventually(at_lane("SV"))))
        near = Or((same_lane("SV", "POV"), adjacent("SV", "POV")))
        faster = until(self.accel("POV", "SV"), dangerous)
        slower = until(self.decel("POV", "SV"), dangerous)
        behind, before = self.ahead("POV", "SV"), self.ahead("SV", "POV")
        match i:
            case 1:
                return [keeps, self.cut_in()]
            case 2:
                return self._three_vehicles()
            case 3:
                return [And((behind, near)), keeps, faster]
            case 4:
                return [And((before, near)), keeps, slower]
            case 5:
                return [leaves, self.cut_in()]
            case 6:
                return [leaves, self.cut_out()]
            case 7:
                return [behind, enters, faster]
            case 8:
                return [And((same_lane("SV", "POV"), before)), leaves, slower]
        raise AssertionError(i)

    def _three_vehicles(self) -> list[Formula]:
        all_three = And((same_lane("SV", "POV1"), same_lane("POV1", "POV2")))
        start = And((all_three, self.ahead("SV", "POV1"), self.ahead("POV1", "POV2")))
        keeps = until(at_lane("SV"), Not(same_lane("SV", "POV1")))
        leaves = And((at_lane("POV1"), eventually(Not(at_lane("POV1")))))
        goal = And((Not(same_lane("POV2", "POV1")), danger("SV", "POV2")))
        return [start, keeps, And((leaves, until(at_lane("POV2"), goal)))]

    def sector(self, i: int, others: list[str]) -> Formula:
        everybody = ["SV", *others]
        if i <= 8:
            return And(tuple(in_zone("main", a) for a in everybody))
        zone = "merge" if i <= 16 else "depart"
        return Or(tuple(in_zone(zone, a) for a in everybody))

    def scenario(self, i: int) -> Formula:
        row = (i - 1) % 8 + 1
        others = ["POV1", "POV2"] if row == 2 else ["POV"]
        safe = [init_safe("SV", other) for other in others]
        start = safe[0] if len(safe) == 1 else And(tuple(safe))
        return And((start, self.sector(i, others), And(tuple(self.row(row)))))
