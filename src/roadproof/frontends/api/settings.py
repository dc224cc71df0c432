"""The road, vehicles and limits of searches, from keywords in Python."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, get_args

from roadproof.errors import UsageError
from roadproof.library.bind import Number, exact, values_with
from roadproof.library.scenarios import numbers_of, roles
from roadproof.runtime.budget import Effort
from roadproof.world.road import Road

if TYPE_CHECKING:
    from roadproof.engines.setting import Search, SearchOptions, Setting
    from roadproof.frontends.api.definitions import Definitions, What
    from roadproof.frontends.settings.groups import BudgetSettings, SearchPlace
    from roadproof.frontends.settings.value_types import RoadLike, Vehicles
    from roadproof.questions.basis import Basis
    from roadproof.world.vehicle import Vehicle


def setting(using: Definitions, given: SearchPlace) -> Setting:
    """Return the road, vehicles and limits of a search. Raises ``InputError``, ``UsageError``."""
    from roadproof.engines.setting import Setting

    return Setting(
        None if given.road is None else as_road(given.road, given.strict),
        dict(given.lanes or {}),
        models_of(given.vehicles),
        values=values_with(using.library, using.values),
        horizon=positive("horizon", given.horizon, "s"),
        dt=None if given.dt is None else positive("dt", given.dt, "s"),
        reach=positive("reach", given.reach, "m"),
        collisions=given.collisions,
    )


def models_of(vehicles: Vehicles) -> dict[str, Vehicle]:
    """Models of vehicles by name, "" for all. Raises ``InputError``."""
    models = vehicles if isinstance(vehicles, Mapping) else {} if vehicles is None else {"": vehicles}
    if not models:
        return {}
    from roadproof.world.models import load_vehicle  # here: most questions name no model
    from roadproof.world.vehicle import Vehicle

    return {name: x if isinstance(x, Vehicle) else load_vehicle(str(x)) for name, x in models.items()}


def searches_of(
    home: Definitions, what: Sequence[What], place: Setting, search_options: SearchOptions
) -> Iterator[Search]:
    """A search for each formula in each spec set; without any, for all scenarios of the set.

    Raises ``TextError``, ``InputError``, ``UsageError``.
    """
    from roadproof.engines.setting import Search

    for name in home.sets:
        here = replace(home, specification=home.specification.in_set(name))
        for x in what or numbers_of(here.specification):
            scenario, query = here.numbered(x)
            yield Search(here.specification, query, place, search_options, scenario=scenario)


def as_road(road: RoadLike, strict: bool = False) -> Road:
    """A road, from its name or file where it is none yet; ``strict``: no part of its map may be left out.

    Raises ``InputError``.
    """
    from roadproof.world.models import load_road  # here: most questions name no road
    from roadproof.world.not_read import road_not_read_note

    loaded = road if isinstance(road, Road) else load_road(str(road))
    road_not_read_note(loaded, strict)
    return loaded


def positive(name: str, value: Number, unit: str) -> Fraction:
    """A value in SI units that is greater than 0. Raises ``UsageError``, ``InputError``."""
    exact_value = exact(name, value, unit)
    if exact_value <= 0:
        raise UsageError(f"{name}={value}: write a number greater than 0")
    return exact_value


def work_of(given: BudgetSettings) -> Effort:
    """Return the units of work, and the seconds after which the clock ends it. Raises ``UsageError``."""
    for name, value in (("effort", given.effort), ("timeout", given.timeout)):
        if value is not None and not value > 0:
            raise UsageError(f"{name}={value}: write a number greater than 0")
    return Effort(given.effort, given.timeout)


def one_of(name: str, value: str, allowed: Any) -> None:
    """Raises ``UsageError`` where ``value`` is none of the words of the type ``allowed``."""
    if value not in get_args(allowed):
        raise UsageError(f"{name}={value!r}: write {' or '.join(map(repr, get_args(allowed)))}")


def basis_of(home: Definitions, given: BudgetSettings, vehicles: Vehicles = None) -> Basis:
    """Return the basis of analyses; ``given``: work for a drive; ``vehicles``: models, by role or for all.

    Raises ``InputError``, ``UsageError`` for a role that no scenario has.
    """
    from roadproof.questions.basis import Basis

    models = models_of(vehicles)
    known = {name for count in (2, 3) for name in roles(count)}
    for name in models:
        if name and name not in known:
            raise UsageError(f"vehicle {name}: scenarios mention {', '.join(sorted(known))}")
    return Basis(home.specification, home.sets, home.all_values(), effort=work_of(given), vehicles=models)
