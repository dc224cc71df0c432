"""An adapter: a policy that maps numbers to an action, as environments of gymnasium want it, drives SV."""

from math import tanh


def policy(numbers):
    """Return an action from -1 to 1 for gap (m), closing speed and speed (m/s): put a trained policy here."""
    gap, closing, speed = numbers
    return tanh((gap - 5 - 1.5 * speed - 3 * closing) / 10)


class Policy:
    def step(self, observation, dt):
        ahead = observation.ahead()
        gap = 200.0 if ahead is None else ahead[0]
        closing = 0.0 if ahead is None else observation.me.v_lon - ahead[1].v_lon
        return 6 * policy((gap, closing, observation.me.v_lon))
