"""A drive file as what is put to Coq."""

from collections.abc import Callable

from roadproof.errors import RoadproofError
from roadproof.evidence.derivations.derive import derive
from roadproof.evidence.derivations.parts import NoDerivationError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.kernel.accept import CoqModule, Ruling, Word
from roadproof.evidence.kernel.derivation import Step
from roadproof.evidence.kernel.drive import Shown, claim_text, module, shown
from roadproof.evidence.kernel.source import ClaimText, Module
from roadproof.library.specification import Library


def prepare(
    name: str,
    file: DriveFile,
    library: Library,
    written: Callable[[str, Shown, ClaimText, Step], Module] = module,
) -> CoqModule:
    """The drive as ``written`` with a derivation of its claim, or why there is none."""
    try:
        what = shown(file, library)
    except RoadproofError as error:
        return CoqModule(None, refusal=Ruling(Word.REFUSED, f"it cannot be put to Coq: {error}"))
    try:
        printed = claim_text(what)
        derivation = derive(what.formula, file.drive, file.road, file.lanes, what.values)
        return CoqModule(written(name, what, printed, derivation))
    except NoDerivationError as error:
        return CoqModule(None, refusal=Ruling(Word.UNKNOWN, f"no derivation was found: {error}"))
    except RoadproofError as error:
        return CoqModule(None, refusal=Ruling(Word.UNKNOWN, f"it is not printed for Coq: {error}"))
