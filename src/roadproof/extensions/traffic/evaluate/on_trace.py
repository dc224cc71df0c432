"""The results of one trace when driver models drive SV: requested models, and those that a formula names.

A formula such as ``unpreventable_cutIn_careful(SV, POV)`` speaks of a state, from which POV goes on as it
begins. What a driver does in the trace is decided by the model that is put into it, as in ``catalogue`` and
``evaluate``.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.drivers.models import MODELS, SCENARIOS, boundary_name, check_courses, check_driver
from roadproof.extensions.drivers.verdict import DriverVerdict
from roadproof.extensions.traffic.evaluate.decisions import (
    Decision,
    Drivers,
    decide_drive,
    decide_trace,
    decision_text,
    driver_models,
    manoeuvre_of,
)
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.frontends.api.definitions import Definitions
from roadproof.library.scenarios import Scenario, name_of, vehicles_of
from roadproof.library.specification import Query
from roadproof.logic.formula import Application, subformulas
from roadproof.runtime.records import dataclass

_BOUNDARIES = {
    boundary_name(manoeuvre, model): (name_of(number), model)
    for manoeuvre, number in SCENARIOS.items()
    for model in MODELS
}


@dataclass(frozen=True)
class ScenarioCast:
    """The vehicles of a scenario by name, SV first, and the driver models that are put into it."""

    scenario: str
    vehicles: tuple[str, ...]
    models: tuple[str, ...]


def scenario_casts(
    definitions: Definitions, query: Query, number: int | None, models: tuple[str, ...]
) -> list[ScenarioCast]:
    """Return what is asked of driver models: of the scenario ``number``, and of states that a formula names.

    Raises ``UsageError`` for models that say nothing of the scenario.
    """
    casts: dict[ScenarioCast, None] = {}
    for model in models:
        check_driver(model, f"drivers={','.join(models)}")
        check_courses(model, () if number is None else (number,), f"drivers={','.join(models)}")
    if number is not None and models:
        vehicles = vehicles_of(
            definitions.specification, Scenario(number, definitions.specification.set_name)
        )
        casts[ScenarioCast(name_of(number), vehicles, models)] = None
    for part in subformulas(query.formula):
        if isinstance(part, Application) and part.name.partition("@")[0] in _BOUNDARIES:
            scenario, model = _BOUNDARIES[part.name.partition("@")[0]]
            casts[ScenarioCast(scenario, part.arguments, (model,))] = None
    return [*casts]


def decisions_on(
    trace: DriveFile | OneTrace,
    casts: list[ScenarioCast],
    definitions: Definitions,
    values: Mapping[str, Fraction],
) -> Iterator[Decision]:
    """Yield what becomes of a trace from its start on; its vehicles are called as in the formula."""
    for cast in casts:
        drivers = driver_models_of(definitions, cast.models)
        assert drivers is not None
        drivers = Drivers(drivers.specification, {**drivers.values, **values}, drivers.models)
        assert manoeuvre_of(cast.scenario) is not None
        if isinstance(trace, DriveFile):
            yield from decide_drive(trace, drivers, cast.scenario, cast.vehicles, 0.0)
        else:
            yield from decide_trace(trace, drivers, cast.scenario, cast.vehicles, 0.0, cast.vehicles)


def driver_models_of(definitions: Definitions, names: tuple[str, ...]) -> Drivers | None:
    """Driver models to be asked, in definitions on top of which ``driver.spec`` is read; None for no names.

    Raises ``InputError``, ``UsageError``.
    """
    return driver_models(definitions.specification.in_set(definitions.sets[0]), definitions.values, names)


def driver_lines(decisions: tuple[Decision, ...]) -> Iterator[str]:
    """Yield a line for each model, under a heading; nothing where none is asked."""
    if decisions:
        yield "driver models in place of SV, in the trace's own motion from its start on:"
    for x in decisions:
        yield f"  {x.driver}, {x.scenario}: {decision_text(x)}" + (f"; {x.reason}" if x.reason else "")


def driver_verdict(decision: Decision) -> DriverVerdict:
    """Return a decision as an answer has it."""
    fields = {name: value for name, value in vars(decision).items() if name != "driven"}
    return DriverVerdict(**fields)
