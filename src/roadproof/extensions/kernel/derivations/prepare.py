"""A drive file as what is put to Coq."""

from collections.abc import Callable

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.kernels import Ruling, Word
from roadproof.evidence.refutation import numbered
from roadproof.extensions.kernel.accept import CoqModule, without_question, without_text
from roadproof.extensions.kernel.derivation import Step
from roadproof.extensions.kernel.derivations.derive import derive, derive_on
from roadproof.extensions.kernel.derivations.parts import NoDerivationError
from roadproof.extensions.kernel.derivations.traces import TraceShapes
from roadproof.extensions.kernel.drive import Shown, claim_text, module, shown
from roadproof.extensions.kernel.source import ClaimText, Module
from roadproof.extensions.kernel.trace import Refutation, Refuted, refuted, trace_claim, trace_module
from roadproof.library.specification import Library
from roadproof.logic import formula as f
from roadproof.logic.rewrite import with_values
from roadproof.reasons import Why


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
        return without_question(error)
    try:
        printed = claim_text(what)
        derivation = derive(what.formula, file.drive, what.world.road, file.lanes, what.values)
        return CoqModule(written(name, what, printed, derivation))
    except NoDerivationError as error:
        return CoqModule(None, refusal=Ruling(Word.UNKNOWN, Why.NO_DERIVATION(error)))
    except RoadproofError as error:
        return without_text(error)


def prepare_trace(
    name: str,
    asked: Refutation,
    library: Library,
    written: Callable[[str, Refuted, ClaimText, Step], Module] = trace_module,
) -> CoqModule:
    """A trace as ``written`` with a derivation that a claim is false on it, or why there is none."""
    try:
        what = refuted(asked, library)
    except RoadproofError as error:
        return without_question(error)
    world = what.world
    try:
        printed = trace_claim(what)
        formula = with_values(numbered(what.formula, what.trace), world.values)
        derivation = derive_on(TraceShapes(world.values, what), f.Not(formula), world.road, world.lanes)
        return CoqModule(written(name, what, printed, derivation))
    except NoDerivationError as error:
        return CoqModule(None, refusal=Ruling(Word.UNKNOWN, Why.NO_DERIVATION(error)))
    except RoadproofError as error:
        return without_text(error)
