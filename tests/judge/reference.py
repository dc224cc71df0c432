"""A second, naive reading of STL in dense time: by definition, on finitely many regions of time.

``critical`` are ascending times, the first 0, that contain every switch of every sub-formula; a
region is one of them or the open gap after it, on which nothing changes. Written apart from the
judge: floats or Fractions, no truth sets, no algebraic numbers.
"""

from bisect import bisect_left
from itertools import product

import numpy as np

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import bounds_of


class Reference:
    """Region 2i is the instant critical[i], region 2i+1 the open gap after it.

    ``atom(formula, time)`` is the truth of an atom on the region with representative
    ``time``; times nearer than ``epsilon`` are one.
    """

    def __init__(self, atom, critical, epsilon=0):
        self.atom, self.critical, self.epsilon = atom, critical, epsilon
        self.known = {}

    @property
    def regions(self):
        return range(2 * len(self.critical))

    def sample(self, region):
        i = region // 2
        if region % 2 == 0:
            return self.critical[i]
        if i + 1 == len(self.critical):
            return self.critical[i] + 1
        return (self.critical[i] + self.critical[i + 1]) / 2

    def locate(self, time):
        i = bisect_left(self.critical, time - self.epsilon)
        if i < len(self.critical) and abs(self.critical[i] - time) <= self.epsilon:
            return 2 * i
        return 2 * i - 1

    def holds(self, formula, region):
        key = (formula, region)
        if key not in self.known:
            self.known[key] = self._holds(formula, region)
        return self.known[key]

    def _holds(self, formula, region):
        match formula:
            case f.Truth(value):
                return value
            case f.Not(body):
                return not self.holds(body, region)
            case f.And(parts):
                return all(self.holds(p, region) for p in parts)
            case f.Or(parts):
                return any(self.holds(p, region) for p in parts)
            case f.Eventually(interval, body):
                return any(self.holds(body, r) for r in self._window(interval, region))
            case f.Always(interval, body):
                return all(self.holds(body, r) for r in self._window(interval, region))
            case f.Until(left, interval, right):
                window = self._window(interval, region)
                for r in window:
                    # At the first region the witness is its first instant: nothing lies before it.
                    # In a later gap, some of that gap lies before every instant of it.
                    before = range(window[0], r if r % 2 == 0 else r + 1) if r > window[0] else ()
                    if self.holds(right, r) and all(self.holds(left, x) for x in before):
                        return True
                return False
            case f.Since(left, interval, right):
                past = self._past(interval, region)
                for r in past:
                    # At the last region the witness is its last instant: nothing lies after it.
                    # In an earlier gap, some of that gap lies after every instant of it.
                    after = range(r + 1 if r % 2 == 0 else r, past[-1] + 1) if r < past[-1] else ()
                    if self.holds(right, r) and all(self.holds(left, x) for x in after):
                        return True
                return False
            case f.Application(_, _, body):
                return self.holds(body, region)
            case _:
                return self.atom(formula, self.sample(region))

    def _window(self, interval, region):
        low, high = bounds_of(interval)
        time = self.sample(region)
        last = self.regions[-1] if high is None else self.locate(time + self._number(high))
        return range(self.locate(time + self._number(low)), last + 1)

    def _past(self, interval, region):
        low, high = bounds_of(interval)
        last = self.sample(region) - self._number(low)
        if last < -self.epsilon:
            return range(0)
        first = None if high is None else self.sample(region) - self._number(high)
        begin = 0 if first is None or first <= self.epsilon else self.locate(first)
        return range(begin, self.locate(max(last, 0)) + 1)

    def _number(self, value):
        return value if self.epsilon == 0 else float(value)


def critical_times(formula, of_atom):
    """Every time at which some sub-formula may switch, from those of its atoms."""
    match formula:
        case f.Truth():
            return {0}
        case f.Compare():
            return {0, *of_atom(formula)}
        case f.Eventually(interval, _) | f.Always(interval, _) | f.Until(_, interval, _):
            below = set().union(*(critical_times(c, of_atom) for c in f.children(formula)))
            low, high = bounds_of(interval)
            found = set(below)
            for bound in (low, high):
                if bound is not None:
                    found |= {c - (float(bound) if isinstance(c, float) else bound) for c in below}
            return {c for c in found if c >= 0}
        case f.Since(_, interval, _):
            below = {0}.union(*(critical_times(c, of_atom) for c in f.children(formula)))
            bounds = [bound for bound in bounds_of(interval) if bound is not None]
            later = {c + (float(b) if isinstance(c, float) else b) for b in bounds for c in below}
            return below | later
        case _:
            return set().union({0}, *(critical_times(c, of_atom) for c in f.children(formula)))


# Signals of a drive in floats: numpy polynomials by piece, found by stepping from knot to knot.


