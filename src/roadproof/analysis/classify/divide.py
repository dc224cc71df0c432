"""The cells of every axis of a plan: outlined axis by axis, then each said in few words.

What is found is no evidence of anything: that cells exclude each other and cover the rows is proved of the
classes that are made of them. But a proof that was cut off or lost would make other classes, or longer texts,
so each is a doubt of the whole.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, TypeAlias

from roadproof.analysis.basis import Basis
from roadproof.analysis.classify.cells import Axis, Cell, Outline, outline, refine, whole_cell
from roadproof.analysis.classify.classes import Classes, Plan, what_axis, where_axis
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared, conduct
from roadproof.analysis.study.pool import Progress
from roadproof.evidence.codec import Doc
from roadproof.evidence.strict import JsonObject
from roadproof.library.elaborate import StatedQuery
from roadproof.library.specification import Query
from roadproof.questions.classify.data import Doubt
from roadproof.reasons import NO_REASON, Reason
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
    axis: int
    holds: tuple[int, ...]
    others: tuple[int, ...]


@dataclass(frozen=True)
class Undivided:
    """Why an axis was not outlined."""

    reason: Reason


@dataclass(frozen=True)
class DivisionRecord:
    """The outline of an axis or a cell as it is kept: formulas are texts."""

    name: Annotated[str, Doc("The axis or the cell.")]
    cells: Annotated[
        tuple[tuple[tuple[int, ...], tuple[int, ...]], ...],
        Doc("For each cell the rows that hold and those that do not."),
    ] = ()
    empty: Annotated[tuple[str, ...], Doc("What is proved never to hold.")] = ()
    holds: Annotated[tuple[int, ...], Doc("The rows of the cell.")] = ()
    said: Annotated[tuple[int, ...], Doc("The rows that say so.")] = ()
    denied: Annotated[tuple[str, ...], Doc("The formulas that do not hold.")] = ()


@dataclass(frozen=True)
class CellAnswer:
    """A cell, with the reason of a doubt whether it has a shorter text."""

    cell: Cell
    reason: Reason = NO_REASON


DivisionAnswer: TypeAlias = Outline | Undivided | CellAnswer
SCHEMA = "roadproof/division/1"


@dataclass(frozen=True)
class Dividing(Unprepared):
    """The question for the cells of every axis of a plan, as a ``study.frame.Study``.

    ``in_few_words``: whether each cell is said in few words, which takes longer than to find them all.
    """

    record_type: ClassVar[type[DivisionRecord]] = DivisionRecord
    basis: Basis
    plan: Plan
    in_few_words: bool = True

    @property
    def question(self) -> Question:
        said: JsonObject = {"set": self.plan.set_name, "scenarios": [*self.plan.numbers], **self.basis.said()}
        return Question(SCHEMA, said, self.basis.limits, self.basis.library)

    @cached_property
    def axes(self) -> dict[str, Axis]:
        """What is divided, by name: what happens for each group, then where."""
        specification = self.basis.specification
        axes = [what_axis(self.plan, group, specification) for group in self.plan.groups]
        if self.plan.has_places:
            axes.append(where_axis(self.plan, specification))
        return {f"axis-{k}": axis for k, axis in enumerate(axes)}

    def cells(self, known: Mapping[str, DivisionAnswer]) -> list[CellTask]:
        """The cells of all axes, as far as these are known."""
        count = len(self.plan.groups)
        return [
            CellTask(self.plan.what(holds) if k < count else self.plan.where(holds), k, holds, others)
            for k, name in enumerate(self.axes)
            if isinstance(made := known.get(name), Outline)
            for holds, others in made.cells
        ]

    def pieces(self, known: Mapping[str, DivisionAnswer]) -> Sequence[str | CellTask]:
        left = [name for name in self.axes if name not in known]
        if left or not self.in_few_words or any(isinstance(x, Undivided) for x in known.values()):
            return left
        return [task for task in self.cells(known) if task.name not in known]

    def settle(self, piece: str | CellTask) -> dict[str, DivisionAnswer]:
        if isinstance(piece, str):
            try:
                return {piece: outline(self.axes[piece], self.basis)}
            except BudgetExceeded as late:
                return {piece: Undivided(late.reason)}
        axis = [*self.axes.values()][piece.axis]
        try:
            return {piece.name: CellAnswer(refine(axis, self.basis, piece.holds, piece.others))}
        except BudgetExceeded as late:
            return self.doubt(piece, late.reason)

    def doubt(self, piece: str | CellTask, reason: Reason) -> dict[str, DivisionAnswer]:
        """Nothing is known of what follows from what."""
        if isinstance(piece, str):
            return {piece: Undivided(reason)}
        axis = [*self.axes.values()][piece.axis]
        return {piece.name: CellAnswer(whole_cell(axis, piece.holds, piece.others), reason)}

    def is_sure(self, answer: DivisionAnswer) -> bool:
        return isinstance(answer, Outline) or (isinstance(answer, CellAnswer) and not answer.reason)

    def wanted(self, known: Mapping[str, DivisionAnswer]) -> Collection[str]:
        return [*self.axes, *(x.name for x in self.cells(known) if self.in_few_words)]

    def key(self, name: str) -> str:
        return self.basis.key(self._asked, self.plan, name)

    @cached_property
    def _asked(self) -> list[Query]:
        """Everything that proofs about cells are made of: contexts, rows and their parts."""
        found: list[Query] = []
        for axis in self.axes.values():
            found += [*axis.context, *axis.rows.values()]
            found += [part for parts in axis.parts.values() for part in parts]
        return found

    def record(self, name: str, answer: DivisionAnswer, shelf: EvidenceStore) -> DivisionRecord:
        match answer:
            case Outline(cells, empty):
                return DivisionRecord(name, cells=cells, empty=tuple(x.text for x in empty))
            case CellAnswer(Cell(holds, said, denied)):
                texts = tuple(x.text for x in denied)
                return DivisionRecord(name, holds=holds, said=said, denied=texts)
            case Undivided():
                return DivisionRecord(name)

    def recall(self, record: DivisionRecord, shelf: EvidenceStore) -> tuple[str, DivisionAnswer]:
        home = self.basis.specification
        if record.name in self.axes:
            return record.name, Outline(record.cells, tuple(StatedQuery(home, x) for x in record.empty))
        denied = tuple(StatedQuery(home, x) for x in record.denied)
        return record.name, CellAnswer(Cell(record.holds, record.said, denied))


def divide(
    basis: Basis,
    plan: Plan,
    hands: Jobs = None,
    progress: Progress | None = None,
    in_few_words: bool = True,
    fresh: bool = False,
) -> Division:
    """The cells of every axis of a plan, with ``basis.proof`` units of work for a proof that one is empty.

    ``in_few_words``: whether each cell is said in few words; ``fresh``: whether known cells are found again.
    """
    study = Dividing(basis, plan, in_few_words)
    found = conduct(study, None, hands, progress, "cells", fresh=fresh).answers
    reasons = dict.fromkeys(x.reason for x in found.values() if isinstance(x, Undivided))
    if reasons:
        doubts = tuple(Doubt(about="which classes there are", reason=reason) for reason in reasons)
        return Division(Classes(plan, ((),) * len(plan.groups), ()), {}, doubts, cut_off=True)
    outlines = [x for name in study.axes if isinstance(x := found[name], Outline)]
    tasks = study.cells(found)
    told = [(found if in_few_words else study.doubt(task, NO_REASON))[task.name] for task in tasks]
    return _division(plan, outlines, tasks, [x for x in told if isinstance(x, CellAnswer)])


def _division(
    plan: Plan, outlines: Sequence[Outline], tasks: Sequence[CellTask], cells: Sequence[CellAnswer]
) -> Division:
    waiting = iter(cells)
    by_axis = [tuple(next(waiting).cell for _ in made.cells) for made in outlines]
    count = len(plan.groups)
    empty = {group.vehicles: made.empty for group, made in zip(plan.groups, outlines, strict=False)}
    if plan.has_places:
        first = plan.groups[0].vehicles
        empty[first] = (*empty[first], *outlines[-1].empty)
    doubts = [
        Doubt(about=f"whether there is a shorter text for {task.name}", reason=told.reason)
        for task, told in zip(tasks, cells, strict=True)
        if told.reason
    ]
    classes = Classes(plan, tuple(by_axis[:count]), by_axis[-1] if plan.has_places else ())
    return Division(classes, empty, tuple(doubts))
