"""Roads and vehicles from TOML files; every contradiction is refused with file, name and rule.

Numbers may be written as TOML numbers or as text (``"9/2"``), and are read exactly. A lanelet of a road has
``id``, ``lane``, ``zone``, ``attribute``, ``s = [from, to]`` (``-inf``, ``inf`` for unbounded) and ``d =
[right, left]``. Lanes that share a boundary are adjacent (semantics §4).
"""

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias, cast, get_args

from roadproof.errors import InputError
from roadproof.extension import entries, import_entry
from roadproof.runtime.files import read_text
from roadproof.runtime.package_data import shipped_folder
from roadproof.world.lanelet_rules import check_lanelets, shared_boundaries
from roadproof.world.road import Attribute, Lanelet, Road, Zone, adjacency
from roadproof.world.signals import KINDS, LIMITED, Kind
from roadproof.world.vehicle import Range, Vehicle

LARGEST_MODEL = 1_000_000
Content: TypeAlias = Mapping[str, object]


def names_of(kind: str) -> tuple[str, ...]:
    """Return the names of the bundled models of a kind (``roads`` or ``vehicles``), sorted."""
    return tuple(sorted(p.stem for p in (shipped_folder("models") / kind).glob("*.toml")))


def load_road(name_or_path: str | Path) -> Road:
    """Load a bundled road by name, or a file by path: TOML, or a stretch of a map (``MAP#STRETCH``).

    Raises ``InputError``; ``UsageError`` for a stretch that is not well specified.
    """
    text = str(name_or_path)
    if "." in text:  # no name of a bundled road
        reader = entries("roads").get(Path(text.partition("#")[0]).suffix)
        if reader is not None:
            road: Road = import_entry(reader)(text)
            return road
    return load_recorded_road(name_or_path)[0]


def load_recorded_road(name_or_path: str | Path, directions: tuple[int, ...] = ()) -> tuple[Road, int]:
    """Load the road of a recording and its driving direction: one of ``directions``, by default the first.

    Without ``directions``, the file must not name one, and 0 is returned. Raises ``InputError``.
    """
    path, content = _read("roads", name_or_path)
    _refuse_others(
        content, {"lanelet", "adjacent", "name", *(["direction"] if directions else [])}, f"{path}"
    )
    way = content.get("direction", directions[0] if directions else 0)
    direction = next((x for x in directions or (0,) if x == way and not isinstance(way, bool)), None)
    if direction is None:
        shown = " or ".join(map(str, directions))
        raise InputError(f"{path}: direction={way!r}, but it must be {shown}")
    entries = content.get("lanelet")
    if not isinstance(entries, list) or not entries:
        raise InputError(f"{path}: a road needs at least one [[lanelet]]")
    lanelets = tuple(_lanelet(entry, f"{path}, lanelet {k + 1}") for k, entry in enumerate(entries))
    check_lanelets(lanelets, str(path))
    adjacent = shared_boundaries(lanelets)
    if "adjacent" in content:
        _check_declared(content.get("adjacent"), adjacent, str(path))
    return Road(str(content.get("name", path.stem)), lanelets, adjacent), direction


def load_vehicle(name_or_path: str | Path) -> Vehicle:
    """Load a bundled vehicle by name, or a file by path. Raises ``InputError``."""
    path, content = _read("vehicles", name_or_path)
    optional = ("name", "kind", "a_bend")
    fields = [field.name for field in dataclasses.fields(Vehicle) if field.name not in optional]
    _refuse_others(content, {*fields, *optional}, str(path))
    kind = cast(Kind | None, content.get("kind"))
    if kind is not None:
        require_one_of(f"{path}", "kind", kind, KINDS)
    for field in fields:
        if field not in content:
            raise InputError(f"{path}: '{field}' is missing; a vehicle has {', '.join(fields)}")
    lists = [k for k in fields if isinstance(content[k], list)]
    numbers = [k for k in (*fields, "a_bend") if k in content and k not in lists]
    one = {k: _number(content[k], f"{path}, {k}") for k in numbers}
    two = {k: _range(content[k], f"{path}, {k}") for k in lists}
    for field in fields:
        allowed = two if field in (*LIMITED, "cruise") else one
        if field not in allowed:
            raise InputError(f"{path}: {field} must be {'[low, high]' if allowed is two else 'one number'}")
    for field, value in one.items():
        if value <= 0:
            raise InputError(f"{path}: {field}={value}, but it must be greater than 0")
    vehicle = Vehicle(str(content.get("name", path.stem)), **one, **two, kind=kind)  # type: ignore[arg-type]
    (slowest, fastest), cruise = vehicle.v_lon, vehicle.cruise
    if slowest < 0:
        raise InputError(f"{path}: v_lon starts at {slowest}, but a vehicle never reverses: use 0 or more")
    if cruise[0] < slowest or cruise[1] > fastest:
        message = f"cruise={content.get('cruise')} is not inside v_lon={content.get('v_lon')}"
        raise InputError(f"{path}: {message}")
    for field, (low, high) in ((name, two[name]) for name in LIMITED if name != "v_lon"):
        if not low <= 0 <= high:
            message = f"{field}=[{low}, {high}] leaves out 0, so the vehicle could never drive on"
            raise InputError(f"{path}: {message}")
    return vehicle


