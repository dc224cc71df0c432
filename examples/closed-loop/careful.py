"""The careful driver of UN R157 as a controller: it perceives, waits, and brakes harder and harder.

`roadproof falsify` puts the exact model beside a failing drive. This one shows how a driver becomes a
controller, and what a clock of ten steps a second costs: up to a step of delay.
"""

WANDER, EVALUATION, DELAY, RAMP, FULL = 0.375, 0.4, 0.75, 0.6, 0.774 * 9.81


class Careful:
    def reset(self, observation):
        self.middle = {}
        for x in observation.others:
            centre = x.d - x.width / 2
            lanes = [y for y in observation.lanes if y.right <= centre <= y.left]
            self.middle[x.name] = (lanes[0].right + lanes[0].left) / 2 if lanes else centre
        self.onset = None

    def step(self, observation, dt):
        if self.onset is None:
            waits = [x for x in (self.wait(observation.me, y) for y in observation.others) if x is not None]
            if waits:
                self.onset = observation.time + min(waits)
        passed = 0.0 if self.onset is None else observation.time - self.onset
        return -FULL * min(1.0, passed / RAMP) if passed > 0 else 0.0

    def wait(self, me, other):
        """Return how long it waits after it perceives a vehicle now; None where it does not."""
        if other.s < me.s:
            return None
        in_way = other.d >= me.d - me.width and me.d >= other.d - other.width
        if in_way and other.a_lon < 0 and other.v_lon < me.v_lon + 1:
            return DELAY
        if abs(other.d - other.width / 2 - self.middle[other.name]) > WANDER:
            return EVALUATION + DELAY
        return None
