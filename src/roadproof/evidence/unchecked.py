"""Which fields of a definition ``check`` compares with nothing."""

from dataclasses import is_dataclass
from types import NoneType
from typing import Any, get_args, get_origin

from roadproof.evidence.codec import UNCHECKED, bare, fields_of


def unchecked(kind: Any) -> tuple[str, ...]:
    """The paths of the fields that ``check`` compares with nothing, such as ``verdicts[].seconds``."""
    kind = bare(kind)
    if is_dataclass(kind):
        return tuple(
            path
            for x in fields_of(kind)  # type: ignore[arg-type]
            for path in ([x.key] if x.has(UNCHECKED) else (f"{x.key}{y}" for y in _below(x.type)))
        )
    return ()


def _below(kind: Any) -> list[str]:
    """Paths below a field, with what joins them to it."""
    kind = bare(kind)
    if is_dataclass(kind):
        return [f".{path}" for path in unchecked(kind)]
    return [
        f"{'[]' if get_origin(kind) is tuple else ''}{path}"
        for x in get_args(kind)
        if x is not NoneType and x is not Ellipsis
        for path in _below(x)
    ]
