"""The question for the cells of the axes of a plan, each with a short text.

Its claims say that choices of scenarios never hold. The cells need no trust: ``classify`` claims that the
classes made of them exclude each other and cover the scenarios. But a lost or interrupted proof would lead to
other classes or longer texts. So each is listed as undecided.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

from roadproof.errors import RoadproofError, UsageError
from roadproof.evidence.codec import Doc, read
from roadproof.extensions.surveys.classify.cells import (
    Axis,
    Cell,
    Outline,
    OutlineFailure,
    outline,
    refine,
    whole_cell,
)
from roadproof.extensions.surveys.classify.classes import (
    Classes,
    DivisionPlan,
    plan_of,
    what_axis,
    where_axis,
)
from roadproof.extensions.surveys.classify.data import DivisionData, DivisionGroupData, Numbers, UndecidedPart
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.extensions.surveys.survey import replay_steps
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.decide import decide_claims
from roadproof.questions.question import Answers, EvidencePlace, Steps, walk_batch
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress

REFINING = 2.0  # units of work for a proof that something follows


@dataclass(frozen=True)
class Division:
    """The cells of every axis of a plan; ``empty``: formulas proved never to hold, by vehicles of the group.

    ``doubts``: cells whose text may be longer than necessary. ``cut_off``: the cells are undecided, so there
    are none.
    """

    classes: Classes
    empty: Mapping[tuple[str, ...], tuple[Query, ...]]
    doubts: tuple[UndecidedPart, ...] = ()
    cut_off: bool = False

    @property
    def data(self) -> DivisionData:
        """The division as plain data, the settings of ``ClassifyQuestion``."""
        plan = self.classes.plan
        if self.cut_off:
            return DivisionData(scenarios=plan.numbers, doubts=self.doubts)
        groups = tuple(
            DivisionGroupData(
                vehicles=group.vehicles,
                cells=tuple(cell.holds for cell in cells),
                empty=tuple(x.text for x in self.empty.get(group.vehicles, ())),
            )
            for group, cells in zip(plan.groups, self.classes.what, strict=True)
        )
        places = tuple(cell.holds for cell in self.classes.where)
        return DivisionData(scenarios=plan.numbers, groups=groups, places=places, doubts=self.doubts)


@dataclass(frozen=True, kw_only=True)
class DivisionSettings:
    """The scenarios to divide into classes."""

    scenarios: Annotated[Numbers, Doc("The scenarios that are divided.")]
    in_few_words: Annotated[bool, Doc("Whether each cell is said in few words.")] = True


@dataclass(frozen=True)
class DivisionQuestion:
    """The question for the cells of every axis of a plan.

    ``in_few_words`` shortens the text of each cell, which takes longer than to find the cells.
    """

    kind: ClassVar[str] = "division"
    basis: Basis
    settings: DivisionSettings

    @property
    def work(self) -> Work:
        """The work that is allowed for a proof that a cell is empty."""
        return Work(self.basis.effort, self.basis.proof, staged=True)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "DivisionQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        return cls(basis, read(DivisionSettings, settings, where))

    @cached_property
    def plan(self) -> DivisionPlan:
        """The division into classes. Raises ``InputError``, ``UsageError``."""
        return plan_of(self.basis.specification, self.settings.scenarios)

    @cached_property
    def axes(self) -> dict[str, "AxisBatch"]:
        """The axes by name: disturbances of each group, then road sectors."""
        specification = self.basis.specification
        axes = [what_axis(self.plan, group, specification) for group in self.plan.groups]
        if self.plan.has_places:
            axes.append(where_axis(self.plan, specification))
        return {(name := f"axis-{k}"): AxisBatch(self.basis, name, axis) for k, axis in enumerate(axes)}

    def batches(self, known: Answers) -> "list[AxisBatch | CellBatch]":
        """A batch for each axis; then one for each cell, where none of them is in doubt."""
        first = [*self.axes.values()]
        if any([*walk_batch(x, lambda name, _: known.get(name))] for x in first):
            return [*first]
        outlines = self.outlines(known)
        if not self.settings.in_few_words or any(isinstance(x, OutlineFailure) for x in outlines):
            return [*first]
        return [*first, *(x for k, _ in enumerate(outlines) for x in self.cells(k, outlines[k]))]

    def outlines(self, known: Answers) -> "list[Outline | OutlineFailure]":
        """Return the cells of each axis."""
        return [replay_steps(x.outline(), known) for x in self.axes.values()]

    def cells(self, place: int, axis_outline: Outline | OutlineFailure) -> "list[CellBatch]":
        """Return a batch for each cell of the axis at a place."""
        if isinstance(axis_outline, OutlineFailure):
            return []
        named = self.plan.what if place < len(self.plan.groups) else self.plan.where
        axis = [*self.axes.values()][place].axis
        return [
            CellBatch(self.basis, named(holds), axis, holds, others) for holds, others in axis_outline.cells
        ]

    def label(self, name: str) -> str:
        """Return the axis or the cell that the claim of a name is about."""
        return name.partition("-any-")[0].partition("-only-")[0]

    def view(self, known: Answers) -> Division:
        """Return the cells, each with the shortest text that is proved."""
        plan, outlines = self.plan, self.outlines(known)
        reasons = dict.fromkeys(x.reason for x in outlines if isinstance(x, OutlineFailure))
        if reasons:
            undecided = tuple(UndecidedPart(about="which classes there are", reason=x) for x in reasons)
            return Division(Classes(plan, ((),) * len(plan.groups), ()), {}, undecided, cut_off=True)
        made = [
            [(x.name, *x.refined_cell(known, self.settings.in_few_words)) for x in self.cells(k, y)]
            for k, y in enumerate(outlines)
        ]
        cells = [tuple(cell for _, cell, _ in each) for each in made]
        long_texts = tuple(
            UndecidedPart(about=f"whether there is a shorter text for {name}", reason=reason)
            for each in made
            for name, _, reason in each
            if reason
        )
        count = len(plan.groups)
        classes = Classes(plan, tuple(cells[:count]), cells[-1] if plan.has_places else ())
        return Division(classes, self._empty(outlines), long_texts)

    def _empty(self, outlines: "list[Outline | OutlineFailure]") -> dict[tuple[str, ...], tuple[Query, ...]]:
        """Return the formulas proved never to hold; those of road sectors are with the first group."""
        groups = self.plan.groups
        empty_by_axis = [x.empty if isinstance(x, Outline) else () for x in outlines]
        empty = {group.vehicles: those for group, those in zip(groups, empty_by_axis, strict=False)}
        if self.plan.has_places:
            empty[groups[0].vehicles] += empty_by_axis[-1]
        return empty

    def data(self, view: Division, place: EvidencePlace, seconds: float) -> DivisionData:
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

    def outline(self) -> ClaimGenerator[Outline | OutlineFailure]:
        """Ask which choices never hold, and return the cells."""
        return outline(self.axis, self.basis.specification, self.name)


@dataclass(frozen=True)
class CellBatch:
    """The claims that parts of a cell's formula follow from the rest; ``name``: that of its definition."""

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

    def _refine(self) -> ClaimGenerator[tuple[Cell, Reason]]:
        return refine(self.axis, self.basis.specification, self.name, self.holds, self.others)

    def refined_cell(self, known: Answers, in_few_words: bool) -> tuple[Cell, Reason]:
        """Return the cell, and the reason why a shorter text is undecided, if it is."""
        if not in_few_words:
            return whole_cell(self.axis, self.holds, self.others), NO_REASON
        return replay_steps(self._refine(), known)


def divide(
    basis: Basis,
    plan: DivisionPlan,
    jobs: Jobs = None,
    progress: Progress | None = None,
    in_few_words: bool = True,
    fresh: bool = False,
) -> Division:
    """Return the cells of every axis of a plan.

    ``basis.proof``: units of work for a proof that a cell is empty; ``in_few_words``: whether to shorten the
    text of each cell; ``fresh``: whether to ignore known answers.
    """
    question = DivisionQuestion(basis, DivisionSettings(scenarios=plan.numbers, in_few_words=in_few_words))
    return question.view(decide_claims(question, None, jobs, progress, "cells", fresh=fresh).answers)


def divide_surely(basis: Basis, numbers: Sequence[int]) -> Classes:
    """Return the classes of scenarios. Raises ``UsageError`` where the proofs leave them in doubt."""
    try:
        plan = plan_of(basis.specification, numbers)
    except RoadproofError as error:
        raise UsageError(f"{error}; or leave out classes with --no-classes") from None
    division = divide(basis, plan, None, None, in_few_words=False)
    if division.cut_off:
        reasons = "; ".join(x.reason for x in division.doubts)
        raise UsageError(f"the classes are in doubt ({reasons}): give more work, or use --no-classes")
    return division.classes
