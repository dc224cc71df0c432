"""A driver model as one row: its name and source, how it responds, and how answers show it."""

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import TypeAlias

from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.lemmas import Lemmas, lemmas_of_braking
from roadproof.extensions.drivers.manoeuvres import CutIn, ManoeuvreName
from roadproof.extensions.drivers.response import Response, Scene
from roadproof.runtime.records import dataclass

Respond: TypeAlias = Callable[[ManoeuvreName, Scene, DriverSettings], Response | None]
"""Return when and how SV responds to a manoeuvre; None where it never does."""


def _no_speeds(start: CutIn, settings: DriverSettings) -> Iterable[Fraction]:
    return ()


def _never(start: CutIn, settings: DriverSettings) -> bool:
    return False


@dataclass(frozen=True, kw_only=True)
class Law:
    """The response of a driver, stated once: by a formula that the model's definitions state, too.

    ``respond`` is put into plates, tests and recordings. ``ramp`` and ``braking`` are the terms of the
    language for how long its braking grows and for its full braking. The definitions are
    ``unpreventable_MANOEUVRE_NAME`` and ``follows_MANOEUVRE_NAME`` for each manoeuvre of the model, in
    ``driver.spec`` or in the specification named ``specification``, with the further ``parameters`` and
    ``options`` that the law depends on. ``restriction`` is the name of the specification by which
    ``--preventable`` and ``--unpreventable`` take the model: "prevention", or a file of a package that
    ``restriction_file`` writes; None if the model restricts no question.
    """

    respond: Respond
    ramp: str = "0 s"
    braking: str
    restriction: str | None
    specification: str = ""
    parameters: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    lemmas: Lemmas = lemmas_of_braking
    """Why the formula of a manoeuvre is the boundary."""
    speeds: Callable[[CutIn, DriverSettings], Iterable[Fraction]] = _no_speeds
    """The further speeds (m/s) that its definition ``follows_cutIn_NAME`` takes."""
    never_brakes: Callable[[CutIn, DriverSettings], bool] = _never
    """Whether the driver never brakes in a cut-in from these initial values."""


@dataclass(frozen=True, kw_only=True)
class DriverModel:
    """A driver in place of SV.

    ``phrase``: SV under the model in a sentence, with ``{a}`` for its name: "{a}, driven as …,". ``colour``:
    in pictures, and as CSS on pages. ``law``: None for the fuzzy safety model, a controller that looks ten
    times a second and has no formula.
    """

    name: str
    title: str
    source: str
    manoeuvres: tuple[ManoeuvreName, ...]
    phrase: str
    colour: tuple[str, str]
    law: Law | None

    @property
    def is_stepped(self) -> bool:
        """Return whether it is a controller, decided place by place."""
        return self.law is None
