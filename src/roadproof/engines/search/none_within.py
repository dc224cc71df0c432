"""Evidence for NONE-WITHIN: the integer programs of a question, and trees that refute them."""

from collections.abc import Mapping
from dataclasses import replace
from math import prod

from roadproof.engines.encode.build import Assumptions, assemble_problem, encode_formula
from roadproof.engines.encode.motion import ColumnLayout, custom_signal_ranges
from roadproof.engines.encode.program import integer_program
from roadproof.engines.search.question import SearchProblem, make_grid, pose
from roadproof.engines.setting import Search
from roadproof.engines.solve.refuting import find_refutation_tree
from roadproof.engines.solve.relaxation import NotRefutedError
from roadproof.errors import InputError
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.none_within_check import Derived
from roadproof.evidence.program import DisjunctiveProgram
from roadproof.library.bind import used_values, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library

MOST = 300  # linear programs for one tree


def refute_with_trees(search: Search) -> NoneWithinFile | None:
    """Return evidence that a search has no drive within its limits; None where none is found."""
    specification = search.specification
    question = pose(specification.library, search.query, search.setting)
    refutations = []
    try:
        for lanes in question.lanes:
            refutations.append((lanes, find_refutation_tree(program_for(question, lanes), MOST)))
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
        used_values(specification.library, search.query.formula, question.values),
        specification.options,
        question.road,
        question.vehicles,
        tuple(refutations),
    )


def derive(file: NoneWithinFile, library: Library) -> Derived:
    """Derive the programs of a file again from its question. Raises ``InputError``, ``UsageError``."""
    specification = library.select(file.set_name, file.options)
    query = read_claim(specification, file.formula)
    if set(query.vehicles) != set(file.vehicles):
        raise InputError("vehicles: there must be a model for each vehicle of the formula, and no other")
    assignments = tuple(lanes for lanes, _ in file.refutations)
    lanes = {*file.road.lanes}
    if not assignments or any(
        {*x} != {*query.lanes} or not lanes.issuperset(x.values()) for x in assignments
    ):
        raise InputError("refutations: its lanes are none of the formula on this road")
    several = (len({x[name] for x in assignments}) > 1 for name in query.lanes)
    if len({frozenset(x.items()) for x in assignments}) < prod(len(lanes) for free in several if free):
        raise InputError("refutations: an assignment of lanes is missing")
    question = SearchProblem(
        query,
        file.road,
        {name: file.vehicles[name] for name in query.vehicles},
        values_with(library, file.values),
        assignments,
        make_grid(file.horizon, file.dt),
        Assumptions(reach=file.reach, collisions=file.overlaps_allowed),
    )
    return Derived(tuple(program_for(question, lanes) for lanes in assignments), question.limits().text(()))


def program_for(question: SearchProblem, lanes: Mapping[str, str]) -> DisjunctiveProgram:
    """Return the exact encoding for one assignment of lanes. Raises ``InputError`` above degree 2."""
    formula = question.bound(lanes)
    assumptions = replace(question.assumptions.relaxed(), starts=question.starts)
    layout = ColumnLayout(tuple(question.vehicles), question.grid, custom_signal_ranges(formula))
    circuit = encode_formula(formula, question.vehicles, layout, assumptions)
    program = integer_program(
        assemble_problem(circuit, question.road, question.vehicles, layout, assumptions)
    )
    if program is None:
        raise InputError("the formula has a comparison of degree above 2")
    return program
