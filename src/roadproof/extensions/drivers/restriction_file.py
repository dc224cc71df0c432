"""The specification file by which ``--preventable`` takes a driver model of another package.

``python -m roadproof.extensions.drivers.restriction_file NAME`` prints it. It adds the model to the option
``driver`` of ``prevention.spec``, and says which of the manoeuvres in ``prevention.spec`` the model decides.
"""

import sys
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Final

from roadproof.errors import InputError
from roadproof.extensions.drivers.driver_model import DriverModel
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.library.specification import Source
from roadproof.logic.parse import parse_library

SHIPPED: Final = "prevention"
"""The file with the driver models of roadproof."""
_NAMES: Mapping[ManoeuvreName, tuple[str, str, str]] = MappingProxyType(
    {
        "cut-in": ("cutIn", "a, b", "cutsIn"),
        "cut-out": ("cutOut", "a, b, c", "cutsOut"),
        "deceleration": ("deceleration", "a, b", "brakesAhead"),
    }
)
"""How each manoeuvre is called in definitions, its vehicles, and the definition of its first instant."""
_HEAD = """\
# What begins with a manoeuvre whose collision the model {name} prevents, or cannot prevent: read on top of
# prevention.spec. Made by python -m roadproof.extensions.drivers.restriction_file {name}

option driver = careful | r157 | eu1426 | rss | {name}
  "how SV would be driven"

when driver = {name} {{
{definitions}}}
"""


def restriction_text(model: DriverModel) -> str:
    """Return the text of the specification file of a model."""
    lines = "".join(f"  {x}\n" for x in _definitions(model))
    return _HEAD.format(title=model.title, name=model.name, definitions=lines)


def _definitions(model: DriverModel) -> Iterator[str]:
    """Yield definitions that replace those of ``prevention.spec``."""
    for manoeuvre, (word, vehicles, _) in _NAMES.items():
        if manoeuvre in model.manoeuvres:
            own = f"unpreventable_{word}_{model.name}"
            yield f'def collides_{word}({vehicles}: vehicle) "[{own}]" := {own}({vehicles})'
        else:
            yield f'def begins_{word}({vehicles}: vehicle) "anything" := true'
    between = [_NAMES[x] for x in model.manoeuvres if _NAMES[x][1] == "a, b"]
    yield _either("isForeseen", [begins for _, _, begins in between])
    yield _either("collides", [f"collides_{word}" for word, _, _ in between])


def _either(name: str, parts: list[str]) -> str:
    """Return the definition of a name between two vehicles: one of some parts."""
    doc = ", or ".join(f"[{x}]" for x in parts) or "nothing"
    body = " or ".join(f"{x}(a, b)" for x in parts) or "false"
    return f'def {name}(a, b: vehicle) "{doc}" := {body}'


def check_restriction_file(model: DriverModel, source: Source) -> None:
    """Raise ``InputError`` where the file of a model of another package says something else."""
    if model.law is None or model.law.restriction == SHIPPED:
        return
    if parse_library(source.text, source.name) != parse_library(restriction_text(model), SHIPPED):
        raise InputError(
            f"{source.name}: this is not the restriction by {model.name} in its manoeuvres; print it again: "
            f"python -m roadproof.extensions.drivers.restriction_file {model.name}"
        )


if __name__ == "__main__":
    from roadproof.extensions.drivers.models import driver_model  # which imports this module

    print(restriction_text(driver_model(sys.argv[1])), end="")
