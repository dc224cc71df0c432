"""Options that several sub-commands share, and what they mean."""

import argparse
import json
import re
import sys
from collections.abc import Iterable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.streams import takes_everything
from roadproof.errors import InputError, UsageError
from roadproof.files import whole_file

if TYPE_CHECKING:
    from roadproof.spec.library import Library, Specification

_VALUE = re.compile(r"([+-]?\d{1,30}(?:\.\d{1,30})?(?:/\d{1,30})?)\s*([A-Za-z][A-Za-z/^0-9]*)?")


def add_specification_options(
    parser: argparse.ArgumentParser, set_name: str | None = "base", several: bool = False
) -> None:
    """``--set``, ``--option`` and ``--spec``; ``set_name`` is the default, None lets the caller choose.

    With ``several``, ``--set`` may be repeated: ``args.set_names`` is a list, or None where none is given.
    """
    default = f" (default: {set_name})" if set_name else ""
    if several:
        text = f"spec set{default}; may be repeated"
        parser.add_argument("--set", dest="set_names", metavar="S", action="append", help=text)
    else:
        text = f"spec set{default}"
        parser.add_argument("--set", dest="set_name", metavar="S", default=set_name, help=text)
    add_reading_options(parser)


def add_reading_options(parser: argparse.ArgumentParser) -> None:
    """``--option`` and ``--spec``: which readings, and which files on top of the library."""
    parser.add_argument(
        "--option",
        dest="options",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="choose a reading, such as lateral_sign=literal; may be repeated",
    )
    parser.add_argument(
        "--spec",
        dest="specs",
        metavar="FILE",
        action="append",
        type=Path,
        default=[],
        help="a specification file of yours, on top of the library; may be repeated",
    )


def add_parameter_option(parser: argparse.ArgumentParser) -> None:
    """``--param``, whose values ``parameter_values`` understands."""
    parser.add_argument(
        "--param",
        dest="params",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="value of a parameter, such as minDanger=0, rho=3/5 or 'rho=600 ms'; may be repeated",
    )


def add_quiet_option(parser: argparse.ArgumentParser) -> None:
    """``--quiet``, which the command line sees to for all sub-commands."""
    parser.add_argument("--quiet", action="store_true", help="no word about how far it is")


def add_json_option(parser: argparse.ArgumentParser) -> None:
    """``--json FILE``, where - is stdout; see ``write_json``."""
    parser.add_argument(
        "--json", metavar="FILE", type=_file_name, help="write the answer as JSON to FILE, or - for stdout"
    )


def _file_name(text: str) -> str:
    if not Path(text).name:
        raise argparse.ArgumentTypeError(f"'{text}' names no file")
    return text


def load_library_of(args: argparse.Namespace) -> "Library":
    """The bundled library with the files of ``--spec`` on top. Raises ``InputError``."""
    from roadproof.spec.library import load_library

    return load_library(args.specs)


def select_specification(args: argparse.Namespace, library: "Library | None" = None) -> "Specification":
    """The definitions in force under ``--set``, ``--option`` and ``--spec``. Raises ``InputError``."""
    chosen = library or load_library_of(args)
    return chosen.select(args.set_name or "base", chosen_options(args))


def chosen_options(args: argparse.Namespace) -> dict[str, str]:
    """The values of ``--option`` by name. Raises ``UsageError`` where one is not NAME=VALUE."""
    return dict(_assignments("--option", args.options))


def parameter_values(args: argparse.Namespace, library: "Library") -> dict[str, Fraction]:
    """Every parameter's value in SI units: declared, or given with ``--param``.

    A value without unit is in the unit of the declaration. Raises ``InputError`` for unknown names,
    values that are no rational, units of another dimension, and values out of the declared bound.
    """
    from roadproof.spec.bind import values_with
    from roadproof.spec.library import unknown

    values: dict[str, Fraction] = {}
    for name, text in _assignments("--param", args.params):
        if name not in library.parameters:
            raise InputError(f"--param {name}={text}: {unknown('parameter', name, library.parameters)}")
        declared = library.parameters[name]
        values[name] = read_value("--param", name, text, declared.unit)
    try:
        return values_with(library, values)
    except InputError as error:
        raise InputError(f"--param {error}") from None


def read_value(option: str, name: str, text: str, unit: str) -> Fraction:
    """A value in SI units; without unit it is in ``unit``. Raises ``InputError`` that names ``option``."""
    from roadproof.spec.library import unknown
    from roadproof.units import UNITS

    read = _VALUE.fullmatch(text.strip())
    if read is None:
        raise InputError(
            f"{option} {name}={text}: this is no value; write a decimal or a fraction, with a unit if you "
            f"like, such as {name}=0.6, {name}=3/5 or '{name}=0.6 {unit}'"
        )
    number, given = read[1], read[2] or unit
    if given not in UNITS:
        raise InputError(f"{option} {name}={text}: {unknown('unit', given, UNITS)}")
    if UNITS[given][1] != UNITS[unit][1]:
        raise InputError(f"{option} {name}={text}: {name} is in {unit}, which {given} does not measure")
    top, _, bottom = number.partition("/")
    if bottom and Fraction(bottom) == 0:
        raise InputError(f"{option} {name}={text}: the denominator is zero")
    return Fraction(top) / Fraction(bottom or 1) * UNITS[given][0]


def read_seconds(option: str, text: str, or_zero: bool = False) -> Fraction:
    """A time in seconds, greater than 0 (or 0 too). Raises ``UsageError``."""
    try:
        value = Fraction(text) if len(text) <= 40 and "e" not in text.lower() else None
    except (ValueError, ZeroDivisionError):
        value = None
    if value is None or value < 0 or (value == 0 and not or_zero):
        least = "seconds, 0 or more" if or_zero else "a number greater than 0"
        raise UsageError(f"{option} {text[:40]}: write {least}, such as 6, 0.6 or 3/5")
    return value


def _assignments(option: str, texts: Iterable[str]) -> list[tuple[str, str]]:
    """``NAME=VALUE`` texts as pairs. Raises ``UsageError`` where there is no ``=``."""
    pairs: list[tuple[str, str]] = []
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise UsageError(f"{option} {text}: write {option} NAME=VALUE")
        pairs.append((name.strip(), value.strip()))
    return pairs


def write_json(data: Mapping[str, Any], target: str) -> None:
    """``data`` as JSON to the file ``target``, or to stdout where it is ``-``. Raises ``InputError``."""
    if target == "-":
        print(json_text(data, plain=not takes_everything(sys.stdout)), end="")
    else:
        write_text(Path(target), json_text(data))


def json_text(data: Mapping[str, Any], plain: bool = False) -> str:
    """``data`` as the text of a JSON file; with ``plain``, in ASCII."""
    return json.dumps(data, indent=2, ensure_ascii=plain) + "\n"


def write_text(path: Path, text: str) -> None:
    """Write a file whole or not at all, into a folder that exists. Raises ``InputError``."""
    with whole_file(path) as file:
        file.write(text.encode("utf-8"))
