"""Drives that are given, not looked for: motions out of pieces, judged as all others are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Unpack

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.settings import as_road, positive
from roadproof.frontends.settings import questions as settings
from roadproof.frontends.settings.keywords import MotionKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.value_types import RoadLike
from roadproof.library.bind import Number, exact, used_values, values_with
from roadproof.library.roles import assign_roles
from roadproof.library.scenarios import LANE, Scenario, name_of, vehicles_of
from roadproof.world.drive import Drive, Motion, pieces_of
from roadproof.world.signals import KINDS

_ALONG, _ACROSS = ("s", "m/s^2", "m/s^3"), ("s", "m/s^2")


@takes(settings.MotionSettings)
def motion(
    s: Number,
    d: Number,
    v_lon: Number,
    v_lat: Number = 0,
    along: Iterable[Sequence[Number]] = (),
    across: Iterable[Sequence[Number]] = (),
    **box: Unpack[MotionKeywords],
) -> Motion:
    """Return the motion of a vehicle from the place (m) and speed (m/s) of its front-left corner at time 0.

    ``along``: durations (s), each with the acceleration at its start (m/s^2) and the jerk (m/s^3), one after
    the other; ``across``: durations with an acceleration. After them there is none. ``length``, ``width`` (m)
    and ``kind``: of its box. Numbers are exact, and floats the decimals that Python shows. Raises
    ``InputError``, ``UsageError``.

    >>> motion(0, 2.6, 30, along=[(1, 0, -4), (2, -4, 0)]).pieces[1].a_lon
    Fraction(-4, 1)
    """
    given = settings.MotionSettings.of(box)
    if given.kind is not None and given.kind not in KINDS:
        raise UsageError(f"kind={given.kind!r}: write {', '.join(KINDS)}, or leave it out")
    try:
        pieces = pieces_of(
            [(a, b, c) for a, b, c in _read("along", along, _ALONG)],
            [(a, b) for a, b in _read("across", across, _ACROSS)],
        )
        return Motion(
            exact("length", given.length, "m"),
            exact("width", given.width, "m"),
            exact("s", s, "m"),
            exact("d", d, "m"),
            exact("v_lon", v_lon, "m/s"),
            exact("v_lat", v_lat, "m/s"),
            pieces,
            given.kind,
        )
    except ValueError as error:
        raise UsageError(f"motion: {error}") from None


def _read(name: str, entries: Iterable[Sequence[Number]], units: Sequence[str]) -> list[list[Fraction]]:
    rows = []
    for entry in entries:
        if isinstance(entry, str) or len(entry) != len(units):
            raise UsageError(
                f"{name}: {entry!r} is not an entry: each has {len(units)} numbers, {', '.join(units)}"
            )
        rows.append([exact(name, value, unit) for value, unit in zip(entry, units, strict=True)])
    return rows


def drive(
    what: What,
    vehicles: Mapping[str, Motion],
    using: Definitions | None = None,
    road: RoadLike | None = None,
    lanes: Mapping[str, str] | None = None,
    horizon: Number = 6,
    collisions: bool = False,
) -> JudgedDrive:
    """A drive out of ``vehicles`` by name (``motion``), on which ``what`` holds; the judge says so.

    Vehicles of a scenario by number may have names of their own, such as Ego, as for ``monitor``.
    ``road``: that of the formula where None; ``lanes``: free lanes, each any lane of the road on which it
    holds where it is left out; ``horizon``: up to when boxes have to be apart (s), unless ``collisions``.
    Limits of vehicles are not asked for (``judge.replay.first_breach`` is). Raises ``InputError`` with the
    judge's reason where it does not hold, ``UsageError``, ``TextError``.
    """
    from roadproof.engines.search.question import assignments
    from roadproof.engines.search.usual_road import usual_road

    home = definitions_of(using)
    for name, moved in vehicles.items():
        if not isinstance(moved, Motion):
            raise UsageError(f"vehicles[{name!r}]={moved!r}: write what rp.motion returns")
    scenario, query = home.numbered(what, vehicles)
    if scenario is not None and not {*query.vehicles} <= {*vehicles}:
        roles = assign_roles([*vehicles], query.vehicles, {}, "drive: vehicles")
        known = vehicles_of(home.specification, Scenario(scenario, home.specification.set_name))
        query = home.numbered(
            f"{name_of(scenario)}({', '.join((*roles.names_in_file(known), LANE))})", vehicles
        )[1]
    place = usual_road(query.formula) if road is None else as_road(road)
    end = positive("horizon", horizon, "s")
    parameters = used_values(home.library, query.formula, values_with(home.library, home.values))
    try:
        moving = Drive(vehicles)
    except ValueError as error:
        raise UsageError(f"drive: {error}") from None
    refused: RejectedError | None = None
    for chosen in assignments(query, place, dict(lanes or {})):
        here = home.specification
        fields = (query.text, end, chosen, parameters, here.options, place, moving, collisions)
        try:
            return JudgedDrive(DriveFile(scenario, here.set_name, *fields), home.library)
        except RejectedError as error:
            refused = refused or error
    assert refused is not None  # every road has a lane
    raise refused
