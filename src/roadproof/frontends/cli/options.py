"""Options that several sub-commands share, and what they mean."""

import argparse
import json
import sys
from collections.abc import Iterable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.errors import UsageError
from roadproof.frontends.cli.streams import takes_everything
from roadproof.frontends.settings.flags import mark_rare, section
from roadproof.runtime.files import whole_file

if TYPE_CHECKING:
    from roadproof.library.specification import Library, Specification


def add_specification_options(
    parser: argparse.ArgumentParser, set_name: str | None = "base", several: bool = False
) -> None:
    """``--set``, ``--option`` and ``--spec``; ``set_name`` is the default, None lets the caller choose.

    With ``several``, ``--set`` may be repeated and have commas: see ``chosen_sets``.
    """
    default = f" (default: {set_name})" if set_name else ""
    if several:
        text = f"spec set{default}; may be repeated"
        section(parser, "definitions").add_argument(
            "--set", dest="set_names", metavar="S", action="append", help=text
        )
    else:
        text = f"spec set{default}"
        section(parser, "definitions").add_argument(
            "--set", dest="set_name", metavar="S", default=set_name, help=text
        )
    add_reading_options(parser)


def add_definition_options(
    parser: argparse.ArgumentParser, set_name: str | None = "base", several: bool = False
) -> None:
    """``--set``, ``--option``, ``--spec`` and ``--param``, which ``cli.basis.read_definitions`` reads."""
    add_specification_options(parser, set_name, several)
    add_parameter_option(parser)


def add_reading_options(parser: argparse.ArgumentParser) -> None:
    """``--option`` and ``--spec``: which readings, and which files on top of the library."""
    mark_rare(
        section(parser, "definitions").add_argument(
            "--option",
            dest="options",
            metavar="NAME=VALUE",
            action="append",
            default=[],
            help="choose a reading, such as lateral_sign=literal; may be repeated",
        )
    )
    section(parser, "definitions").add_argument(
        "--spec",
        dest="specs",
        metavar="FILE",
        action="append",
        type=Path,
        default=[],
        help="specification file to add; may be repeated",
    )


def add_parameter_option(parser: argparse.ArgumentParser) -> None:
    """``--param``, whose values ``given_values`` reads."""
    section(parser, "definitions").add_argument(
        "--param",
        dest="params",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="set a parameter, such as rho=3/5; may be repeated",
    )


def add_json_option(parser: argparse.ArgumentParser) -> None:
    """``--json FILE``, where - is stdout; see ``write_json``."""
    section(parser, "output").add_argument(
        "--json", metavar="FILE", type=_file_name, help="write JSON to FILE, or to stdout if FILE is -"
    )


def _file_name(text: str) -> str:
    if not Path(text).name:
        raise argparse.ArgumentTypeError(f"'{text}' is not a file name")
    return text


def chosen_sets(args: argparse.Namespace, usual: str = "base") -> list[str]:
    """The spec sets of ``--set``, which may be repeated and have commas. Raises ``UsageError``."""
    texts: list[str] = args.set_names or [usual]
    names = [name.strip() for text in texts for name in text.split(",")]
    if not all(names):
        raise UsageError(f"--set {' '.join(texts)}: write names separated by commas, such as base,ext")
    return names


def load_library_of(args: argparse.Namespace) -> "Library":
    """The bundled library with the files of ``--spec`` on top. Raises ``InputError``, all mistakes in it."""
    from roadproof.library.diagnose import checked_library

    return checked_library(args.specs)


def select_specification(args: argparse.Namespace) -> "Specification":
    """The definitions in force under ``--set``, ``--option`` and ``--spec``. Raises ``InputError``."""
    return load_library_of(args).select(args.set_name, chosen_options(args))


def chosen_options(args: argparse.Namespace) -> dict[str, str]:
    """The values of ``--option`` by name. Raises ``UsageError`` where one is not NAME=VALUE."""
    return dict(_assignments("--option", args.options))


def given_values(args: argparse.Namespace, library: "Library") -> dict[str, Fraction]:
    """The values of ``--param`` by name, in SI units (``api.definitions.values_of``)."""
    from roadproof.frontends.api.definitions import values_of

    return values_of(library, dict(_assignments("--param", args.params)), "--param ")


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
