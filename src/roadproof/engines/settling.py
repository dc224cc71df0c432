"""Claims to answers: each kind of claim has its engine."""

from collections.abc import Iterator, Sequence

from roadproof.evidence.answer import Answer
from roadproof.evidence.claim import Claim, Exists
from roadproof.runtime.budget import Work


def settle_batch(claims: Sequence[Claim], work: Work) -> Iterator[Answer]:
    """Yield the answer to each claim in turn; answers to earlier ones help with later ones."""
    from roadproof.engines.search.existing import settle_existing  # here: known answers need no solver

    for claim in claims:
        if not isinstance(claim.mode, Exists):
            raise NotImplementedError(type(claim.mode).__name__)
    yield from settle_existing(claims, work)
