"""Reads evidence that needs no check of its own: reasons, judgements of traces, and kinds of extensions."""

from roadproof.errors import InputError, StaleError
from roadproof.evidence.answer import JudgedTrace
from roadproof.evidence.answer_files import JudgedFile, OwnEvidence, UndecidedFile
from roadproof.evidence.claim import Claim, On
from roadproof.evidence.codec import read
from roadproof.evidence.readers.about_claim import require, require_about
from roadproof.extension import entries, import_entry


def extension_evidence_for(claim: Claim, content: object, where: str, schema: str) -> OwnEvidence:
    """Return evidence of a kind that an extension adds."""
    kind: type[OwnEvidence] = import_entry(entries("evidence")[schema])
    file = read(kind, content, where)
    require_about(claim, file, where)
    fault = file.fault_for(claim)
    require(not fault, where, fault)
    return file


def undecided_for(claim: Claim, content: object, where: str) -> UndecidedFile:
    """Return the reason in a file why a claim is undecided."""
    file = read(UndecidedFile, content, where)
    require_about(claim, file, where)
    return file


def judged_trace_for(claim: Claim, content: object, where: str) -> JudgedTrace:
    """Return the judgement of a given trace. Raises ``StaleError`` if the trace has other bytes now."""
    file = read(JudgedFile, content, where)
    mode = claim.mode
    if not isinstance(mode, On):
        raise InputError(f"{where} is no answer to its claim: it is about a given trace")
    if file.files != mode.files:
        raise StaleError(f"{where} is no answer to its claim: it is about a trace with other bytes")
    require(file.asked == mode.asked, where, "it was asked something else")
    return JudgedTrace(read(mode.judge.kind, file.shows, where))
