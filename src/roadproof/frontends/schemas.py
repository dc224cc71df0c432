"""``python -m roadproof.frontends.schemas FOLDER``: write the JSON Schemas that follow from definitions."""

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import get_args

from roadproof.evidence.answer_files import JudgedFile, RefutationFile, Undecided
from roadproof.evidence.answers import (
    certificate,
    drive,
    extensions,
    library,
    none_within,
    shared,
    show,
    tree,
)
from roadproof.evidence.codec import fields_of, notes_of
from roadproof.evidence.json_schema import (
    COMMON,
    DRAFT,
    Shared,
    schema_of,
    shared_schemas,
    tagged_schema,
)
from roadproof.evidence.strict import JsonObject
from roadproof.extension import imported, listed
from roadproof.frontends.api import check_data
from roadproof.library.motion import INDUCTIONS
from roadproof.questions import overlap as overlap_question
from roadproof.questions.compare import ComparisonData
from roadproof.questions.data import QuestionFile
from roadproof.questions.order.data import OrderData
from roadproof.questions.overlap import OverlapData
from roadproof.questions.prove import ClaimsData
from roadproof.questions.witness import WitnessData

CORE: Mapping[type, str] = {
    ClaimsData: "roadproof prove --json: claims, proved or refuted",
    ComparisonData: "roadproof compare --json: which of two formulas implies the other",
    extensions.Answer: "roadproof extensions --json: what is installed beyond the core",
    library.Answer: "roadproof list --json: what the library holds",
    show.Answer: "roadproof show --format json: a scenario, a definition or a formula",
    check_data.Answer: "roadproof check --json: what evidence shows",
    WitnessData: "roadproof witness --json: drives for scenarios and formulas",
    OrderData: "roadproof order --json: which scenarios imply which",
    OverlapData: "roadproof overlap --json: which scenarios hold together",
    QuestionFile: "question.json: a question, from which its claims are listed",
    Undecided: "NAME.json in a folder of answers: why a claim is undecided",
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
DRIVES = (drive.Drive, drive.JerkDrive)


def shared_types() -> JsonObject:
    """The types that several answers share, by their name among the definitions of common.json."""
    kinds = (x for module in (shared, overlap_question, drive, tree) for x in vars(module).values())
    return {note.name: x for x in kinds for note in notes_of(x) if isinstance(note, Shared)}


def titles() -> Mapping[type, str]:
    """What each schema is called, by the definition that it follows from."""
    return {**CORE, **{kind: title for x in listed("schemas") for kind, title in imported(x).items()}}


def schemas() -> Iterator[tuple[str, JsonObject]]:
    """The name and the content of each schema."""
    for kind, title in titles().items():
        [schema] = get_args(next(x.type for x in fields_of(kind) if x.name == "schema"))
        name = file_of(schema)
        yield name, schema_of(kind, name, title)
    title = "A proof for all time that a second program can check"
    made = schema_of(certificate.Certificate, "certificate.json", title)
    yield "certificate.json", {**made, **WITHOUT_ASSUMPTION}
    title = "A judged drive, with all that is needed to judge it again"
    yield "drive.json", tagged_schema(DRIVES, "drive.json", title)
    title = "That no drive within limits satisfies a formula, with trees that a second program can check"
    made = schema_of(none_within.NoneWithin, "none-within.json", title)
    yield "none-within.json", made
    title, those = "What several kinds of answers share", shared_schemas(shared_types())
    yield COMMON, {"$schema": DRAFT, "$id": COMMON, "title": title, "$defs": those}


def file_of(schema: str) -> str:
    """The file of the schema of an answer, by what the answer calls it."""
    return f"{schema.split('/')[1]}.json"


def main(folder: Path) -> None:
    for name, content in schemas():
        (folder / name).write_text(as_text(content), "utf-8")


def as_text(content: JsonObject) -> str:
    """A schema as its file has it."""
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
