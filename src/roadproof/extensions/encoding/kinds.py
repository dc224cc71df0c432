"""The drives that solve an encoded problem, and the formats of its files."""

from typing import Literal, TypeAlias

Drives: TypeAlias = Literal["natural", "all", "outer"]
"""``natural``: those that a search tries first; ``all``: those within the limits; ``outer``: a relaxation."""
DRIVES: tuple[Drives, ...] = ("natural", "all", "outer")
Target: TypeAlias = Literal["mps", "lp", "smt2"]
"""The formats of files with a problem."""
TARGETS: tuple[Target, ...] = ("mps", "lp", "smt2")
