"""What is exported: a drive, its name, and how densely it is sampled where a format has samples."""

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.scenarios import vehicle_order
from roadproof.recordings.export.layout import Layout, lay_out, span_of
from roadproof.world.drive import Motion
from roadproof.world.motion import State, advance, starts_of
from roadproof.world.signals import Kind

TRUCK_LENGTH = 7
"""A vehicle longer than that (m) is a truck, as in recordings."""
WRITTEN = "1970-01-01"
"""The date in files that must have one: a drive has none, and the same drive gives the same file."""
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


@dataclass(frozen=True)
class Subject:
    """The drive of ``file``; ``name`` is that of its files, ``number`` its place among the exported.

    ``rate``: samples a second.
    """

    name: str
    number: int
    file: DriveFile
    rate: int = 25

    @cached_property
    def vehicles(self) -> dict[str, Motion]:
        """The motions by name, SV first."""
        return {name: self.file.drive.vehicles[name] for name in vehicle_order(self.file.drive.vehicles)}

    @cached_property
    def ids(self) -> dict[str, int]:
        """What vehicles are called where names are numbers."""
        return {name: number for number, name in enumerate(self.vehicles, 1)}

    @cached_property
    def layout(self) -> Layout:
        """The road, cut to where the drive goes. Raises ``InputError``."""
        return lay_out(self.file.road, span_of([*self.vehicles.values()], self.file.horizon))

    @cached_property
    def times(self) -> list[Fraction]:
        """The times (s) of the samples, from 0 up to the horizon."""
        return [Fraction(k, self.rate) for k in range(int(self.file.horizon * self.rate) + 1)]

    @cached_property
    def samples(self) -> dict[str, list[State]]:
        """The states of each vehicle at the times of the samples."""
        return {name: [*_states(motion, self.times)] for name, motion in self.vehicles.items()}

    @property
    def said(self) -> str:
        """What it is a drive of, for the heading of a file."""
        what = self.file.formula if self.file.scenario is None else f"scenario {self.file.scenario}"
        return f"{what} ({self.file.set_name}), {self.file.horizon} s, {self.layout.said}"


def subject_of(name: str, number: int, file: DriveFile, rate: int) -> Subject:
    """A subject that every format can have.

    Raises ``InputError`` where there is no vehicle, or one whose name is no plain word, ``UsageError`` for a
    rate whose steps are no decimals or longer than the drive.
    """
    if not file.drive.vehicles:
        raise InputError(f"{name}: the drive has no vehicle, so there is nothing to export")
    for vehicle in file.drive.vehicles:
        if not _NAME.fullmatch(vehicle):
            raise InputError(f"{name}: vehicle {vehicle[:40]!r}: other tools want letters, digits and _ only")
    if not 1 <= rate <= 1000 or 10**9 % rate:
        raise UsageError(f"rate={rate}: write samples a second up to 1000, such as 10, 25, 50 or 100")
    if file.horizon * rate < 1:
        raise UsageError(
            f"rate={rate}: {name} lasts {file.horizon} s, less than a step; write a greater rate"
        )
    return Subject(name, number, file, rate)


def _states(motion: Motion, times: list[Fraction]) -> Iterator[State]:
    starts = starts_of(motion)
    for time in times:
        begun = starts[bisect_right(starts, time, key=lambda state: state.time) - 1]
        yield advance(begun, time - begun.time)


def kind_of(motion: Motion) -> Kind:
    """What the drive says that it is; where it says nothing, ``car`` or ``truck``."""
    if motion.kind is not None:
        return motion.kind
    return "car" if motion.length <= TRUCK_LENGTH else "truck"


def class_of(motion: Motion) -> str:
    """As recordings have it that know two classes: ``Car`` or ``Truck``."""
    return "Truck" if kind_of(motion) in ("truck", "bus") else "Car"
