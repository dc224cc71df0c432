"""Drive files and traces as Coq modules with derivations."""

from collections.abc import Callable

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.kernels import KernelRuling, KernelVerdict
from roadproof.evidence.refutation import with_trace_values
from roadproof.extensions.kernel.accept import CoqModule, refused_module, unprintable_module
from roadproof.extensions.kernel.derivation import DerivationStep
from roadproof.extensions.kernel.derivations.derive import derive, derive_on
from roadproof.extensions.kernel.derivations.parts import NoDerivationError
from roadproof.extensions.kernel.derivations.traces import TraceShapes
from roadproof.extensions.kernel.drive import DriveStatement, drive_claim_text, drive_module, drive_statement
from roadproof.extensions.kernel.source import ClaimText, Module
from roadproof.extensions.kernel.trace import (
    TraceQuestion,
    TraceStatement,
    trace_claim_text,
    trace_module,
    trace_statement,
)
from roadproof.library.specification import Library
from roadproof.logic import formula as f
from roadproof.logic.rewrite import with_values
from roadproof.reasons import ReasonKind


def prepare(
    name: str,
    file: DriveFile,
    library: Library,
    print_module: Callable[[str, DriveStatement, ClaimText, DerivationStep], Module] = drive_module,
) -> CoqModule:
    """Return the module of a drive with a derivation of its claim, or the reason why there is none."""
    try:
        statement = drive_statement(file, library)
    except RoadproofError as error:
        return refused_module(error)
    try:
        printed = drive_claim_text(statement)
        derivation = derive(statement.formula, file.drive, statement.world.road, file.lanes, statement.values)
        return CoqModule(print_module(name, statement, printed, derivation))
    except NoDerivationError as error:
        return CoqModule(None, refusal=KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.NO_DERIVATION(error)))
    except RoadproofError as error:
        return unprintable_module(error)


def prepare_trace(
    name: str,
    question: TraceQuestion,
    library: Library,
    print_module: Callable[[str, TraceStatement, ClaimText, DerivationStep], Module] = trace_module,
) -> CoqModule:
    """Return the module of a trace with a derivation that a claim is false on it, or the reason why not."""
    try:
        statement = trace_statement(question, library)
    except RoadproofError as error:
        return refused_module(error)
    world = statement.world
    try:
        printed = trace_claim_text(statement)
        formula = with_values(with_trace_values(statement.formula, statement.trace), world.values)
        derivation = derive_on(TraceShapes(world.values, statement), f.Not(formula), world.road, world.lanes)
        return CoqModule(print_module(name, statement, printed, derivation))
    except NoDerivationError as error:
        return CoqModule(None, refusal=KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.NO_DERIVATION(error)))
    except RoadproofError as error:
        return unprintable_module(error)
