"""The questions that a driver model asks of a scene, and its response.

A scene is a drive, samples, or initial values of a plate. It answers from its own motion, so no value of one
instant is extrapolated in a test.
"""

from fractions import Fraction
from typing import Protocol

from roadproof.runtime.records import dataclass

Phase = tuple[Fraction | None, Fraction, Fraction]
"""A part of a motion along the road: its duration (s, None for ever), acceleration (m/s²) and jerk (m/s³)."""


class Scene(Protocol):
    """A test from the instant on at which its scenario holds; times are in s from the start of the test.

    Every method returns the first such instant, or None where there is none.
    """

    @property
    def start(self) -> Fraction:
        """The instant at which the scenario holds."""

    def offset(self, metres: Fraction) -> Fraction | None:
        """Return when the centre of the first POV is so far from its lane's, towards SV in a cut-in."""

    def beside(self) -> Fraction | None:
        """Return when the boxes of SV and POV begin to overlap across the road."""

    def past_marking(self, metres: Fraction) -> Fraction | None:
        """Return when the side of POV is so far past the marking of SV's lane."""

    def wrapped(self) -> Fraction | None:
        """Return when, across the road, one of the boxes of SV and POV is within the other."""

    def closing(self, seconds: Fraction, since: Fraction) -> Fraction | None:
        """Return when the time to collision is so short, from ``since`` on."""

    def braking(self, least: Fraction) -> Fraction | None:
        """Return when POV, ahead of SV and in its way, brakes by at least so much (m/s²), or at all for 0."""


@dataclass(frozen=True)
class Response:
    """The response of SV: as in the test until ``onset`` (s), then by ``phases``, until it stands."""

    onset: Fraction
    phases: tuple[Phase, ...]
