"""Drives of a test with a formula on both sides of a driver model: preventable ones, and others.

A search among the drives of a restricted scenario (``preventing.restriction``) only proposes a drive. It
counts where the judge accepts it for the test and the scenario, and ``decide_drive`` tells its side.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import get_args

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.decisions import Decision, Drivers, course_of
from roadproof.analysis.catalogue.entries import Abstract, Freedom
from roadproof.analysis.catalogue.fact import Fact
from roadproof.analysis.catalogue.showing import all_shown_by, decisions_on, names_shown
from roadproof.drivers.models import MODELS
from roadproof.drivers.restriction import Restriction, Side, check_library, files_for, said_in
from roadproof.engines.search.ask import answer
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.placing import judged_as
from roadproof.engines.search.question import SearchOptions, Setting
from roadproof.errors import InputError
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.compose import both
from roadproof.library.loading import load_library
from roadproof.library.scenarios import Scenario, applied, number_in
from roadproof.library.specification import Library, Source
from roadproof.reasons import Reason, Why


@dataclass(frozen=True)
class Sides:
    """The question for drives of a test, which implies a scenario or shows it, on each side of each model.

    ``drives`` are those of the test that are known.
    """

    entry: Abstract
    scenario: str
    drives: tuple[JudgedDrive, ...]


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
    return [
        decision
        for drive in drives
        for decision in decisions_on(drive.file, all_shown_by(drive.file, asked, Freedom()), drivers)
        if decision.scenario in scenarios
    ]


def facts_on_sides(basis: Basis, asked: Questions, drivers: Drivers, piece: Sides) -> tuple[Fact, ...]:
    """A drive for each side of each model that the known drives are not on, or that none was found."""
    scenario = piece.scenario
    found = decisions_of(piece.drives, [scenario], asked, drivers)
    facts: list[Fact] = []
    for model in models_of(drivers, scenario):
        for side in get_args(Side):
            if any(x.driver == model and x.side == side for x in found):
                continue
            fact = _fact(basis, asked, drivers, piece, Restriction(side, model))
            if fact.drive is not None:
                found += decisions_of([fact.drive], [scenario], asked, drivers)
            facts.append(fact)
    return tuple(facts)


def unanswered_sides(drivers: Drivers, piece: Sides, reason: Reason) -> tuple[Fact, ...]:
    """The facts of a piece that nothing is known of."""
    return tuple(
        Fact(piece.entry.id, side_name(piece.scenario, side, model), "open", piece.entry.query, reason=reason)
        for model in models_of(drivers, piece.scenario)
        for side in get_args(Side)
    )


def _fact(basis: Basis, asked: Questions, drivers: Drivers, piece: Sides, wanted: Restriction) -> Fact:
    entry, home = piece.entry, basis.specification
    number = number_in(piece.scenario)
    assert number is not None
    plain = applied(home, Scenario(number, home.set_name))
    other = side_name(piece.scenario, wanted.side, wanted.model)
    left_open = Fact(entry.id, other, "open", entry.query, plain)
    try:
        known = drivers.specification
        there = _library(tuple(known.library.files)).select(
            known.set_name, {**known.options, **wanted.options}
        )
        test = said_in(both(entry.query, plain), home, there)
    except InputError as error:
        return replace(left_open, reason=Why.TOLD(error))
    query = both(test, applied(there, Scenario(number, home.set_name)))
    setting = Setting(entry.road, vehicles=entry.vehicles, values=drivers.values)
    outcome = answer(
        Search(there, query, setting, SearchOptions("smooth", effort=basis.effort, explain=False))
    )
    for drive in outcome.drives:
        file = replace(drive.file, options=dict(home.options), values=basis.all_values())
        judged = judged_as(file, both(entry.query, plain), basis.library)
        if judged is None:
            continue
        if any(
            (x.driver, x.side) == (wanted.model, wanted.side)
            for x in decisions_of([judged], [piece.scenario], asked, drivers)
        ):
            also = names_shown(judged, asked)
            return Fact(entry.id, other, "shows", entry.query, plain, drive=judged, also=also)
    reason = outcome.told(()) or Why.SEARCH_FOUND_NONE()
    return replace(left_open, reason=reason, exhausted=outcome.exhausted)


@cache
def _library(files: tuple[Source, ...]) -> Library:
    """The definitions with ``prevention.spec``. Raises ``InputError``."""
    library = load_library(files_for(files))
    check_library(library)
    return library
