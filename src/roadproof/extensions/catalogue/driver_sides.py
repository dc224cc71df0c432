"""The sides of drives of a test with a formula under driver models: preventable or unpreventable."""

from collections.abc import Iterable, Iterator, Sequence
from typing import get_args

from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.drive_targets import decisions_on, targets_at_start
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.restriction import Side
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, manoeuvre_of
from roadproof.library.scenarios import number_in


def side_name(scenario: str, side: str, model: str) -> str:
    """Return the name of a side of a scenario in facts: ``scenario_1 unpreventable (careful)``."""
    return f"{scenario} {side} ({model})"


def read_side_name(name: str) -> tuple[str, str, str] | None:
    """Return scenario, side and model of the name of a side; None for other names."""
    scenario, _, rest = name.partition(" ")
    side, _, model = rest.removesuffix(")").partition(" (")
    is_one = number_in(scenario) is not None and side in get_args(Side) and model in MODELS
    return (scenario, side, model) if is_one and name == side_name(scenario, side, model) else None


def has_sides(drivers: Drivers, scenario: str) -> bool:
    """Return whether a driver model with a formula decides on a scenario."""
    return any(True for _ in models_of(drivers, scenario))


def models_of(drivers: Drivers, scenario: str) -> Iterator[str]:
    """Yield the driver models with a formula that decide on a scenario."""
    manoeuvre = manoeuvre_of(scenario)
    if manoeuvre is not None:
        yield from (x for x in drivers.of(manoeuvre) if not MODELS[x].is_stepped)


def decisions_of(
    drives: Iterable[JudgedDrive], scenarios: Sequence[str], formulas: TargetFormulas, drivers: Drivers
) -> list[Decision]:
    """Return the decisions of driver models on these scenarios in each drive that shows them."""

    def every(drive: JudgedDrive) -> tuple[Drivers, tuple[Decision, ...]]:
        def work_out() -> tuple[Drivers, tuple[Decision, ...]]:
            return drivers, decisions_on(drive.file, targets_at_start(drive, formulas), drivers)

        return formulas.cache.of(("decisions", id(drive), id(drivers)), drive, work_out)

    return [x for drive in drives for x in every(drive)[1] if x.scenario in scenarios]
