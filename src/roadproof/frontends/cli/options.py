"""Options that several sub-commands share, and what they mean."""

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roadproof.frontends.cli.streams import takes_everything
from roadproof.frontends.settings.flags import section
from roadproof.runtime.files import whole_file


def add_json_option(parser: argparse.ArgumentParser) -> None:
    """``--json FILE``, where - is stdout; see ``write_json``."""
    section(parser, "output").add_argument(
        "--json", metavar="FILE", type=_file_name, help="write JSON to FILE, or to stdout if FILE is -"
    )


def _file_name(text: str) -> str:
    if not Path(text).name:
        raise argparse.ArgumentTypeError(f"'{text}' is not a file name")
    return text


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
