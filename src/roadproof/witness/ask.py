"""One question from names and numbers to an outcome that can be written, printed and sent around."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

from roadproof.effort import Late
from roadproof.encode.build import Manners
from roadproof.encode.unroll import Grid
from roadproof.errors import UsageError
from roadproof.evidence.witness import DriveFile, as_json, judge_file, times_data
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import parameters_of
from roadproof.spec.bind import default_values
from roadproof.spec.elaborate import read_claim, signature
from roadproof.spec.library import Library, Specification, load_library
from roadproof.verdict import Verdict
from roadproof.witness.impossible import Impossibility, show_impossible
from roadproof.witness.limits import Limits
from roadproof.witness.question import Found, Means, Question, assignments, usual_road
from roadproof.witness.search import Answer, find_witness
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.vehicle import with_limits

MOST_STEPS = 400


@dataclass(frozen=True)
class Request:
    """A question in the words of the command line; ``what`` is a scenario's number or a formula.

    ``road`` None takes the reference road with the zones that the formula speaks of; ``vehicles``
    gives models by vehicle, "" for all others, and ``limits`` other limits than the models', such as
    ``{"POV": {"a_lon.min": -2}}`` (``world.vehicle.with_limits``). ``natural``: whether natural drives are
    tried first. ``horizon``, ``dt``: seconds; ``reach``: metres.
    """

    what: str
    set_name: str = "base"
    options: Mapping[str, str] = field(default_factory=dict)
    specs: tuple[Path, ...] = ()
    values: Mapping[str, Fraction] = field(default_factory=dict)
    road: str | None = None
    lanes: Mapping[str, str] = field(default_factory=dict)
    vehicles: Mapping[str, str] = field(default_factory=dict)
    limits: Mapping[str, Mapping[str, Fraction]] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    dt: Fraction = Fraction(3, 5)
    reach: Fraction = Fraction(80)
    collisions: bool = False
    natural: bool = True
    count: int = 1
    means: Means = field(default_factory=Means)


@dataclass(frozen=True)
class Outcome:
    """The verdict on a request; ``drives`` are drive files as plain data, judged once more from it."""

    scenario: int | None
    set_name: str
    formula: str
    road: str
    verdict: Verdict
    reason: str
    drives: tuple[dict[str, Any], ...]
    natural: bool
    seconds: Mapping[str, float]
    sizes: Mapping[str, int]
    impossibility: Impossibility | None = None
    limits: Limits | None = None

    def told(self, options: Sequence[str]) -> str:
        """The reason, with those ``options`` that a command has to widen the limits of a NONE-WITHIN."""
        return self.reason if self.limits is None else self.limits.text(options)

    def as_json(self) -> dict[str, Any]:
        """The outcome as plain data."""
        data: dict[str, Any] = {"scenario": self.scenario, "set": self.set_name, "formula": self.formula}
        data |= {"road": self.road, "verdict": str(self.verdict)}
        data |= {"view": "dense" if self.limits is None else "grid", "reason": self.reason}
        data |= {"natural": self.natural, "drives": list(self.drives)}
        if self.limits is not None:
            data["limits"] = self.limits.as_json()
        if self.impossibility is not None:
            data |= {"core": list(self.impossibility.core), "certificate": self.impossibility.certificate}
        data |= {"seconds": {k: round(v, 4) for k, v in self.seconds.items()}, "sizes": dict(self.sizes)}
        return data


def answer(request: Request) -> Outcome:
    """As ``ask``, but UNKNOWN with that reason where the clock cuts it off."""
    begun = time.perf_counter()
    try:
        return ask(request)
    except Late as late:
        library = load_library(request.specs)
        specification = library.select(request.set_name, request.options)
        scenario, text = as_formula(specification, request.what)
        road = pose(specification, text, request).road.name
        seconds = {"all": time.perf_counter() - begun}
        why = str(late)
        return Outcome(scenario, request.set_name, text, road, Verdict.UNKNOWN, why, (), False, seconds, {})


def ask(request: Request) -> Outcome:
    """Answer a request. Raises ``InputError``, ``UsageError``, ``MissingSolverError``, ``Late``."""
    begun = time.perf_counter()
    library = load_library(request.specs)
    specification = library.select(request.set_name, request.options)
    scenario, text = as_formula(specification, request.what)
    question = pose(specification, text, request)
    answers = [find_witness(question, request.means)]
    drives: list[Drive] = []
    while answers[-1].found is not None and len(drives) + 1 < request.count:
        drives.append(answers[-1].found.drive)
        answers.append(find_witness(question, request.means, tuple(drives)))
    first = answers[0]
    files = tuple(
        drive_data(library, specification, scenario, text, question, a.found)
        for a in answers
        if a.found is not None
    )
    impossibility = None
    if first.found is None:
        effort = request.means.effort
        impossibility = show_impossible(specification, text, effort.of(max(1.0, min(10.0, effort.units))))
    seconds = {**first.seconds, "all": time.perf_counter() - begun}
    return Outcome(
        scenario,
        request.set_name,
        text,
        question.road.name,
        Verdict.IMPOSSIBLE if impossibility else first.verdict,
        "" if impossibility else _reason(answers, request.count),
        files,
        first.found is not None and first.found.manners.natural,
        seconds,
        first.sizes,
        impossibility,
        None if impossibility else first.limits,
    )


def _reason(answers: list[Answer], count: int) -> str:
    found = sum(a.found is not None for a in answers)
    if 0 < found < count:
        return f"{found} of {count} drives that differ clearly; no further one: {answers[-1].reason}"
    return answers[0].reason


def as_formula(specification: Specification, what: str) -> tuple[int | None, str]:
    """A scenario's number as its formula, applied to its own arguments; a formula as it is."""
    if not what.strip().isdecimal():
        return None, what.strip()
    name = f"scenario_{int(what)}"
    return int(what), f"{name}({', '.join(signature(specification, name))})"


