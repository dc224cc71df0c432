"""Reads and judges the drive that decides a claim."""

from roadproof.evidence.answer import deciding_formula
from roadproof.evidence.claim import Claim, Exists, OwnMode
from roadproof.evidence.drive_file import DriveFile, natural_of, read_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.readers.about_claim import require, require_options, require_values, shortened


def drive_for(claim: Claim, content: object, where: str) -> JudgedDrive:
    """Return the drive of a file, judged. Raises ``InputError`` if it is about another claim."""
    file = read_drive(content, where)
    require_options(claim, file.set_name, file.options, where)
    require(_is_about(claim, file), where, f"its drive is one of {shortened(file.formula)}")
    require_values(claim, file.values, where)
    if isinstance(claim.mode, Exists):
        mode, overlaps = claim.mode, file.overlaps_allowed
        require(file.drive not in mode.unlike, where, "it is a drive from which it has to differ")
        require(
            mode.apart is None or mode.collisions or not overlaps, where, "boxes may overlap on its drive"
        )
        message = f"its horizon={file.horizon} s ends before {mode.apart} s"
        require(mode.apart is None or file.horizon >= mode.apart, where, message)
        require(
            mode.like is None or _has_prescribed_motion(mode, file),
            where,
            "it is not the drive that is given",
        )
    return JudgedDrive(file, claim.home.library, natural_of(content, where))


def _has_prescribed_motion(mode: Exists, file: DriveFile) -> bool:
    """Return whether a drive has the motions that the claim prescribes, on its road and in its lanes."""
    prescribed = mode.like, mode.road, dict(mode.lanes), mode.horizon, mode.collisions
    return prescribed == (file.drive, file.road, dict(file.lanes), file.horizon, file.overlaps_allowed)


def _is_about(claim: Claim, file: DriveFile) -> bool:
    """Return whether a drive file is about a claim."""
    if isinstance(claim.mode, OwnMode):
        return claim.mode.is_shown_by(claim, file)
    return claim.read(file.formula) == deciding_formula(claim)
