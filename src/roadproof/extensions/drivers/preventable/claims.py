"""The claims about plates: where a formula holds on lines, and drives beside that boundary."""

from collections.abc import Mapping
from dataclasses import field
from typing import ClassVar, Literal

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim, OwnMode
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.drivers.preventable.boundary_file import BoundaryFile
from roadproof.extensions.drivers.preventable.plate import Plate
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Lines(OwnMode):
    """A claim that asks for the places at which the formula holds, on each line of a plate.

    ``readings``: options on which the motion of the model depends, where no formula describes it.
    """

    plate: Plate
    readings: Mapping[str, str] = field(default_factory=dict)

    @property
    def relies_on(self) -> tuple[str, ...]:
        """The entry of the driver model."""
        from roadproof.extensions.drivers.models import entry_of  # loads the models

        return (entry_of(self.plate.model),)

    def decide(self, claim: Claim) -> ClaimAnswer:
        """Return where on the lines of the plate the formula of a claim holds."""
        from roadproof.extensions.drivers.preventable.beside import decide_lines  # loads the models

        return decide_lines(claim, self.plate)

    def verdict_of(self, evidence: object) -> Verdict | None:
        """DERIVED where a file says so for the lines."""
        return Verdict.DERIVED if isinstance(evidence, BoundaryFile) else None


@dataclass(frozen=True)
class Beside(OwnMode):
    """A drive of the model of a plate is to be found that begins there, and shows the formula.

    The formula leaves open which numbers the initial values are. ``readings``: options on which the motion of
    the model depends. ``of``: what the drive should be of besides, the first before the others.
    """

    is_open: ClassVar[bool] = True
    plate: Plate
    side: Literal["unpreventable", "preventable"]
    readings: Mapping[str, str] = field(default_factory=dict)
    of: tuple[Formula, ...] = ()
    of_texts: tuple[str, ...] = field(default=(), compare=False)

    @property
    def relies_on(self) -> tuple[str, ...]:
        """The entry of the driver model."""
        from roadproof.extensions.drivers.models import entry_of  # loads the models

        return (entry_of(self.plate.model),)

    def decide(self, claim: Claim) -> ClaimAnswer:
        """Return a drive on the side of the boundary of the plate."""
        from roadproof.extensions.drivers.preventable.beside import decide_beside  # loads the models

        return decide_beside(claim, self)

    def verdict_of(self, evidence: object) -> Verdict | None:
        """WITNESSED by a drive."""
        return Verdict.WITNESSED if isinstance(evidence, JudgedDrive) else None

    def is_shown_by(self, claim: Claim, drive: DriveFile) -> bool:
        """Return whether it is the drive of the model from a place of the plate."""
        from roadproof.extensions.drivers.preventable.boundary import start_of  # loads the models

        return start_of(claim, self, drive) is not None
