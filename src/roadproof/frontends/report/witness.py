"""Drives that were found: a line about each search, a sheet of all, and the files of the drives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from roadproof.evidence.judged import JudgedDrive
from roadproof.library.scenarios import LANE
from roadproof.library.specification import Library
from roadproof.library.words import words_of
from roadproof.logic.custom_names import freedom_lines
from roadproof.logic.first_instant import first_instant_warnings
from roadproof.questions.witness import SearchResult
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.frontends.report.sheet import Sheet


def as_line(outcome: SearchResult, verbose: bool = False) -> str:
    """Return the result in a line, with its reason; ``verbose`` adds sizes and seconds by stage."""
    name = f"scenario {outcome.scenario}" if outcome.scenario is not None else outcome.query.text
    shown = f"{name:<12} {outcome.set_name:<5} {outcome.verdict:<11} road {outcome.road:<7}"
    if outcome.drives:
        file = outcome.drives[0].file
        shown += f" lane {file.lanes[LANE]}" if LANE in file.lanes else ""
        shown += "".join(f" {k}={v}" for k, v in file.lanes.items() if k != LANE)
        shown += f" horizon {file.horizon} s"
        shown += "" if outcome.natural else " (not natural: within the vehicles' limits only)"
        shown += f" {len(outcome.drives)} drives" if len(outcome.drives) > 1 else ""
    shown += f" {outcome.cost.seconds:.2f} s" if outcome.cost.seconds else ""  # none of a recalled answer
    if outcome.scenario is not None:
        name = words_of(outcome.task.specification, outcome.scenario).name
        shown += f"\n  {name}" if name else ""
    shown += "".join(f"\n  {line}" for line in _wish_lines(outcome))
    formula = outcome.query.formula
    shown += "".join(f"\n  {text}" for text in (*freedom_lines(formula), *first_instant_warnings(formula)))
    if outcome.reason:
        shown += f"\n  {outcome.reason}"
    if outcome.certificate is not None:
        shown += "\n  proved for all time, on every road; parts that clash:"
        shown += "".join(f"\n    {part}" for part in outcome.core_texts)
    if verbose:
        shown += f"\n  sizes {dict(outcome.cost.sizes)}"
        spent = {**outcome.cost.stages, "all": outcome.cost.seconds} if outcome.cost.seconds else {}
        stages = ", ".join(f"{k} {v:.3f}" for k, v in spent.items())
        shown += f"\n  seconds {stages}" if stages else ""
    return shown


def _wish_lines(outcome: SearchResult) -> Iterator[str]:
    """Yield a line of the wishes that all drives fulfil, and a line of the others, where there are any."""
    for heading, value in (("typical", True), ("not typical", False)):
        listed = [name for name, drives in outcome.wishes.items() if all(drives) == value]
        if listed:
            yield f"{heading}: {', '.join(listed)}"


def sheet_of(searches: Sequence[SearchResult]) -> Sheet[SearchResult]:
    """An entry for each search."""
    from roadproof.frontends.report.sheet import Column, Sheet  # here: a line needs no table

    return Sheet(
        (
            Column("scenario", lambda x: x.scenario),
            Column("name", _name),
            Column("set", lambda x: x.set_name),
            Column("formula", lambda x: x.query.text, look="code"),
            Column("verdict", lambda x: x.verdict, look="verdict"),
            Column("road", lambda x: x.road),
            Column("drives", lambda x: len(x.drives)),
            Column("reason", lambda x: x.reason or _core_of(x)),
            Column("seconds", lambda x: x.cost.seconds or None, "frame"),
        ),
        searches,
    )


def _name(result: SearchResult) -> str:
    return "" if result.scenario is None else words_of(result.task.specification, result.scenario).name


def _core_of(result: SearchResult) -> str:
    """The parts that clash where there is no drive at all; empty otherwise."""
    return f"core: {'; '.join(result.core_texts)}" if result.core_texts else ""


@dataclass(frozen=True)
class Views:
    """The files beside a drive file: samples, ``pictures`` where they are wanted and an extension draws them,
    ``animations`` by format.
    """

    pictures: bool = True
    animations: tuple[str, ...] = ()

    @property
    def endings(self) -> tuple[str, ...]:
        """The endings of the file names."""
        from roadproof.frontends.report.animations import animations
        from roadproof.frontends.report.picture import draws_drives

        drawn = (".svg",) if self.pictures and draws_drives() else ()
        return (".csv", *drawn, *(animations()[x].ending for x in self.animations))

    def of(self, judged: JudgedDrive, library: Library) -> Iterator[tuple[str, bytes]]:
        """Yield the files with their contents, the samples first."""
        from roadproof.frontends.report.samples import csv_of

        yield ".csv", csv_of(judged.file).encode()
        from roadproof.frontends.report.animations import animations
        from roadproof.frontends.report.picture import draw_drive, draws_drives

        if self.pictures and draws_drives():
            yield ".svg", draw_drive(judged.file, library).svg

        for name in self.animations:
            animation = animations()[name]
            yield animation.ending, animation.draw(judged.file, library)


def every_view() -> Views:
    """All files that there can be beside a drive file."""
    from roadproof.frontends.report.animations import animations

    return Views(True, tuple(animations()))
