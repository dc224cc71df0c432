"""The overlap of scenarios to look at: a matrix as text, a sheet; an extension draws it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from roadproof.library.words import legend
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.library.words import ScenarioWords
    from roadproof.questions.overlap import PairVerdict

SIGNS: Mapping[Verdict, str] = {  # partial: a pair has no other verdicts
    Verdict.WITNESSED: "#",
    Verdict.IMPOSSIBLE: ".",
    Verdict.NONE_WITHIN: "-",
    Verdict.UNKNOWN: "?",
}
MEANING: Mapping[Verdict, str] = {  # partial: a pair has no other verdicts
    Verdict.WITNESSED: "compatible: both hold on a judged drive",
    Verdict.IMPOSSIBLE: "incompatible: proved for all time",
    Verdict.NONE_WITHIN: "no drive within the limits",
    Verdict.UNKNOWN: "not decided",
}
FEW = 30
"""So many pairs are listed by number."""


def as_text(verdicts: Sequence[PairVerdict], across: bool, words: ScenarioWords) -> str:
    """The matrix, below it which pairs have which verdict, and why, and what the scenarios are called."""
    lines = [as_matrix(verdicts, across)]
    for verdict in Verdict:
        matching = [x for x in verdicts if x.verdict is verdict]
        if matching:
            few = ", ".join(f"{x.a.number}-{x.b.number}" for x in matching) if len(matching) <= FEW else ""
            lines.append(f"{len(matching):>4} {verdict}" + (f": {few}" if few else ""))
            lines += [f"       {reason}" for reason in dict.fromkeys(x.reason for x in matching if x.reason)]
    lines += [f"  {line}" for line in legend(words)]
    return "\n".join(lines)


def as_matrix(verdicts: Sequence[PairVerdict], across: bool) -> str:
    """One sign a pair, rows ``a`` and columns ``b``; symmetric unless ``across`` two sets."""
    rows, columns = axes_of(verdicts, across)
    signs = cells_of(verdicts, across)
    lines = ["    " + "".join(f"{column:>3}" for column in columns)]
    for row in rows:
        cells = (SIGNS[signs[row, column]] if (row, column) in signs else " " for column in columns)
        lines.append(f"{row:>4}" + "".join(f"  {cell}" for cell in cells))
    present = [v for v in SIGNS if any(x.verdict is v for x in verdicts)]
    return "\n".join([*lines, *(f"  {SIGNS[v]} {v}: {MEANING[v]}" for v in present)])


def sheet_of(verdicts: Sequence[PairVerdict], words: ScenarioWords) -> Sheet[PairVerdict]:
    """An entry for each pair; parts of a core are separated by semicolons."""
    from roadproof.frontends.report.sheet import Column, Sheet  # here: the text needs no table

    return Sheet(
        (
            Column("a", lambda x: x.a),
            Column("b", lambda x: x.b),
            Column("set_a", lambda x: x.a.set_name, "csv"),
            Column("set_b", lambda x: x.b.set_name, "csv"),
            Column("verdict", lambda x: x.verdict),
            Column("formula", lambda x: x.query.text, "csv"),
            Column("core", lambda x: "; ".join(x.core_texts), "csv"),
            Column("reason", lambda x: x.reason),
            Column("evidence", _evidence, "csv"),
            Column("name_a", lambda x: words[x.a.number].name, "csv"),
            Column("name_b", lambda x: words[x.b.number].name, "csv"),
        ),
        verdicts,
    )


def _evidence(pair: PairVerdict) -> str:
    """The names of the files that show the verdict."""
    return "; ".join(f"{name}.json" for name in pair.evidence)


def axes_of(verdicts: Sequence[PairVerdict], across: bool) -> tuple[list[int], list[int]]:
    rows, columns = {x.a.number for x in verdicts}, {x.b.number for x in verdicts}
    return (sorted(rows), sorted(columns)) if across else (sorted(rows | columns),) * 2


def cells_of(verdicts: Sequence[PairVerdict], across: bool) -> Mapping[tuple[int, int], Verdict]:
    cells = {(x.a.number, x.b.number): x.verdict for x in verdicts}
    return cells if across else cells | {(b, a): verdict for (a, b), verdict in cells.items()}
