"""Values of the parameters and options that ``driver.spec`` declares, typed."""

from collections.abc import Mapping
from dataclasses import fields
from fractions import Fraction
from functools import cached_property
from typing import Literal

from roadproof.extensions.drivers.braking import Joined
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class _Parameters:
    """Parameters of driver models that have a formula, as ``driver.spec`` declares them (SI)."""

    cc_wander: Fraction
    cc_evaluation: Fraction
    cc_drift: Fraction
    cc_delay: Fraction
    cc_ramp: Fraction
    cc_braking: Fraction
    aeb_braking: Fraction
    cc_ttc: Fraction
    cc_hard: Fraction
    r157_delay: Fraction
    r157_braking: Fraction
    r157_past: Fraction
    eu1426_ramp: Fraction
    eu1426_delay: Fraction
    eu1426_braking: Fraction
    rho: Fraction
    a_max: Fraction
    b_min: Fraction

    @property
    def reaction(self) -> Fraction:
        """The time from perception to braking of the careful driver (s)."""
        return self.cc_evaluation + self.cc_delay


@dataclass(frozen=True)
class _Options:
    """Options of the careful driver, as ``driver.spec`` declares them."""

    cc_perception: Literal["time", "distance", "overlap"]
    cc_gate: Literal["none", "before_perception", "before_delay"]
    cc_threshold: Literal["any", "hard"]
    cc_aeb: Joined


PARAMETERS: tuple[str, ...] = tuple(x.name for x in fields(_Parameters))
"""The parameters of ``driver.spec`` with which models move."""
OPTIONS: tuple[str, ...] = tuple(x.name for x in fields(_Options))
"""The options of ``driver.spec``."""


@dataclass(frozen=True)
class DriverSettings:
    """Values of all parameters (SI) and options of a specification."""

    values: Mapping[str, Fraction]
    options: Mapping[str, str]

    @cached_property
    def parameters(self) -> _Parameters:
        """The parameters of the models of ``driver.spec``."""
        return _Parameters(**{x: self.values[x] for x in PARAMETERS})

    @cached_property
    def choices(self) -> _Options:
        """The options of the models of ``driver.spec``."""
        return _Options(**{x: self.options[x] for x in OPTIONS})  # type: ignore[arg-type]
