"""The base of all answers: verdicts, evidence, files, checks and pictures."""

from __future__ import annotations

from abc import abstractmethod
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.errors import UsageError
from roadproof.frontends.api.table import Row, Table

if TYPE_CHECKING:
    from roadproof.evidence.kinds import Evidence
    from roadproof.evidence.strict import JsonObject
    from roadproof.frontends.api.checking import CheckReport, Solver
    from roadproof.frontends.report.picture import Picture
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.verdict import ExitCode, Verdict
    from roadproof.world.length_error import LengthError
    from roadproof.world.road import Road


class BaseAnswer(Table):
    """An answer to one question or to many. ``str`` gives it as the terminal prints it."""

    @property
    @abstractmethod
    def verdicts(self) -> Mapping[str, Verdict]:
        """The verdict on each thing that was asked, by its name."""

    @property
    def verdict(self) -> Verdict:
        """The verdict where one thing was asked. Raises ``UsageError`` where it were several."""
        if len(self.verdicts) != 1:
            raise UsageError(f"{len(self.verdicts)} verdicts: use .verdicts, or ask one question")
        return next(iter(self.verdicts.values()))

    @property
    @abstractmethod
    def evidence(self) -> tuple[Evidence, ...]:
        """Certificates, judged drives and judged traces, in order."""

    @property
    def road(self) -> Road | None:
        """The road that the question names; None where it names none, or the answer is about all roads."""
        return None

    @property
    def roads(self) -> tuple[Road, ...]:
        """The roads that the question names."""
        return () if self.road is None else (self.road,)

    @property
    def left_out(self) -> tuple[str, ...]:
        """The notes on parts of files that were left out, such as of the map of a road."""
        from roadproof.world.not_read import road_not_read_note

        return tuple(x for road in self.roads for x in road_not_read_note(road))

    @property
    def length_error(self) -> LengthError | None:
        """Return how far lengths in lanes of the road are from those in s; None where it is straight."""
        from roadproof.world.length_error import length_error_of

        return length_error_of(self.road)

    @property
    @abstractmethod
    def exit_code(self) -> ExitCode:
        """The exit code of the command line with this answer."""

    @property
    @abstractmethod
    def _sheet(self) -> Sheet[Any]:
        """An entry for each thing that was asked."""

    def rows(self) -> list[Row]:
        """A row for each thing that was asked."""
        from roadproof.frontends.report.sheet import as_rows

        return as_rows(self._sheet)

    @abstractmethod
    def as_data(self) -> JsonObject:
        """The answer as the plain data of ``--json``."""

    @abstractmethod
    def _write(self, folder: Path, pictures: bool) -> None:
        """Write evidence and index into a folder."""

    def _specs(self, folder: Path) -> list[Path]:
        """The specification files in a folder with this answer that no index names."""
        return []

    @abstractmethod
    def __str__(self) -> str: ...

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self._counts()}>"

    def _counts(self) -> str:
        """Return how many verdicts of each kind."""
        return ", ".join(f"{n} {verdict}" for verdict, n in Counter(self.verdicts.values()).items())

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Pictures with their names, drawn one by one; none where there is nothing to be drawn."""
        yield from ()

    def pictures(self) -> dict[str, Picture]:
        """All pictures by name."""
        return dict(self.each_picture())

    def plot(self) -> Picture:
        """The first picture. Raises ``UsageError`` where there is none."""
        for _, drawn in self.each_picture():
            return drawn
        raise UsageError(f"there is no picture of {type(self).__name__}: print it, or look at to_frame()")

    def save(self, folder: str | Path, pictures: bool = True) -> Path:
        """Write the evidence, with ``pictures`` to be looked at, into a folder that ``check`` accepts.

        Specification files of yours lie beside it; of ``compare``, which writes no index, ``check`` is told
        of them by ``specs``. Nothing is written where there is no evidence. Raises
        ``InputError`` where the folder cannot be written, ``UsageError`` where it holds the answers to
        another question.
        """
        self._write(Path(folder), pictures)
        return Path(folder)

    def check(self, solver: Solver = "z3", jobs: int | None = 1) -> CheckReport:
        """Check the evidence again, as ``roadproof check`` does with a folder of it.

        Raises ``UsageError`` where there is no evidence, as of UNKNOWN, and of a NONE-WITHIN without a tree;
        ``MissingSolverError``.
        """
        import tempfile

        from roadproof.frontends.api.checking import check

        with tempfile.TemporaryDirectory() as place:
            folder = self.save(place, pictures=False)
            if not any(folder.iterdir()):
                raise UsageError(
                    f"there is no evidence to check: {self._counts() or 'no question was asked'}"
                )
            return check(folder, solver=solver, specs=self._specs(folder), jobs=jobs)

    def _repr_html_(self) -> str:
        import html

        rows = self.rows()
        heading = "".join(f"<th>{html.escape(name)}</th>" for name in (rows[0] if rows else ()))
        lines = ["".join(f"<td>{html.escape(_shown(x))}</td>" for x in row.values()) for row in rows[:_MOST]]
        body = "".join(f"<tr>{line}</tr>" for line in lines)
        more = f"<p>… {len(rows) - _MOST} more</p>" if len(rows) > _MOST else ""
        return f"<p><b>{html.escape(self._counts())}</b></p><table><tr>{heading}</tr>{body}</table>{more}"


_MOST = 60  # rows that a notebook shows


def _shown(value: object) -> str:
    return "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)
