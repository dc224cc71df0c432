"""The options of ``preventable``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.settings import groups, readers
from roadproof.frontends.settings.option import extensible, option
from roadproof.frontends.settings.readers import whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from roadproof.frontends.api.checking import Kernel
    from roadproof.library.bind import Number


def initial_values(text: str) -> tuple[str, list[str]]:
    """``NAME=VALUE`` with one value or several, as a pair."""
    name, equals, value = text.partition("=")
    if not equals or not value.strip():
        example = "Ve0=60km/h,90km/h"
        raise UsageError(f"{text}: write NAME=VALUE, or several with commas, such as {example}")
    return name.strip(), [x.strip() for x in value.split(",")]


def flat(lists: Iterable[Iterable[str]]) -> list[str]:
    """The texts of several lists in one."""
    return [text for texts in lists for text in texts]


@extensible("preventable")
@dataclass(frozen=True, kw_only=True)
class Preventable(groups.DefinitionsSettings, groups.BudgetSettings, groups.Sharing, groups.Run):
    """Options of ``preventable``."""

    models: Sequence[str] = option(
        (),
        "--model NAME",
        "driver model: careful, r157, eu1426, rss or fsm (default: all but fsm)",
        read=readers.items_of("names", ", such as careful,r157"),
        gather=flat,
        keyword=False,
    )
    at: Mapping[str, Number | Sequence[Number]] | None = option(
        None,
        "--at NAME=VALUE[,…]",
        "fix an initial value; several values make several plates",
        read=initial_values,
        gather=dict,
    )
    along: tuple[Number, Number] | None = option(
        None, "--along NAME=LOW:HIGH", "range of the value along each line"
    )
    across: tuple[Number, Number] | None = option(
        None, "--across NAME=LOW:HIGH", "range of the value across the lines"
    )
    lines: int = option(100, "--lines K", "lines of a plate (default: 100)", read=whole(2))
    tests: str | Path | None = option(
        None, "--tests FILE", "draw tests as points: a CSV table, such as drivers.csv of catalogue", rare=True
    )
    lemmas: bool = option(True, "--no-lemmas", "prove no lemmas", rare=True)
    kernel: Kernel | None = option(
        None,
        "--kernel",
        "also prove each formula against the motion, with the kernel of Coq (coqc)",
        choices=("coq",),
    )
    effort: float = groups.effort_for("a lemma", 60.0)
    out: str | Path | None = groups.folder_for("drives, certificates, CSV, pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)
