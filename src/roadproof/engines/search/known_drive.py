"""A drive that is known, judged for many formulas: parts that they share are judged once."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from roadproof.engines.search.placing import judged_as, placed
from roadproof.evidence.answer import assumed_by, sought_by
from roadproof.evidence.claim import Claim
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind, values_with
from roadproof.library.compose import negation
from roadproof.library.motion import under_limits
from roadproof.library.specification import Query
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.exact import LazyJudge


@dataclass(frozen=True)
class KnownDrive:
    """A judged drive and its judge, who remembers."""

    judged: JudgedDrive

    @cached_property
    def _judge(self) -> LazyJudge:
        return LazyJudge.on(self.judged.file.drive)

    def moves_as(self, other: JudgedDrive) -> bool:
        """Return whether another drive has these motions on this road, with these lanes and values."""
        mine, theirs = self.judged.file, other.file
        return (mine.drive, mine.road, mine.lanes, mine.values) == (
            theirs.drive,
            theirs.road,
            theirs.lanes,
            theirs.values,
        )

    def refutes(self, claim: Claim) -> bool:
        """Return whether a claim about all traces is false on the drive where it is."""
        file = self.judged.file
        if not ({*claim.vehicles} <= {*file.drive.vehicles} and {*claim.lanes} <= {*file.lanes}):
            return False
        return self._holds(sought_by(claim), claim)

    def _holds(self, formula: Formula, claim: Claim) -> bool:
        file = self.judged.file
        values = values_with(claim.home.library, file.values)
        return self._judge.holds(bind(formula, file.road, file.lanes, values))

    def refutation(self, claim: Claim) -> JudgedDrive | None:
        """Return the drive as one on which a claim is false; None where the judge rejects that."""
        return judged_as(self.judged.file, against(claim), claim.home.library)

    def elsewhere(self, query: Query, claim: Claim) -> JudgedDrive | None:
        """Return the drive on a road on which it shows ``query``; None where none is found."""
        return placed(self.judged.file, query, claim.home.library, judge=self._judge)


def against(claim: Claim) -> Query:
    """Return that a claim is false within the limits that it assumes."""
    return negation(under_limits(claim.home, claim.query, assumed_by(claim)))


def first_refuting(claim: Claim, drives: Iterable[KnownDrive]) -> JudgedDrive | None:
    """Return the first drive on which a claim is false, as evidence of that."""
    refuting = (x.refutation(claim) for x in drives if x.refutes(claim))
    return next((x for x in refuting if x is not None), None)
