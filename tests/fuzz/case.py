"""Cases as plain data: kept in files that can be read, and read back from them."""

from collections.abc import Mapping
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any

from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.semantics.exact.truth import Cut, TruthSet
from roadproof.world.drive import Drive, Motion, Piece

FOUND = Path(__file__).parent / "found"

NAMES: Mapping[str, Any] = {
    **{x.__name__: x for module in (syntax, f, t) for x in vars(module).values() if isinstance(x, type)},
    **{x.__name__: x for x in (Cut, TruthSet, Drive, Motion, Piece, Fraction)},
}
"""What the ``repr`` of a case is made of."""


class Disagreement(Exception):
    """Two readers of one case say different things. ``case``: the smallest part of it that shows it."""

    def __init__(self, complaint: str, case: Any) -> None:
        super().__init__(complaint)
        self.complaint = complaint
        self.case = case


def save(reader: str, found: Disagreement, folder: Path = FOUND) -> Path:
    """Write a case: who disagreed as a comment, the name of the reader, and the case."""
    shown = repr(found.case)
    path = folder / f"{reader}-{sha256(shown.encode()).hexdigest()[:8]}.txt"
    folder.mkdir(exist_ok=True)
    complaint = " ".join(found.complaint.split())
    path.write_text(f"# {complaint}\n{reader}\n{shown}\n", "utf-8")
    return path


def load(path: Path) -> tuple[str, Any]:
    """(reader, case) of a file that ``save`` has written."""
    _, reader, shown = path.read_text("utf-8").split("\n", 2)
    return reader, eval(shown, {"__builtins__": {}, "frozenset": frozenset}, dict(NAMES))
