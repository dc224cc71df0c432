"""Answers as build servers and code hosts read them."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import TYPE_CHECKING, ClassVar

from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from roadproof.extensions.assurance.build_results.cases import Case


class BuildResult(ABC):
    """An answer whose parts pass or fail; ``command``: the sub-command that asks for it."""

    command: ClassVar[str]

    @abstractmethod
    def cases(self) -> "Iterable[Case]":
        """What was asked, part by part, with places and evidence."""

    @property
    @abstractmethod
    def exit_code(self) -> ExitCode:
        """The exit code of the command line with this answer."""

    def all_cases(self) -> "Iterator[Case]":
        """The cases, and one for the answer as a whole where none of them says why the exit code is not 0."""
        from roadproof.extensions.assurance.build_results.cases import whole_case

        found = tuple(self.cases())
        yield from found
        whole = whole_case(self.command, found, self.exit_code)
        if whole is not None:
            yield whole

    def to_junit(self) -> str:
        """The cases as JUnit XML: failures where the exit code is 10, errors where it is 20."""
        from roadproof.extensions.assurance.build_results.junit import as_junit

        return as_junit(f"roadproof {self.command}", tuple(self.all_cases()))

    def to_sarif(self) -> str:
        """The cases that did not pass as SARIF 2.1.0, with file, line and column."""
        from roadproof.extensions.assurance.build_results.sarif import as_sarif

        return as_sarif(self.command, tuple(self.all_cases()), self.exit_code)
