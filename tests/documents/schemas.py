"""The JSON Schemas that follow from definitions; ``make generated`` writes them into docs/schema."""

import json
from collections.abc import Iterator, Mapping
from typing import get_args

from documents.json_schema import COMMON, DRAFT, schema_of, shared_schemas, tagged_schema
from roadproof.evidence.answer_files import JudgedFile, RefutationFile, UndecidedFile
from roadproof.evidence.answers import (
    certificate,
    drive,
    extensions,
    headings,
    library,
    none_within,
    shared,
    show,
    tree,
)
from roadproof.evidence.codec import bare, fields_of, notes_of
from roadproof.evidence.schema_notes import SharedType
from roadproof.evidence.strict import JsonObject
from roadproof.extension import extension_error, import_entry, list_entries, owner_of
from roadproof.frontends.api import check_data
from roadproof.library.assumption import INDUCTIONS
from roadproof.questions.compare import ComparisonData
from roadproof.questions.data import QuestionFile
from roadproof.questions.order.data import OrderData
from roadproof.questions.overlap_data import OverlapData
from roadproof.questions.prove_data import ClaimsData
from roadproof.questions.witness_data import WitnessData

CORE: Mapping[type, str] = {
    ClaimsData: "roadproof prove --json: claims, proved or refuted",
    ComparisonData: "roadproof compare --json: which of two formulas implies the other",
    extensions.ExtensionsData: "roadproof extensions --json: what is installed beyond the core",
    library.LibraryData: "roadproof list --json: what the library holds",
    show.ShowData: "roadproof show --format json: a scenario, a definition or a formula",
    check_data.CheckData: "roadproof check --json: what evidence shows",
    WitnessData: "roadproof witness --json: drives for scenarios and formulas",
    OrderData: "roadproof order --json: which scenarios imply which",
    OverlapData: "roadproof overlap --json: which scenarios hold together",
    QuestionFile: "question.json: a question, from which its claims are listed",
    UndecidedFile: "NAME.json in a folder of answers: why a claim is undecided",
    JudgedFile: "NAME.json in a folder of answers: what a given trace shows",
    RefutationFile: "NAME.json in a folder of answers: a trace on which a claim is false",
}
WITHOUT_ASSUMPTION: JsonObject = {
    "dependentRequired": {"assuming": ["axioms"], "unused": ["assuming"]},
    "if": {"not": {"required": ["assuming"]}},
    "then": {
        "properties": {
            "axioms": {"minItems": 1, "items": {"properties": {"schema": {"enum": [*INDUCTIONS]}}}}
        }
    },
}
"""Only inductions may stand in a certificate that assumes nothing."""
DRIVES = (drive.DriveData, drive.JerkDriveData)


def shared_types() -> JsonObject:
    """The types that several answers share, by their name among the definitions of common.json."""
    kinds = [x for module in (shared, headings, drive, tree) for x in vars(module).values()]
    kinds += (y for x in fields_of(headings.AnswerHeading) for y in (x.type, *get_args(bare(x.type))))
    return {note.name: x for x in kinds for note in notes_of(x) if isinstance(note, SharedType)}


def titles() -> Mapping[type, str]:
    """Return the title of each schema by its definition. Raises ``InputError`` where two have one file."""
    titled = dict(CORE)
    for entry in list_entries("schemas"):
        described = {_file_of(kind) for kind in titled}
        for kind, title in import_entry(entry).items():
            if _file_of(kind) in described:
                raise extension_error(owner_of(entry), f"{_file_of(kind)} of {entry} is described already")
            titled[kind] = title
    return titled


def _file_of(kind: type) -> str:
    """Return the name of the schema file of a definition."""
    [schema] = get_args(next(x.type for x in fields_of(kind) if x.name == "schema"))
    return file_of(schema)


def schemas() -> Iterator[tuple[str, JsonObject]]:
    """The name and the content of each schema."""
    for kind, title in titles().items():
        name = _file_of(kind)
        yield name, schema_of(kind, name, title)
    title = "A proof for all time that a second program can check"
    made = schema_of(certificate.CertificateData, "certificate.json", title)
    yield "certificate.json", {**made, **WITHOUT_ASSUMPTION}
    title = "A judged drive, with all that is needed to judge it again"
    yield "drive.json", tagged_schema(DRIVES, "drive.json", title)
    title = "That no drive within limits satisfies a formula, with trees that a second program can check"
    made = schema_of(none_within.NoneWithinData, "none-within.json", title)
    yield "none-within.json", made
    title, those = "What several kinds of answers share", shared_schemas(shared_types())
    yield COMMON, {"$schema": DRAFT, "$id": COMMON, "title": title, "$defs": those}


def file_of(schema: str) -> str:
    """The file of the schema of an answer, by what the answer calls it."""
    return f"{schema.split('/')[1]}.json"


def as_text(content: JsonObject) -> str:
    """A schema as its file has it."""
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
