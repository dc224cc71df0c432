"""Certificates of claims proved for all time: files that a second program can check.

A certificate names the claim, the set, the options and assumptions, the instances and lemmas, and holds the
ground queries as SMT-LIB. The checker reads the claim again with its own library and rebuilds the premises
about motion. It derives every query from the instances, compares it with the file and gives it to a solver.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from roadproof.evidence.atoms import Reading
    from roadproof.evidence.sites import Site, StateLemma
    from roadproof.library.assumption import Assumption
    from roadproof.library.specification import Query


@dataclass(frozen=True)
class Certificate:
    """A proof as data; ``queries`` are pairs of a title and an SMT-LIB script that must be unsatisfiable.

    ``pinned``: parameter values that the claim's own premise demands (``minDanger = 0.6 s``), substituted
    before queries are derived (``logic.forced_values``). ``reading``: the parts of the claim that count as
    predicates (``atoms.Atoms``). ``tableau``: the same proof for Coq (``kernel.tableau``) as lines, or None;
    equality ignores it, since it can be recomputed. ``query``: the proved claim, for the search of a tableau
    only; None for a certificate from a file.
    """

    property: str
    scenario: int | None
    claim: str
    set_name: str
    options: Mapping[str, str]
    assumptions: tuple[str, ...]
    instances: Mapping[Site, tuple[str, ...]]
    names: Mapping[Site, str]
    lemmas: tuple[StateLemma, ...]
    queries: tuple[tuple[str, str], ...]
    assumed: Assumption
    pinned: tuple[str, ...] = ()
    reading: Reading = "states"
    tableau: tuple[str, ...] | None = field(default=None, compare=False)
    query: Query | None = field(default=None, compare=False, repr=False)