def read_toml(path: Path) -> Content:
    """Return the content of a file with exact numbers. Raises ``InputError``."""
    import tomllib

    text = read_text(path, LARGEST_MODEL, "divide it, or name another file")
    try:
        return tomllib.loads(text, parse_float=_exact)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{path} is no TOML: {error}") from None


def _read(kind: str, name_or_path: str | Path) -> tuple[Path, Content]:
    path = Path(name_or_path)
    if path.suffix != ".toml" and not path.is_file():
        if len(path.parts) != 1 or str(name_or_path) not in names_of(kind):
            raise InputError(
                f"there is no {kind[:-1]} '{name_or_path}'; there are {', '.join(names_of(kind))}, "
                f"or give the path of a .toml {'or map ' if kind == 'roads' else ''}file"
            )
        path = shipped_folder("models") / kind / f"{name_or_path}.toml"
    return path, read_toml(path)


def _exact(text: str) -> Fraction | float:
    bare = text.replace("_", "")
    if "inf" in bare or "nan" in bare:
        return float(bare)
    if abs(int(bare.lower().partition("e")[2] or 0)) > 30:
        raise InputError(f"the number {text[:40]} is out of range: use exponents from -30 to 30")
    return Fraction(bare)


def require_one_of(where: str, field: str, value: object, allowed: Sequence[object]) -> None:
    """Raise ``InputError`` if a field of a file has none of the allowed values."""
    if value not in allowed:
        raise InputError(f"{where}: {field}={value!r}, but it must be one of {', '.join(map(str, allowed))}")


def _refuse_others(content: Content, known: Iterable[str], where: str) -> None:
    for key in content:
        if key not in known:
            raise InputError(f"{where}: '{key}' is unknown; there are {', '.join(sorted(known))}")


def _number(value: object, where: str) -> Fraction:
    if isinstance(value, str) and len(value) < 100:
        try:
            return Fraction(value)
        except (ValueError, ZeroDivisionError):
            pass
    if isinstance(value, int | Fraction) and not isinstance(value, bool):
        return Fraction(value)
    raise InputError(f"{where}: {value!r} is no finite number")


def _range(value: object, where: str) -> Range:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{where}: {value!r} is no range; write [low, high]")
    low, high = _number(value[0], where), _number(value[1], where)
    if low >= high:
        raise InputError(f"{where}: [{low}, {high}] is empty; the first number must be the smaller one")
    return low, high


def _lanelet(entry: object, where: str) -> Lanelet:
    fields = ("id", "lane", "zone", "attribute", "s", "d")
    if not isinstance(entry, dict):
        raise InputError(f"{where}: write it as [[lanelet]]")
    _refuse_others(entry, fields, where)
    for field in fields:
        if field not in entry:
            raise InputError(f"{where}: '{field}' is missing; a lanelet has {', '.join(fields)}")
    name, lane, zone, attribute, bounds, across = (entry[field] for field in fields)
    require_one_of(where, "zone", zone, get_args(Zone))
    require_one_of(where, "attribute", attribute, get_args(Attribute))
    if not isinstance(bounds, list) or len(bounds) != 2:
        raise InputError(
            f"{where}: s={bounds!r} is no range; write [from, to], with -inf and inf without bound"
        )
    low = None if bounds[0] == float("-inf") else _number(bounds[0], f"{where}, s")
    high = None if bounds[1] == float("inf") else _number(bounds[1], f"{where}, s")
    if low is not None and high is not None and low >= high:
        raise InputError(f"{where}: s=[{low}, {high}] is empty; the first number must be the smaller one")
    return Lanelet(str(name), str(lane), zone, attribute, (low, high), _range(across, f"{where}, d"))


def _check_declared(entries: object, geometric: frozenset[frozenset[str]], where: str) -> None:
    """Raise ``InputError`` if the declared pairs of adjacent lanes differ from the geometry."""
    if not isinstance(entries, list) or not all(isinstance(e, list) and len(e) == 2 for e in entries):
        raise InputError(f"{where}: adjacent={entries!r}; write a list of pairs of lanes")
    declared = adjacency((str(a), str(b)) for a, b in entries)
    for pair in sorted(declared ^ geometric, key=sorted):
        names = " and ".join(sorted(pair))
        wrong = (
            "share a boundary but are not declared adjacent",
            "are declared adjacent but share no boundary",
        )
        raise InputError(
            f"{where}: lanes {names} {wrong[pair in declared]}; correct 'adjacent' or leave it out"
        )
