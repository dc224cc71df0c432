"""Answers as build servers and code hosts read them; the formats come with an extension."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from roadproof.errors import UsageError
from roadproof.extension import entries, import_entry

if TYPE_CHECKING:
    from roadproof.frontends.report.cases import Case
    from roadproof.verdict import ExitCode

Writer: TypeAlias = "Callable[[str, Sequence[Case], ExitCode, Sequence[str]], str]"
"""Makes the text of a file out of a command, its cases, its exit code, and what was asked unusually."""


def formats() -> tuple[str, ...]:
    """The formats that are installed, such as junit and sarif."""
    return tuple(entries("build_results"))


def written(
    format: str, command: str, cases: Sequence[Case], code: ExitCode, in_force: Sequence[str] = ()
) -> str:
    """Return the cases of a command in a format. Raises ``UsageError`` where it is not installed."""
    known = entries("build_results")
    if format not in known:
        raise UsageError(f"format={format!r}: there is {', '.join(known) or 'none; install an extension'}")
    write: Writer = import_entry(known[format])
    return write(command, cases, code, in_force)


class BuildResult(ABC):
    """An answer whose parts pass or fail; ``command``: the sub-command that asks for it."""

    command: ClassVar[str]

    @abstractmethod
    def cases(self) -> Iterable[Case]:
        """Return the parts of the question as cases, with places and evidence."""

    @property
    def in_force(self) -> Sequence[str]:
        """The settings that differ from the defaults, in words."""
        return ()

    @property
    @abstractmethod
    def exit_code(self) -> ExitCode:
        """The exit code of the command line with this answer."""

    def all_cases(self) -> Iterator[Case]:
        """The cases, and one for the answer as a whole where none of them says why the exit code is not 0."""
        from roadproof.frontends.report.cases import whole_case

        parts = tuple(self.cases())
        yield from parts
        whole = whole_case(self.command, parts, self.exit_code)
        if whole is not None:
            yield whole

    def to(self, format: str) -> str:
        """The cases in a format for build servers, such as junit. Raises ``UsageError``."""
        return written(format, self.command, tuple(self.all_cases()), self.exit_code, self.in_force)

    def to_junit(self) -> str:
        """The cases as JUnit XML: failures where the exit code is 10, errors where it is 20."""
        return self.to("junit")

    def to_sarif(self) -> str:
        """The cases that did not pass as SARIF 2.1.0, with file, line and column."""
        return self.to("sarif")
