"""Drives that were found: a line about each search, a sheet of all, and the files of the drives."""

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from roadproof.engines.search.outcome import Outcome
from roadproof.evidence.judged import JudgedDrive
from roadproof.frontends.report.animation import ENDINGS, draw_animation
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.library.scenarios import LANE
from roadproof.library.specification import Library, Specification
from roadproof.library.words import words_of
from roadproof.logic.custom_names import told_freedom
from roadproof.logic.first_instant import told_first_instants
from roadproof.runtime.records import dataclass

SearchedFor: TypeAlias = tuple[Outcome, Specification]
"""What a search found, and the definitions that it was about."""


def as_line(outcome: Outcome, specification: Specification, verbose: bool = False) -> str:
    """What was found, and why not; with ``verbose`` also sizes and seconds by stage."""
    name = f"scenario {outcome.scenario}" if outcome.scenario is not None else outcome.query.text
    shown = f"{name:<12} {outcome.set_name:<5} {outcome.verdict:<11} road {outcome.road:<7}"
    if outcome.drives:
        file = outcome.drives[0].file
        shown += f" lane {file.lanes[LANE]}" if LANE in file.lanes else ""
        shown += "".join(f" {k}={v}" for k, v in file.lanes.items() if k != LANE)
        shown += f" horizon {file.horizon} s"
        shown += "" if outcome.natural else " (not natural: within the vehicles' limits only)"
        shown += f" {len(outcome.drives)} drives" if len(outcome.drives) > 1 else ""
    shown += f" {outcome.seconds['all']:.2f} s" if outcome.seconds else ""  # none of a recalled answer
    if outcome.scenario is not None:
        name = words_of(specification, outcome.scenario).name
        shown += f"\n  {name}" if name else ""
    asked = outcome.query.formula
    shown += "".join(f"\n  {said}" for said in (*told_freedom(asked), *told_first_instants(asked)))
    if outcome.reason:
        shown += f"\n  {outcome.reason}"
    if outcome.impossibility is not None:
        kind = "minimal core" if outcome.impossibility.minimal else "core, not minimised with the work given"
        shown += f"\n  proved for all time, on every road; {kind}:"
        shown += "".join(f"\n    {part}" for part in outcome.impossibility.told)
    if verbose:
        shown += f"\n  sizes {dict(outcome.sizes)}"
        stages = ", ".join(f"{k} {v:.3f}" for k, v in outcome.seconds.items())
        shown += f"\n  seconds {stages}" if stages else ""
    return shown


def sheet_of(searches: Sequence[SearchedFor]) -> Sheet[SearchedFor]:
    """An entry for each search."""
    return Sheet(
        (
            Column("scenario", lambda x: x[0].scenario),
            Column("name", lambda x: "" if x[0].scenario is None else words_of(x[1], x[0].scenario).name),
            Column("set", lambda x: x[0].set_name),
            Column("formula", lambda x: x[0].query.text, look="code"),
            Column("verdict", lambda x: x[0].verdict, look="verdict"),
            Column("road", lambda x: x[0].road),
            Column("drives", lambda x: len(x[0].drives)),
            Column("reason", lambda x: x[0].reason or _core_of(x[0])),
            Column("seconds", lambda x: x[0].seconds.get("all"), "frame"),
        ),
        searches,
    )


def _core_of(outcome: Outcome) -> str:
    """The parts that clash where there is no drive at all; empty otherwise."""
    return "" if outcome.impossibility is None else f"core: {'; '.join(outcome.impossibility.told)}"


@dataclass(frozen=True)
class Views:
    """The files beside a drive file: samples, ``pictures`` where wanted, ``animations`` by format."""

    pictures: bool = True
    animations: tuple[str, ...] = ()

    @property
    def endings(self) -> tuple[str, ...]:
        """How the names of the files end."""
        drawn = (".png", ".svg") if self.pictures else ()
        return (".csv", *drawn, *(ENDINGS[x] for x in self.animations))

    def of(self, judged: JudgedDrive, library: Library) -> Iterator[tuple[str, bytes]]:
        """The same, with their contents; the samples come first."""
        from roadproof.recordings.export.csv_table import csv_of

        yield ".csv", csv_of(judged.file).encode()
        if self.pictures:
            from roadproof.frontends.report.drive import draw_drive
            from roadproof.frontends.report.figures import as_bytes

            for kind, content in as_bytes(draw_drive(judged.file, library)).items():
                yield f".{kind}", content
        for name in self.animations:
            yield ENDINGS[name], draw_animation(judged.file, library, name)


EVERY_VIEW = Views(True, tuple(ENDINGS))
