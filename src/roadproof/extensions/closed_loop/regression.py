"""Failing drives as regression tests in a catalogue, with copies for other tools."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from roadproof.evidence.judged import JudgedDrive, RejectedError
from roadproof.extensions.catalogue.completing import Completion
from roadproof.extensions.catalogue.writing import write_completions
from roadproof.extensions.closed_loop.question import FalsifyQuestion
from roadproof.extensions.closed_loop.view import FalsifyView, TargetView
from roadproof.library.scenarios import number_in
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class WrittenTests:
    """The tests that were written into a folder, in how many files of other tools, and remarks on these."""

    folder: Path
    tests: tuple[str, ...]
    copies: int
    notes: tuple[str, ...]

    def __str__(self) -> str:
        copies = f", and {self.copies} copies for other tools" if self.copies else ""
        line = f"{len(self.tests)} regression test{'s' * (len(self.tests) != 1)} in {self.folder}{copies}"
        return "\n".join([line, *self.notes])


def write_tests(
    folder: Path, question: FalsifyQuestion, view: FalsifyView, formats: str | Iterable[str] = ()
) -> WrittenTests:
    """Write each failing drive as a test of its scenario, and an entry in ``catalogue.toml``.

    POV does in the test what it did to the controller. Raises ``InputError``, ``UsageError``.
    """
    completions = [*_completions(question, view)]
    titles = {x.name: f"{question.title(x.target)}: failure of {_name(question)}" for x in completions}
    made = write_completions(folder, completions, titles, question.formulas, formats)
    return WrittenTests(folder, tuple(titles), len(made.copies), made.notes)


def _name(question: FalsifyQuestion) -> str:
    return Path(question.settings.controller).name


def _completions(question: FalsifyQuestion, view: FalsifyView) -> Iterator[Completion]:
    for x in view.failures:
        drive = _as_test(question, x)
        if drive is not None:
            yield Completion(x.name, drive, name=f"failure-{x.name}")


def _as_test(question: FalsifyQuestion, x: TargetView) -> JudgedDrive | None:
    """Return the failing drive with the formula of its scenario alone, which every library can read."""
    if x.drive is None:
        return None
    text = question.formulas.query_of(x.name).text
    file = replace(x.drive.file, scenario=number_in(x.name), formula=text)
    try:
        return JudgedDrive(file, question.basis.library)
    except RejectedError:  # never: the formula of the failing drive is a conjunction with it
        return None
