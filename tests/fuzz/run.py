"""Cases from a seed to a reader's check, until so many pairs are through; what disagrees is made smaller."""

import warnings
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis.errors import HypothesisWarning

from fuzz.case import FOUND, Disagreement, save

READERS = ("held", "truths", "drives", "claims", "search", "texts", "printed", "steps")
CHUNK = 250  # cases for one seed of the generator


@dataclass(frozen=True)
class Count:
    pairs: int
    found: tuple[Path, ...]
    notes: str


def run(reader: ModuleType, pairs: int, first_seed: int, folder: Path = FOUND, most: int = 5) -> Count:
    """``reader`` has ``cases`` to draw from, and ``check``, which returns how many pairs a case holds.

    ``notes``, where it has them, counts what came out besides. Stops after ``most`` disagreements.
    """
    name = reader.__name__.rpartition(".")[2]
    notes: Counter[str] = getattr(reader, "notes", Counter())
    notes.clear()
    warnings.simplefilter("ignore", HypothesisWarning)
    done, chunk = 0, 0
    found: dict[str, Path] = {}
    while done < pairs and len(found) < most:
        through, disagreement = _chunk(reader, first_seed * 1_000_003 + chunk, pairs - done)
        if disagreement is not None:
            found[disagreement.complaint] = save(name, disagreement, folder)
        done, chunk = done + through, chunk + 1
    return Count(done, tuple(found.values()), ", ".join(f"{n} {what}" for what, n in sorted(notes.items())))


def _chunk(reader: ModuleType, number: int, most: int) -> tuple[int, Disagreement | None]:
    """Pairs that went through for one seed of the generator, and the smallest disagreement."""
    through, failed = 0, False

    @seed(number)
    @settings(
        max_examples=getattr(reader, "CHUNK", CHUNK),
        deadline=None,
        database=None,
        phases=[Phase.generate, Phase.shrink] if getattr(reader, "SHRINKS", True) else [Phase.generate],
        suppress_health_check=list(HealthCheck),
        print_blob=False,
        report_multiple_bugs=False,
    )
    @given(reader.cases)
    def one(case: object) -> None:
        nonlocal through, failed
        if through >= most and not failed:
            return
        try:
            checked = reader.check(case)
        except Disagreement:
            failed = True
            raise
        through += 0 if failed else checked

    try:
        one()
    except Disagreement as disagreement:
        return through, disagreement
    return through, None
