"""The files of answers: an answer as JSON, and a file read as the answer to a claim.

A file counts as the answer to a claim only if it is about that claim; formulas are compared as trees. Drives
and traces are judged again as they are read. The writer and the reader of a kind of evidence are imported for
its first file.
"""

from collections.abc import Callable
from functools import partial
from typing import TypeAlias, cast

from roadproof.core_record import READERS, REFUTATION
from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answer import ClaimAnswer, Evidence, JudgedTrace, RefutingTrace, assumed_by
from roadproof.evidence.answer_files import JudgedFile, OwnEvidence, RefutationFile, UndecidedFile
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim, On
from roadproof.evidence.codec import write
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.strict import Fields, JsonObject
from roadproof.extension import entries, import_entry

Reader: TypeAlias = Callable[[Claim, object, str], Evidence]


def answer_data(answer: ClaimAnswer) -> JsonObject:
    """Return the JSON file of an answer."""
    claim = answer.claim
    match answer.evidence:
        case JudgedDrive() as drive:
            return drive.as_data()
        case UndecidedFile() | OwnEvidence() as own:
            return write(own)
        case JudgedTrace(shows):
            mode = claim.mode
            assert isinstance(mode, On)
            return write(JudgedFile(files=mode.files, asked=mode.asked, shows=write(shows)))
        case Certificate() as proof:
            from roadproof.evidence.certificate_file import certificate_data

            return certificate_data(proof)
        case NoneWithinFile() as trees:
            from roadproof.evidence.none_within_file import none_within_data

            return none_within_data(trees)
        case RefutingTrace(trace, drive_sought):
            from roadproof.evidence.countermodel import trace_data

            file = RefutationFile(
                set=claim.home.set_name,
                options=dict(claim.home.options),
                claim=claim.query.text,
                assuming=assumed_by(claim),
                drive_sought=drive_sought,
                trace=trace_data(trace),
            )
            return write(file)


def read_answer(claim: Claim, content: object, where: str, is_judged: bool = False) -> ClaimAnswer:
    """Read the file of an answer to a claim, and judge its drive or trace again.

    For a certificate only the claim and the queries are compared; ``check_certificate`` checks the proof.

    Args:
        content: the parsed JSON.
        where: the path, for messages.
        is_judged: whether this program has judged the trace in these very bytes for this claim before.

    Raises:
        InputError: the file is about another claim, or shows nothing.
        StaleError: the judged trace has other bytes now.
    """
    schema = Fields(content, where).text("schema")
    try:
        reader = _reader(schema, where, is_judged)
        return ClaimAnswer(claim, reader(claim, content, where))
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
    except InputError:
        raise
    except RoadproofError as error:
        raise InputError(f"{where}: {error}") from None


def is_answer(schema: str) -> bool:
    """Return whether files of a schema are answers."""
    return schema in READERS or schema in entries("evidence")


def _reader(schema: str, where: str, is_judged: bool) -> Reader:
    if is_judged and schema == REFUTATION:
        return cast(Reader, import_entry("roadproof.evidence.readers.refutation:unjudged_trace_for"))
    if schema in READERS:
        return cast(Reader, import_entry(READERS[schema]))
    own = entries("evidence")
    if schema not in own:
        raise InputError(f"{where}: schema='{schema[:60]}' is none of {', '.join((*READERS, *own))}")
    from roadproof.evidence.readers.plain import extension_evidence_for

    return partial(extension_evidence_for, schema=schema)
