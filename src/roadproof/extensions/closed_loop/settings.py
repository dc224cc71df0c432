"""The options of ``falsify``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.extensions.closed_loop.controller_settings import ControllerRuns
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import extensible, option, output, search
from roadproof.frontends.settings.readers import decimal, whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from roadproof.extensions.closed_loop.data import Method, Wanted
    from roadproof.frontends.api.definitions import Among


@extensible("falsify")
@dataclass(frozen=True, kw_only=True)
class Falsify(
    groups.DefinitionsSettings,
    groups.Models,
    ControllerRuns,
    groups.BudgetSettings,
    groups.Sharing,
    groups.Run,
):
    """Options of ``falsify``."""

    among: Among = groups.scenarios_such_as("1-8", keyword=True)
    failures: Wanted = option(
        "any",
        "--failures KIND",
        "failures that count: any (default), or preventable ones, which a driver model prevents",
        choices=("any", "preventable"),
    )
    classes: bool = option(True, "--no-classes", "aim at scenarios only, not at classes of them", rare=True)
    simulations: int = search(
        2000,
        "--simulations N",
        "simulations for each scenario and class (default: 2000)",
        read=whole(1),
        least=1,
    )
    seed: int = search(0, "--seed N", "seed of the search (default: 0)", read=whole(0), least=0)
    seeds: str | Path | None = search(
        None,
        "--seeds PATH",
        "drive files from which the search also starts, such as the folder of explore --out",
        read=Path,
        rare=True,
    )
    method: Method = search(
        "cma",
        "--method",
        "cma (default: CMA-ES on robustness), or random",
        choices=("cma", "random"),
        rare=True,
    )
    effort: float = option(
        60.0,
        "--effort N",
        "about N solver seconds for a drive or a proof that a target is possible (default: 60)",
        group="effort",
        read=decimal,
        rare=True,
    )
    out: str | Path | None = groups.folder_for("failing drives, pictures, evidence")
    tests: Path | None = output(
        None, "--tests DIR", "write failing drives as tests, with a catalogue.toml", read=Path, keyword=False
    )
    formats: Sequence[str] | None = output(
        None,
        "--format FORMAT",
        "with --tests: also write openscenario, commonroad, highd, csv or opendrive",
        gather=list,
        keyword=False,
        rare=True,
    )
    pictures: bool = groups.pictures_of(command_line_only=True)


@extensible("resimulate")
@dataclass(frozen=True, kw_only=True)
class Resimulate(
    groups.DefinitionsSettings,
    groups.Models,
    ControllerRuns,
    groups.BudgetSettings,
    groups.Sharing,
    groups.Run,
):
    """Options of ``resimulate``."""

    among: Among = option(None, "--among N-M", "only these scenarios (default: all of two or three vehicles)")
    kinds: Iterable[str] = option(
        ("Car",),
        "--class C",
        "class of the vehicles in a scenario; may be repeated (default: Car)",
        gather=tuple,
        rare=True,
    )
    road: str | None = groups.map_road()
    out: str | Path | None = groups.folder_for("drives, pictures")
    pictures: bool = groups.pictures_of(command_line_only=True)
