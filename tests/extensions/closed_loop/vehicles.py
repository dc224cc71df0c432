"""Vehicles under test for tests: good ones, and ones that break the protocol."""

import os
import random
import time


class Coasting:
    def reset(self, observation):
        self.steps = 0

    def step(self, observation, dt):
        self.steps += 1
        return 0.0


class Speeding(Coasting):
    def step(self, observation, dt):
        return 2.0


class Sudden(Coasting):
    """Brakes and steers in ways that meet every limit."""

    def reset(self, observation):
        self.random = random.Random(7)

    def step(self, observation, dt):
        aside = self.random.choice([None, 1.5, -1.5, 0.0, "main-1", "main-2"])
        return self.random.uniform(-14.0, 6.0), aside


class NotANumber(Coasting):
    def step(self, observation, dt):
        return float("nan") if observation.time >= 1 else 0.0


class Wordy(Coasting):
    def step(self, observation, dt):
        return "brake"


class Lost(Coasting):
    def step(self, observation, dt):
        return 0.0, "main-9"


class Raising(Coasting):
    def step(self, observation, dt):
        return 1 / 0


class Sleeping(Coasting):
    def step(self, observation, dt):
        time.sleep(60)
        return 0.0


class Dying(Coasting):
    def step(self, observation, dt):
        os._exit(9)


class Moody(Coasting):
    """Not deterministic: it remembers earlier simulations."""

    calls = 0

    def step(self, observation, dt):
        Moody.calls += 1
        return -(Moody.calls % 7) / 10


class Fickle(Coasting):
    """Not deterministic: it brakes at random, and so is never near a failure."""

    def step(self, observation, dt):
        return random.uniform(-9.0, -5.0)


class Talking(Coasting):
    def reset(self, observation):
        print("reset")

    def step(self, observation, dt):
        print("step")
        return 0.0


class LateBrake(Coasting):
    """Brakes so late that a careful driver would have prevented its collisions."""

    def step(self, observation, dt):
        ahead = observation.ahead()
        return -9.0 if ahead is not None and ahead[0] < 8 else 0.0


class Standing(Coasting):
    """Brakes at once, whatever happens, until it stands."""

    def step(self, observation, dt):
        return -4.0


def coast(observation, dt):
    return 0.0


NOT_CALLABLE = 3


class HardBrake(Coasting):
    def step(self, observation, dt):
        return -9.0
