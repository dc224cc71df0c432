"""Emergency braking for `roadproof falsify`: a good one, and one that is 0.4 s late."""


class Aeb:
    """Brakes fully as soon as hard braking is needed to stay clear of a vehicle."""

    late = 0.0

    def reset(self, observation):
        self.since = None

    def step(self, observation, dt):
        me = observation.me
        if self.since is None and any(needed(me, x) > 5 for x in observation.others if comes(me, x)):
            self.since = observation.time
        if self.since is None or observation.time < self.since + self.late - 1e-9:
            return 0.0
        return -9.0


class LateAeb(Aeb):
    late = 0.4


def comes(me, other):
    """Return whether another vehicle ahead is in the way, or drifts into it."""
    apart = max(other.d - other.width - me.d, me.d - me.width - other.d)
    left = other.d > me.d
    nearing = -(other.v_lat - me.v_lat) if left else other.v_lat - me.v_lat
    return other.s > me.s and (apart <= 0 or nearing > 0.1)


def needed(me, other):
    """Return the braking (m/s^2) that keeps clear of another vehicle, which goes on as it does now."""
    gap = other.s - other.length - me.s - 1.0
    closing = me.v_lon - other.v_lon
    if gap <= 0:
        return 99.0 if closing > 0 else 0.0
    if other.a_lon < 0:
        stopped = me.v_lon**2 / (2 * (gap + other.v_lon**2 / (2 * -other.a_lon)))
        if me.v_lon * -other.a_lon >= other.v_lon * stopped:  # the other vehicle stands first
            return stopped
    return max(0.0, closing) ** 2 / (2 * gap) + max(0.0, -other.a_lon) * (closing > 0)
