"""The options of ``preventable``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.settings import groups, readers
from roadproof.frontends.settings.option import extensible, option
from roadproof.frontends.settings.readers import (
    whole,
)
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from roadproof.frontends.api.checking import Kernel
    from roadproof.library.bind import Number


@extensible("preventable")
@dataclass(frozen=True, kw_only=True)
class Preventable(groups.Definitions, groups.Budget, groups.Sharing, groups.Run):
    """Options of ``preventable``."""

    models: Sequence[str] = option(
        (),
        "--model NAME",
        "driver model: careful, r157, eu1426, rss or fsm (default: all but fsm)",
        read=readers.items_of("names", ", such as careful,r157"),
        gather=readers.flat,
        keyword=False,
    )
    at: Mapping[str, Number | Sequence[Number]] | None = option(
        None,
        "--at NAME=VALUE[,…]",
        "fix an initial value; several values make several plates",
        read=readers.initial_values,
        gather=dict,
    )
    along: tuple[Number, Number] | None = option(
        None, "--along NAME=LOW:HIGH", "range of the value along each line"
    )
    across: tuple[Number, Number] | None = option(
        None, "--across NAME=LOW:HIGH", "range of the value across the lines"
    )
    lines: int = option(100, "--lines K", "lines of a plate (default: 100)", read=whole(2))
    lemmas: bool = option(True, "--no-lemmas", "prove no lemmas")
    kernel: Kernel | None = option(
        None,
        "--kernel",
        "also prove each formula against the motion, with the kernel of Coq (coqc)",
        choices=("coq",),
    )
    effort: float = groups.effort_for("a lemma", 60.0)
    out: str | Path | None = groups.folder_for("drives, certificates, CSV, pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)
