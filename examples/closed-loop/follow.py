"""Two controllers that follow the vehicle ahead: the Intelligent Driver Model, and an ACC with a delay."""

from collections import deque
from math import sqrt


class Idm:
    """The Intelligent Driver Model (Treiber, Hennecke, Helbing 2000), which keeps its first speed."""

    headway, jam, most, comfortable = 1.2, 2.0, 1.5, 2.5

    def reset(self, observation):
        self.wish = max(1.0, observation.me.v_lon)

    def step(self, observation, dt):
        me, ahead = observation.me, observation.ahead()
        free = 1 - (me.v_lon / self.wish) ** 4
        if ahead is None:
            return self.most * free
        gap, other = ahead
        closing = me.v_lon - other.v_lon
        wished = self.jam + me.v_lon * self.headway
        wished += me.v_lon * closing / (2 * sqrt(self.most * self.comfortable))
        return max(-9.0, self.most * (free - (max(0.0, wished) / max(0.1, gap)) ** 2))


class DelayedAcc:
    """Keeps a time gap of 1.5 s by at most 3.5 m/s^2, and acts on what it saw 0.5 s ago."""

    def reset(self, observation):
        self.seen = deque(maxlen=6)

    def step(self, observation, dt):
        ahead, v = observation.ahead(), observation.me.v_lon
        wish = 0.0
        if ahead is not None:
            gap, other = ahead
            wish = 0.25 * (gap - 3.0 - 1.5 * v) / 1.5 + 0.7 * (other.v_lon - v)
        self.seen.append(min(0.0, max(-3.5, wish)))
        return self.seen[0]
