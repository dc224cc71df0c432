"""Drives that were found: a line about each search, and the files of its drives."""

from collections.abc import Iterator

from roadproof.engines.search.ask import Outcome
from roadproof.evidence.judged import JudgedDrive
from roadproof.frontends.report.drive import draw_drive
from roadproof.library.scenarios import LANE
from roadproof.library.specification import Library, Specification
from roadproof.library.words import Words, words_of
from roadproof.logic.custom_names import told_freedom
from roadproof.recordings.export.csv_table import csv_of


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
    shown += f" {outcome.seconds['all']:.2f} s"
    if outcome.scenario is not None:
        shown += _called(words_of(specification, outcome.scenario))
    shown += "".join(f"\n  {said}" for said in told_freedom(outcome.query.formula))
    if outcome.reason:
        shown += f"\n  {outcome.reason}"
    if outcome.impossibility is not None:
        kind = "minimal core" if outcome.impossibility.minimal else "core, not minimised with the work given"
        shown += f"\n  proved for all time, on every road; {kind}:"
        shown += "".join(f"\n    {part}" for part in outcome.impossibility.told)
    if verbose:
        shown += f"\n  sizes {dict(outcome.sizes)}"
        shown += "\n  seconds " + ", ".join(f"{k} {v:.3f}" for k, v in outcome.seconds.items())
    return shown


def _called(words: Words) -> str:
    """What a scenario is called, on a line below its number."""
    return f"\n  {words.name}" if words.name else ""


def kinds(pictures: bool) -> tuple[str, ...]:
    """How the files end that lie beside a drive file to be looked at."""
    return ("csv", "png", "svg") if pictures else ("csv",)


def files_of(judged: JudgedDrive, stem: str, library: Library, pictures: bool) -> Iterator[tuple[str, bytes]]:
    """The same by name, with what is in them: samples, pictures."""
    yield f"{stem}.csv", csv_of(judged.file).encode()
    if pictures:
        for kind, content in draw_drive(judged.file, library).items():
            yield f"{stem}.{kind}", content
