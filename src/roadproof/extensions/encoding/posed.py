"""Poses the problems of a search: one for each assignment of lanes of the road to free lanes."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property

from roadproof.engines.encode.build import Assumptions, assemble_problem, encode_formula
from roadproof.engines.encode.motion import ColumnLayout, custom_signal_ranges
from roadproof.engines.encode.problem import Problem
from roadproof.engines.search.initial_candidates import is_encodable
from roadproof.engines.search.question import SearchProblem, pose
from roadproof.engines.setting import Search
from roadproof.engines.solve.big_m import EncodedProgram, encode_mixed
from roadproof.engines.solve.bounds import TooNonlinearError
from roadproof.engines.solve.milp import column_box
from roadproof.errors import UsageError
from roadproof.extensions.encoding.kinds import Drives
from roadproof.library.specification import Query
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass

OUTER_PIECES = 2  # secants for a square, as in a search


@dataclass(frozen=True)
class PosedSearch:
    """The problem of a search under one assignment of ``lanes``.

    With ``drives`` outer every drive within the limits solves it, so that none exists where it has no
    solution. Else each solution is a drive, up to rounding and to what happens between samples.
    """

    search: Search
    question: SearchProblem
    lanes: Mapping[str, str]
    drives: Drives

    @property
    def query(self) -> Query:
        """The formula as it was written, before it is put on a road."""
        return self.search.query

    @cached_property
    def assumptions(self) -> Assumptions:
        """The conditions on drives beside the formula."""
        natural = self.question.assumptions
        match self.drives:
            case "natural":
                return natural
            case "all":
                return replace(natural.without_comfort(), starts=self.question.starts)
            case "outer":
                return replace(natural.relaxed(), starts=self.question.starts)

    @cached_property
    def formula(self) -> Formula:
        """The formula on the road, with its lanes and values."""
        return self.question.bound(self.lanes)

    @cached_property
    def layout(self) -> ColumnLayout:
        """The numbering of the columns that are unknowns of vehicles and custom signals."""
        return ColumnLayout(
            tuple(self.question.vehicles), self.question.grid, custom_signal_ranges(self.formula)
        )

    @cached_property
    def problem(self) -> Problem:
        """The columns, rows and circuit, which are exact."""
        vehicles, layout, assumptions = self.question.vehicles, self.layout, self.assumptions
        circuit = encode_formula(self.formula, vehicles, layout, assumptions)
        return assemble_problem(circuit, self.question.road, vehicles, layout, assumptions)

    @cached_property
    def program(self) -> EncodedProgram:
        """The mixed-integer program of the problem. Raises ``UsageError`` above degree 2."""
        box = column_box(self.problem)
        try:
            if self.drives == "outer":
                return encode_mixed(self.problem, box, "outer", OUTER_PIECES)
            return encode_mixed(self.problem, box)
        except TooNonlinearError:
            raise UsageError(
                f"{self.query.text[:80]}: it has a comparison of degree above 2, which no linear row "
                "bounds: write it as smt2"
            ) from None

    @property
    def suffix(self) -> str:
        """The lanes that free lanes stand for, as the end of a file's name; empty where all are fixed."""
        several = len(self.question.lanes) > 1
        return "".join(f"-{name}-{lane}" for name, lane in self.lanes.items()) if several else ""


def posed_searches(search: Search, drives: Drives) -> tuple[PosedSearch, ...]:
    """Return the problems of a search, in the order in which it tries them.

    Raises ``UsageError`` for a formula with conditions that no engine encodes, and as ``pose``.
    """
    question = pose(search.specification.library, search.query, search.setting)
    if drives != "outer" and not is_encodable(question):
        raise UsageError(
            f"{search.query.text[:80]}: it has conditions at time 0 that no row bounds; a search puts "
            "sampled starts in their place. Write it with drives=outer, or as smt2"
        )
    return tuple(PosedSearch(search, question, x, drives) for x in question.lanes)