def float_pieces(motion):
    """[(start, {signal: coefficients, highest first})]; time since 0."""
    found = []
    time, s, d, v, w = 0.0, *(float(x) for x in (motion.s, motion.d, motion.v_lon, motion.v_lat))
    for piece in motion.pieces:
        a, b, j = float(piece.a_lon), float(piece.a_lat), float(piece.j_lon)
        local = np.poly1d([1, -time])
        found.append(
            (
                time,
                {
                    "s": j / 6 * local**3 + a / 2 * local**2 + v * local + s,
                    "d": b / 2 * local**2 + w * local + d,
                    "v_lon": j / 2 * local**2 + a * local + v,
                    "v_lat": b * local + w,
                    "a_lon": j * local + a,
                    "a_lat": np.poly1d([b]),
                    "j_lon": np.poly1d([j]),
                },
            )
        )
        if piece.duration is not None:
            h = float(piece.duration)
            time += h
            s, v = s + v * h + a * h * h / 2 + j * h**3 / 6, v + a * h + j * h * h / 2
            d, w = d + w * h + b * h * h / 2, w + b * h
    return found


class FloatDrive:
    """Values and switching times of comparisons on a drive, in floats."""

    def __init__(self, drive, epsilon):
        self.drive, self.epsilon = drive, epsilon
        self.pieces = {name: float_pieces(m) for name, m in drive.vehicles.items()}
        self.knots = sorted({start for p in self.pieces.values() for start, _ in p})
        self.doubtful = False

    def polynomials(self, term, time):
        """Every polynomial that ``term`` may follow just after ``time``: one for each way of max, min."""
        match term:
            case t.Number(value, _):
                return [np.poly1d([float(value)])]
            case t.Signal(name, vehicle):
                started = [p for start, p in self.pieces[vehicle] if start <= time + self.epsilon]
                return [started[-1][name]]
            case t.Size(name, vehicle):
                return [np.poly1d([float(getattr(self.drive.vehicles[vehicle], name))])]
            case t.Sum(terms):
                return [
                    sum(c, np.poly1d([0.0])) for c in product(*(self.polynomials(x, time) for x in terms))
                ]
            case t.Product(factors):
                made = []
                for chosen in product(*(self.polynomials(x, time) for x in factors)):
                    result = np.poly1d([1.0])
                    for factor in chosen:
                        result = result * factor
                    made.append(result)
                return made
            case t.Power(base, exponent):
                return [p**exponent for p in self.polynomials(base, time)]
            case t.Quotient(top, bottom):
                bottoms = self.polynomials(bottom, time)
                return [p * (1 / q(0.0)) for p in self.polynomials(top, time) for q in bottoms]
            case t.Maximum(terms) | t.Minimum(terms):
                return [p for x in terms for p in self.polynomials(x, time)]
            case t.Inverse(inner):
                return self.polynomials(inner, time)

    def value(self, term, time):
        match term:
            case t.Maximum(terms):
                return max(self.value(x, time) for x in terms)
            case t.Minimum(terms):
                return min(self.value(x, time) for x in terms)
            case t.Sum(terms):
                return sum(self.value(x, time) for x in terms)
            case t.Product(factors):
                return float(np.prod([self.value(x, time) for x in factors]))
            case t.Power(base, exponent):
                return self.value(base, time) ** exponent
            case t.Quotient(top, bottom):
                return self.value(top, time) / self.value(bottom, time)
            case t.Inverse(inner):
                x = self._settled(self.value(inner, time))
                return float("inf") if x == 0 else 1 / x
            case _:
                return float(self.polynomials(term, time)[0](time))

    def truth(self, compare, time):
        left, right = self.value(compare.left, time), self.value(compare.right, time)
        gap = 0.0 if left == right else self._settled(left - right)
        return {"<": gap < 0, "<=": gap <= 0, ">": gap > 0, ">=": gap >= 0}[compare.op]

    def _settled(self, x):
        """Zero where floats cannot tell; an example that is close to that is doubtful."""
        self.doubtful |= 1e-10 < abs(x) < 1e-7
        return 0.0 if abs(x) <= 1e-10 else x

    def switches(self, compare):
        found = set(self.knots)
        for start, end in zip(self.knots, [*self.knots[1:], float("inf")], strict=True):
            lefts, rights = self.polynomials(compare.left, start), self.polynomials(compare.right, start)
            one = np.poly1d([1.0])
            for p, q in product(lefts, rights):
                for candidate in (p - q, p * q - one, p, q):
                    found |= {r for r in real_roots(candidate) if start <= r < end}
        return found


def real_roots(p):
    """Real roots of a numpy polynomial; a double root counts as one."""
    c = np.trim_zeros(np.where(np.abs(p.coeffs) < 1e-12, 0.0, p.coeffs), "f")
    if len(c) <= 1:
        return []
    if len(c) == 2:
        return [float(-c[1] / c[0])]
    if len(c) == 3:
        under = c[1] ** 2 - 4 * c[0] * c[2]
        if abs(under) < 1e-9:
            under = 0.0
        return [] if under < 0 else [float((-c[1] + s * under**0.5) / (2 * c[0])) for s in (-1, 1)]
    return [float(r.real) for r in np.roots(c) if abs(r.imag) < 1e-5]


def distinct(times, epsilon):
    """Ascending, those nearer than ``epsilon`` as one; and whether some are doubtfully near."""
    kept, doubtful = [], False
    for time in sorted(times):
        if not kept or time - kept[-1] > epsilon:
            doubtful |= bool(kept) and time - kept[-1] < 100 * epsilon
            kept.append(time)
    return kept, doubtful
