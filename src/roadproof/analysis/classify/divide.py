"""The cells of a plan: outlined axis by axis, then each said in few words, in several processes.

What is found is no evidence of anything: that cells exclude each other and cover the rows is proved of the
classes that are made of them. But a proof that was cut off or lost would make other classes, or longer
texts, so each is a doubt of the whole.
"""

from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass

from roadproof.analysis.basis import Basis
from roadproof.analysis.classify.cells import Axis, Cell, Outline, outline, refine, whole_cell
from roadproof.analysis.classify.classes import Classes, Plan, what_axis, where_axis
from roadproof.analysis.study import pool
from roadproof.analysis.study.pool import Progress
from roadproof.evidence.answers.classify import Doubt
from roadproof.library.specification import Query
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.executors import Jobs


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


@dataclass(frozen=True)
class CellTask:
    """One cell that is to be said with few words; ``name`` is that of its definition."""

    name: str
    axis: Axis
    holds: tuple[int, ...]
    others: tuple[int, ...]


@dataclass(frozen=True)
class _DivisionJobs:
    """Jobs for other processes. The answer to each is one, or with a reason why there is a doubt."""

    basis: Basis

    def outlined(self, axis: Axis) -> Outline | str:
        try:
            return outline(axis, self.basis)
        except BudgetExceeded as late:
            return str(late)

    def refined(self, job: CellTask) -> tuple[Cell, str]:
        try:
            return refine(job.axis, self.basis, job.holds, job.others), ""
        except BudgetExceeded as late:
            return in_full(job, str(late))


def in_full(job: CellTask, reason: str) -> tuple[Cell, str]:
    """The cell where nothing is known of what follows from what."""
    return whole_cell(job.axis, job.holds, job.others), reason


def divide(
    basis: Basis,
    plan: Plan,
    hands: Jobs = None,
    progress: Progress | None = None,
    in_few_words: bool = True,
) -> Division:
    """The cells of every axis of a plan, with ``basis.proof`` units of work for a proof that one is empty.

    ``in_few_words``: whether each cell is said in few words, which takes longer than to find them all.
    """
    specification, dividing = basis.specification, _DivisionJobs(basis)
    axes = [what_axis(plan, group, specification) for group in plan.groups]
    if plan.has_places:
        axes.append(where_axis(plan, specification))
    outlined = pool.work(dividing.outlined, axes, hands, lambda axis, reason: reason)
    with closing(pool.in_order(outlined)) as made:
        found = list(made)
    outlines = [x for x in found if isinstance(x, Outline)]
    reasons = dict.fromkeys(x for x in found if isinstance(x, str))
    if reasons:
        doubts = tuple(Doubt(about="which classes there are", reason=reason) for reason in reasons)
        return Division(Classes(plan, ((),) * len(plan.groups), ()), {}, doubts, cut_off=True)
    jobs = [
        CellTask(plan.what(cell[0]) if k < len(plan.groups) else plan.where(cell[0]), axes[k], *cell)
        for k, each in enumerate(outlines)
        for cell in each.cells
    ]
    if not in_few_words:
        return _division(plan, outlines, jobs, [in_full(job, "") for job in jobs])
    refined = pool.work(dividing.refined, jobs, hands, in_full, progress, "cells")
    with closing(pool.in_order(refined)) as answers:
        cells = list(answers)
    return _division(plan, outlines, jobs, cells)


def _division(
    plan: Plan, outlines: list[Outline], jobs: list[CellTask], cells: list[tuple[Cell, str]]
) -> Division:
    waiting = iter(cells)
    by_axis = [tuple(next(waiting)[0] for _ in made.cells) for made in outlines]
    count = len(plan.groups)
    empty = {group.vehicles: made.empty for group, made in zip(plan.groups, outlines, strict=False)}
    if plan.has_places:
        first = plan.groups[0].vehicles
        empty[first] = (*empty[first], *outlines[-1].empty)
    doubts = [
        Doubt(about=f"whether there is a shorter text for {job.name}", reason=reason)
        for job, (_, reason) in zip(jobs, cells, strict=True)
        if reason
    ]
    classes = Classes(plan, tuple(by_axis[:count]), by_axis[-1] if plan.has_places else ())
    return Division(classes, empty, tuple(doubts))
