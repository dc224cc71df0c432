"""A NONE-WITHIN with evidence: the programs of a question, and trees that refute them."""

from collections.abc import Mapping
from dataclasses import replace
from math import prod

from roadproof.engines.encode.build import Assumptions, encode_formula, frame
from roadproof.engines.encode.motion import Layout, own_columns
from roadproof.engines.encode.program import program_of
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import SearchProblem, make_grid, pose
from roadproof.engines.solve.refuting import find_tree
from roadproof.engines.solve.relaxation import NotRefutedError
from roadproof.errors import InputError
from roadproof.evidence.none_within import Derived, NoneWithinFile
from roadproof.evidence.program import Program
from roadproof.library.bind import telling_values, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library

MOST = 300  # linear programs for one tree


def refute(search: Search) -> NoneWithinFile | None:
    """Evidence that a search has no drive within its limits; None where none is found."""
    specification = search.specification
    question = pose(specification.library, search.query, search.setting)
    found = []
    try:
        for lanes in question.lanes:
            found.append((lanes, find_tree(program_for(question, lanes), MOST)))
    except (InputError, NotRefutedError):
        return None
    return NoneWithinFile(
        search.scenario,
        specification.set_name,
        search.query.text,
        question.grid.horizon,
        question.grid.dt,
        question.assumptions.reach,
        question.assumptions.collisions,
        telling_values(specification.library, search.query.formula, question.values),
        specification.options,
        question.road,
        question.vehicles,
        tuple(found),
    )


def derive(file: NoneWithinFile, library: Library) -> Derived:
    """The programs of a file, derived again from its question. Raises ``InputError``, ``UsageError``."""
    specification = library.select(file.set_name, file.options)
    query = read_claim(specification, file.formula)
    if set(query.vehicles) != set(file.vehicles):
        raise InputError("vehicles: there must be a model for each vehicle of the formula, and no other")
    told = tuple(lanes for lanes, _ in file.refutations)
    lanes = {*file.road.lanes}
    if not told or any({*x} != {*query.lanes} or not lanes.issuperset(x.values()) for x in told):
        raise InputError("refutations: its lanes are none of the formula on this road")
    several = (len({x[name] for x in told}) > 1 for name in query.lanes)
    if len({frozenset(x.items()) for x in told}) < prod(len(lanes) for free in several if free):
        raise InputError("refutations: an assignment of lanes is missing")
    question = SearchProblem(
        query,
        file.road,
        {name: file.vehicles[name] for name in query.vehicles},
        values_with(library, file.values),
        told,
        make_grid(file.horizon, file.dt),
        Assumptions(reach=file.reach, collisions=file.overlaps_allowed),
    )
    return Derived(tuple(program_for(question, lanes) for lanes in told), question.limits().text(()))


def program_for(question: SearchProblem, lanes: Mapping[str, str]) -> Program:
    """The exact encoding for one assignment of lanes. Raises ``InputError`` above degree 2."""
    formula = question.bound(lanes)
    assumptions = replace(question.assumptions.loosest(), starts=question.starts)
    layout = Layout(tuple(question.vehicles), question.grid, own_columns(formula))
    circuit = encode_formula(formula, question.vehicles, layout, assumptions)
    program = program_of(frame(circuit, question.road, question.vehicles, layout, assumptions))
    if program is None:
        raise InputError("the formula has a comparison of degree above 2")
    return program
