"""The options of all commands that run a controller."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.extensions.catalogue.settings import driver_models_or_none
from roadproof.frontends.settings.option import Settings, option, search
from roadproof.frontends.settings.readers import decimal, seconds
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from roadproof.library.bind import Number

COLLISION = "G not collision(SV, POV)"


@dataclass(frozen=True, kw_only=True)
class ControllerRuns(Settings):
    """Requirements on a controller, the driver models beside it, and its clock."""

    require: Iterable[str] = option(
        (COLLISION,),
        "--require 'G FORMULA'",
        f"requirement on SV; may be repeated (default: {COLLISION})",
        gather=tuple,
    )
    drivers: Iterable[str] | None = option(
        None,
        "--drivers MODELS",
        "driver models put in the place of SV in a failing drive: careful,r157, or none (default: all)",
        read=driver_models_or_none,
    )
    step: Number = search(
        Fraction(1, 10),
        "--step S",
        "seconds between questions to the controller (default: 0.1)",
        read=seconds,
        rare=True,
    )
    seconds: Number = search(
        Fraction(10), "--seconds S", "length of a simulation (default: 10)", read=seconds, rare=True
    )
    patience: float = search(
        10.0,
        "--patience S",
        "seconds that the controller may take for a simulation or a reply (default: 10)",
        read=decimal,
        rare=True,
    )
