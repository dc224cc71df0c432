"""The question which cells the axes of a plan have, and which few words say each of them.

Claims are proofs that choices of scenarios never hold. Nobody has to trust the cells: that classes exclude
each other and cover the scenarios is claimed of the classes that are made of them. But a proof that was cut
off or lost would make other classes, or longer texts, so each is a doubt of the whole.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

from roadproof.evidence.codec import Doc, read
from roadproof.extensions.surveys.classify.cells import (
    Asked,
    Axis,
    Cell,
    Outline,
    Undivided,
    outline,
    refine,
    whole_cell,
)
from roadproof.extensions.surveys.classify.classes import Classes, Plan, plan_of, what_axis, where_axis
from roadproof.extensions.surveys.classify.data import Divided, DividedGroup, Doubt, Numbers
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Place, Steps, seen, walk
from roadproof.questions.settle import settle
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress

REFINING = 2.0  # units of work for a proof that something follows


@dataclass(frozen=True)
class Division:
    """The cells of every axis of a plan, and what is proved never to hold, by the vehicles of its group.

    ``doubts``: cells with a longer text than they need. ``cut_off``: there are doubts about which cells
    there are, so that there are none.
    """

    classes: Classes
    empty: Mapping[tuple[str, ...], tuple[Query, ...]]
    doubts: tuple[Doubt, ...] = ()
    cut_off: bool = False

    @property
    def data(self) -> Divided:
        """The division as plain data, which ``classify`` asks about."""
        plan = self.classes.plan
        if self.cut_off:
            return Divided(scenarios=plan.numbers, doubts=self.doubts)
        groups = tuple(
            DividedGroup(
                vehicles=group.vehicles,
                cells=tuple(cell.holds for cell in cells),
                empty=tuple(x.text for x in self.empty.get(group.vehicles, ())),
            )
            for group, cells in zip(plan.groups, self.classes.what, strict=True)
        )
        places = tuple(cell.holds for cell in self.classes.where)
        return Divided(scenarios=plan.numbers, groups=groups, places=places, doubts=self.doubts)


@dataclass(frozen=True, kw_only=True)
class ToDivide:
    """Which scenarios are divided."""

    scenarios: Annotated[Numbers, Doc("The scenarios that are divided.")]
    in_few_words: Annotated[bool, Doc("Whether each cell is said in few words.")] = True


@dataclass(frozen=True)
class DivisionQuestion:
    """The question for the cells of every axis of a plan.

    ``asked.in_few_words``: whether each cell is said in few words, which takes longer than to find them all.
    """

    kind: ClassVar[str] = "division"
    basis: Basis
    asked: ToDivide

    @property
    def work(self) -> Work:
        """The work that is allowed for a proof that a cell is empty."""
        return Work(self.basis.effort, self.basis.proof, staged=True)

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "DivisionQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        return cls(basis, read(ToDivide, asked, where))

    @cached_property
    def plan(self) -> Plan:
        """What is divided. Raises ``InputError``, ``UsageError``."""
        return plan_of(self.basis.specification, self.asked.scenarios)

    @cached_property
    def axes(self) -> dict[str, "AxisBatch"]:
        """What is divided, by name: what happens for each group, then where."""
        specification = self.basis.specification
        axes = [what_axis(self.plan, group, specification) for group in self.plan.groups]
        if self.plan.has_places:
            axes.append(where_axis(self.plan, specification))
        return {(name := f"axis-{k}"): AxisBatch(self.basis, name, axis) for k, axis in enumerate(axes)}

    def batches(self, known: Answers) -> "list[AxisBatch | CellBatch]":
        """A batch for each axis; then one for each cell, where none of them is in doubt."""
        first = [*self.axes.values()]
        if any([*walk(x, lambda name, _: known.get(name))] for x in first):
            return [*first]
        outlines = self.outlines(known)
        if not self.asked.in_few_words or any(isinstance(x, Undivided) for x in outlines):
            return [*first]
        return [*first, *(x for k, _ in enumerate(outlines) for x in self.cells(k, outlines[k]))]

    def outlines(self, known: Answers) -> "list[Outline | Undivided]":
        """Return the cells of each axis."""
        return [seen(x.outline(), known) for x in self.axes.values()]

    def cells(self, place: int, found: Outline | Undivided) -> "list[CellBatch]":
        """Return a batch for each cell of the axis at a place."""
        if isinstance(found, Undivided):
            return []
        named = self.plan.what if place < len(self.plan.groups) else self.plan.where
        axis = [*self.axes.values()][place].axis
        return [CellBatch(self.basis, named(holds), axis, holds, others) for holds, others in found.cells]

    def label(self, name: str) -> str:
        """Return the axis or the cell that the claim of a name is about."""
        return name.partition("-any-")[0].partition("-only-")[0]

    def view(self, known: Answers) -> Division:
        """Return the cells, each in as few words as is known."""
        plan, outlines = self.plan, self.outlines(known)
        reasons = dict.fromkeys(x.reason for x in outlines if isinstance(x, Undivided))
        if reasons:
            doubts = tuple(Doubt(about="which classes there are", reason=x) for x in reasons)
            return Division(Classes(plan, ((),) * len(plan.groups), ()), {}, doubts, cut_off=True)
        made = [
            [(x.name, *x.found(known, self.asked.in_few_words)) for x in self.cells(k, y)]
            for k, y in enumerate(outlines)
        ]
        cells = [tuple(cell for _, cell, _ in each) for each in made]
        found = tuple(
            Doubt(about=f"whether there is a shorter text for {name}", reason=reason)
            for each in made
            for name, _, reason in each
            if reason
        )
        count = len(plan.groups)
        classes = Classes(plan, tuple(cells[:count]), cells[-1] if plan.has_places else ())
        return Division(classes, self._empty(outlines), found)

    def _empty(self, outlines: "list[Outline | Undivided]") -> dict[tuple[str, ...], tuple[Query, ...]]:
        """Return what is proved never to hold; of places it is said with the first group."""
        groups = self.plan.groups
        found = [x.empty if isinstance(x, Outline) else () for x in outlines]
        empty = {group.vehicles: those for group, those in zip(groups, found, strict=False)}
        if self.plan.has_places:
            empty[groups[0].vehicles] += found[-1]
        return empty

    def data(self, view: Division, place: Place, seconds: float) -> Divided:
        """Return the division as plain data."""
        return view.data


@dataclass(frozen=True)
class AxisBatch:
    """The claims that choices of rows of an axis never hold."""

    basis: Basis
    name: str
    axis: Axis

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self.outline()

    def outline(self) -> Asked[Outline | Undivided]:
        """Ask, and return the cells."""
        return outline(self.axis, self.basis.specification, self.name)


@dataclass(frozen=True)
class CellBatch:
    """The claims that parts of what says a cell follow from the rest; ``name``: that of its definition."""

    basis: Basis
    name: str
    axis: Axis
    holds: tuple[int, ...]
    others: tuple[int, ...]

    @property
    def work(self) -> Work:
        """The work that is allowed for a proof."""
        return Work(self.basis.effort, REFINING, staged=True)

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self._refine()

    def _refine(self) -> Asked[tuple[Cell, Reason]]:
        return refine(self.axis, self.basis.specification, self.name, self.holds, self.others)

    def found(self, known: Answers, in_few_words: bool) -> tuple[Cell, Reason]:
        """Return the cell, and the reason of a doubt whether it has a shorter text."""
        if not in_few_words:
            return whole_cell(self.axis, self.holds, self.others), NO_REASON
        return seen(self._refine(), known)


def divide(
    basis: Basis,
    plan: Plan,
    hands: Jobs = None,
    progress: Progress | None = None,
    in_few_words: bool = True,
    fresh: bool = False,
) -> Division:
    """Return the cells of every axis of a plan.

    ``basis.proof``: units of work for a proof that one is empty; ``in_few_words``: whether each
    cell is said in few words; ``fresh``: whether known cells are found again.
    """
    question = DivisionQuestion(basis, ToDivide(scenarios=plan.numbers, in_few_words=in_few_words))
    return question.view(settle(question, None, hands, progress, "cells", fresh=fresh).answers)
