"""Drives of a test with a formula on both sides of a driver model: preventable ones, and others.

A search among the drives of a restricted scenario (``preventing.restriction``) only proposes a drive. It
counts where the judge accepts it for the test and the scenario, and ``decide_drive`` tells its side.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import get_args

from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.showing import decisions_on, shown_from_start
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.restriction import Side
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, course_of
from roadproof.library.scenarios import number_in


def side_name(scenario: str, side: str, model: str) -> str:
    """How facts name a side of a scenario: ``scenario_1 unpreventable (careful)``."""
    return f"{scenario} {side} ({model})"


def read_side_name(name: str) -> tuple[str, str, str] | None:
    """Scenario, side and model; None for other names."""
    scenario, _, rest = name.partition(" ")
    side, _, model = rest.removesuffix(")").partition(" (")
    is_one = number_in(scenario) is not None and side in get_args(Side) and model in MODELS
    return (scenario, side, model) if is_one and name == side_name(scenario, side, model) else None


def has_sides(drivers: Drivers, scenario: str) -> bool:
    """Whether a model with a formula speaks of a scenario."""
    return any(True for _ in models_of(drivers, scenario))


def models_of(drivers: Drivers, scenario: str) -> Iterator[str]:
    manoeuvre = course_of(scenario)
    if manoeuvre is not None:
        yield from (x for x in drivers.of(manoeuvre) if not MODELS[x].is_stepped)


def decisions_of(
    drives: Iterable[JudgedDrive], scenarios: Sequence[str], asked: Questions, drivers: Drivers
) -> list[Decision]:
    """What becomes of these scenarios on each of the drives that shows them."""

    def every(drive: JudgedDrive) -> tuple[Drivers, tuple[Decision, ...]]:
        def work_out() -> tuple[Drivers, tuple[Decision, ...]]:
            return drivers, decisions_on(drive.file, shown_from_start(drive, asked), drivers)

        return asked.remembered.of(("decisions", id(drive), id(drivers)), drive, work_out)

    return [x for drive in drives for x in every(drive)[1] if x.scenario in scenarios]
