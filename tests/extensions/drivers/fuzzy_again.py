"""The fuzzy safety model written again, in m and s, from its formulas; and a drive compared with it.

It shares nothing with roadproof.extensions.drivers.fuzzy, which is in whole numbers of other units.
"""

from fractions import Fraction as F

STEP = F(1, 10)
CHANGE = F(1, 100_000)  # s after a look in which a drive changes its speed; then it keeps it
COMFORT, GREATEST, OTHER, MARGIN, JERK = 4, 6, 7, 2, F("12.65")


def while_reacting(v: F) -> F:
    """How far one goes in the reaction time of 0.75 s; it takes floats as well, as all of this."""
    return v * 3 / 4


def member(distance: F, safe: F, unsafe: F) -> F:
    if safe == unsafe:  # of floats that are nearly the same
        return F(distance < safe)
    return min(1, max(0, (safe - distance) / (safe - unsafe)))


def proactive(distance: F, v: F, w: F) -> F:
    reaches = while_reacting(v) - w**2 / (2 * OTHER)
    return member(distance - MARGIN, reaches + v**2 / (2 * COMFORT) + MARGIN, reaches + v**2 / (2 * GREATEST))


def critical(distance: F, v: F, w: F, a: F) -> F:
    if v <= w:
        return 0
    later = v + while_reacting(max(a, -COMFORT))
    if later <= w:
        return int(2 * abs(a) * distance < (v - w) ** 2)
    reaches = while_reacting((v + later) / 2 - w)
    return member(
        distance, reaches + (later - w) ** 2 / (2 * COMFORT), reaches + (later - w) ** 2 / (2 * GREATEST)
    )


def is_by(distance: F, lengths: F, v: F, w: F, beside: F, lateral: F) -> bool:
    if distance + lengths / 2 < 0:
        return True
    if beside <= 0:
        return False
    if lateral <= 0:
        return True
    if v == w:
        return False
    return 10 * (beside / lateral - (distance + lengths) / (v - w)) > 1


def rounded(a: F) -> F:
    return F((a * 10**6 + F(1, 2)).__floor__(), 10**6)


def accelerations(states, lengths: F, first: int = 0):
    """From (gap, v, w, beside, lateral) at each look: the acceleration until the next."""
    waited, asked, before = 0, F(0), 0
    for look, (gap, v, w, beside, lateral) in enumerate(states):
        now = 0
        if look >= first and not is_by(gap, lengths, v, w, beside, lateral):
            c, p = critical(gap, v, w, before), proactive(gap, v, w)
            if c + p > 0 and waited < 8:
                waited += 1
            elif c + p > 0:
                wanted = rounded(c * (GREATEST - COMFORT) + COMFORT if c > 0 else p * COMFORT)
                asked = min(asked + JERK * STEP, wanted)
                now = -min(asked, v / STEP)
        before = now
        yield now


def motion(vehicle, time: F) -> tuple[F, F, F, F, F]:
    """s, v, a along the road, d and its speed across it."""
    s, v, d, u, left = vehicle.s, vehicle.v_lon, vehicle.d, vehicle.v_lat, time
    for piece in vehicle.pieces:
        t = left if piece.duration is None else min(left, piece.duration)
        s, v = s + v * t + piece.a_lon * t**2 / 2, v + piece.a_lon * t
        d, u = d + u * t + piece.a_lat * t**2 / 2, u + piece.a_lat * t
        left -= t
        if piece.duration is None or t < piece.duration:
            return s, v, piece.a_lon, d, u
    raise AssertionError("the last piece lasts for ever")


def first_difference(drive, first: int = 0, looks: int = 400) -> int | None:
    """The first look at which SV does not do what the model does; None where it always does."""
    ego, other = drive.vehicles["SV"], drive.vehicles["POV2" if "POV2" in drive.vehicles else "POV"]
    times = [STEP * k for k in range(looks)]
    seen = [(motion(ego, t), motion(other, t)) for t in times]
    states = [
        (b[0] - other.length - a[0], a[1], b[1], max(F(0), abs(b[3] - a[3]) - ego.width), abs(b[4]))
        for a, b in seen
    ]
    wanted = accelerations(states, ego.length + other.length, first)
    for k, (a, (state, _)) in enumerate(zip(wanted, seen, strict=True)):
        if state[2] * CHANGE != a * STEP or any(motion(ego, times[k] + x)[2] for x in (CHANGE, STEP / 2)):
            return k
    return None