def pose(specification: Specification, text: str, request: Request) -> Question:
    """The question with road, vehicles and grid in place. Raises ``UsageError``."""
    query = read_claim(specification, text)
    road = load_road(request.road or usual_road(query.formula))
    for name in (*request.vehicles, *request.limits):
        if name and name not in query.vehicles:
            known = ", ".join(query.vehicles)
            raise UsageError(f"vehicle {name}: the formula speaks of {known or 'no vehicle'}")
    if not query.vehicles:
        raise UsageError("the formula speaks of no vehicle, so no drive can show anything about it")
    usual = request.vehicles.get("", "car")
    models = {name: load_vehicle(request.vehicles.get(name, usual)) for name in query.vehicles}
    vehicles = {name: with_limits(model, request.limits.get(name, {})) for name, model in models.items()}
    lanes = assignments(query, road, request.lanes)
    manners = Manners(reach=request.reach, collisions=request.collisions)
    manners = manners if request.natural else manners.plain()
    values = dict(request.values)
    grid = make_grid(request.horizon, request.dt)
    return Question(query, road, vehicles, values, lanes, grid, manners)


def make_grid(horizon: Fraction, dt: Fraction) -> Grid:
    """Raises ``UsageError`` unless the horizon is a sensible multiple of dt."""
    if dt <= 0 or horizon <= 0:
        raise UsageError(f"horizon={horizon} s and dt={dt} s must be greater than 0")
    steps = horizon / dt
    if steps.denominator != 1:
        raise UsageError(
            f"horizon={horizon} s is no multiple of dt={dt} s: choose a horizon "
            f"such as {dt * (int(steps) + 1)} s, or another dt"
        )
    if steps > MOST_STEPS:
        raise UsageError(
            f"horizon={horizon} s with dt={dt} s is {steps} steps; at most {MOST_STEPS} are allowed"
        )
    return Grid(dt, int(steps))


def drive_data(
    library: Library,
    specification: Specification,
    scenario: int | None,
    text: str,
    question: Question,
    found: Found,
) -> dict[str, Any]:
    """The drive file as plain data, after it has been judged once more from what it says."""
    file = DriveFile(
        scenario,
        specification.set_name,
        text,
        found.grid.horizon,
        found.lanes,
        telling_values(library, question.query.formula, question.values),
        specification.options,
        question.road,
        found.drive,
        found.manners.collisions,
    )
    ruling = judge_file(file, library)
    if not ruling.accepted or ruling.judgement is None:
        raise AssertionError(f"a judged drive was rejected when judged again: {ruling.reason}")
    times = times_data(ruling.judgement)
    verdict = {"verdict": str(Verdict.WITNESSED), "view": "dense", "natural": found.manners.natural}
    return as_json(file, {**verdict, "times": times})


def telling_values(library: Library, formula: Formula, values: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Values of the parameters that ``formula`` speaks of, and of those that the user has changed."""
    declared = default_values(library)
    spoken = parameters_of(formula)
    return {n: v for n, v in values.items() if n in spoken or v != declared.get(n)}
