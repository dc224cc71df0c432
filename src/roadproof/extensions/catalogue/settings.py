"""The options of ``catalogue``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.extensions.drivers.options import Prevention
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import extensible, option, output
from roadproof.frontends.settings.readers import items_of, whole
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from roadproof.evidence.claim import Objective
    from roadproof.extensions.catalogue.catalogue_data import FixedOrAny
    from roadproof.frontends.api.definitions import Among


def driver_models_or_none(text: str) -> tuple[str, ...]:
    """Names of driver models with commas between them; none stands for no model."""
    return () if text == "none" else items_of("names", ", such as careful,r157, or none")(text)


def fixed_or_any(flag: str, what: str) -> Any:
    """A choice between ``what`` a test fixes, and any."""
    text = f"look at all {what}, not only at those that a test fixes"
    return option("fixed", flag, text, choices=("fixed", "any"), rare=True)


def with_complete(flag: str, what: str, **more: Any) -> Any:
    """An option of the drives that ``--complete`` writes."""
    return output(None, flag, f"with --complete: {what}", keyword=False, **more)


@extensible("catalogue")
@dataclass(frozen=True, kw_only=True)
class Catalogue(groups.SeveralSets, groups.Models, groups.BudgetSettings, groups.Run, Prevention):
    """Options of ``catalogue``."""

    among: Among = groups.scenarios_such_as("1-8", keyword=True)
    classes: bool = option(True, "--no-classes", "ask about scenarios only", rare=True)
    gaps: bool = option(False, "--gaps", "also ask for a test of each class of gaps that is not proved empty")
    explore: bool = option(
        False,
        "--explore",
        "also ask how drives of each class can begin, and which part no test covers",
        rare=True,
    )
    roles: FixedOrAny = fixed_or_any("--roles", "choices of roles")
    lanes: FixedOrAny = fixed_or_any("--lanes", "lanes")
    start: FixedOrAny = fixed_or_any("--start", "instants")
    strict: bool = groups.strict_reading()
    near: float = option(
        0.5,
        "--near X",
        "tests that show the same and begin within X m and m/s are duplicates (default: 0.5)",
        read=float,
        rare=True,
    )
    drivers: Iterable[str] | None = option(
        None,
        "--drivers MODELS",
        "driver models that drive each test: careful,r157, or none (default: all)",
        read=driver_models_or_none,
    )
    effort: float = groups.effort_for("a drive", 60.0)
    out: str | Path | None = groups.folder_for("page, matrix, JUnit, evidence")
    pictures: bool = groups.pictures_of("picture", command_line_only=True)
    complete: Path | None = output(
        None,
        "--complete DIR",
        "write a drive for each scenario and class without a test",
        read=Path,
        keyword=False,
    )
    objective: Objective | None = with_complete(
        "--objective",
        "what the drives should be like (default: smooth)",
        choices=groups.OBJECTIVES,
        rare=True,
    )
    spread: int | None = with_complete(
        "--spread K", "write drives far from the tests until each class has K tests", read=whole(1), rare=True
    )
    formats: Sequence[str] | None = with_complete(
        "--format FORMAT",
        "also write openscenario, commonroad, highd, csv or opendrive",
        gather=list,
        rare=True,
    )
