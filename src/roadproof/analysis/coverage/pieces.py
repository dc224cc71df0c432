"""What a survey is asked in, piece by piece, and what is known of each."""

from dataclasses import dataclass
from typing import TypeAlias

from roadproof.analysis.basis import ProofResult
from roadproof.analysis.coverage.answers import Answers
from roadproof.analysis.coverage.found import FoundGap
from roadproof.analysis.coverage.needed import Need
from roadproof.library.specification import Query


@dataclass(frozen=True)
class CoverageClaim:
    number: int
    query: Query


@dataclass(frozen=True)
class NeededDefinition:
    name: str


@dataclass(frozen=True)
class Chunk:
    """Some of the simple drives, on one of the survey's roads."""

    road: int
    number: int


@dataclass(frozen=True)
class Component:
    """A group of classes by name, with gaps to begin with; ``lost``: why there may be too few of these."""

    name: str
    known: tuple[FoundGap, ...]
    lost: tuple[str, ...] = ()


@dataclass(frozen=True)
class GapScan:
    """The gaps in some of the simple drives; ``lost``: why it was not looked through."""

    found: tuple[FoundGap, ...]
    lost: str = ""


Piece: TypeAlias = CoverageClaim | NeededDefinition | Chunk | Component
Kept: TypeAlias = ProofResult[Query] | Need | GapScan | Answers


def name_of(piece: Piece) -> str:
    """Under which name the answer to a piece is known."""
    match piece:
        case CoverageClaim(number):
            return f"covered-{number}"
        case NeededDefinition(name):
            return f"needed-{name}"
        case Chunk(road, number):
            return f"simple-{road}-{number}"
        case Component(name):
            return name
