"""``python -m roadproof.frontends.schemas FOLDER``: write the JSON Schemas that follow from definitions."""

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import get_args

from roadproof.evidence.answer_files import JudgedFile, RefutationFile, Undecided
from roadproof.evidence.answers import certificate, check, drive, library, none_within, shared, show, tree
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
from roadproof.extensions.assurance.answers import assurance, bundle, trace, trace_changes, trace_lock
from roadproof.extensions.catalogue import kept as catalogue_index
from roadproof.extensions.drivers.preventable.data import PreventableData
from roadproof.extensions.drivers.preventable.plate import BoundaryFile
from roadproof.extensions.maps import answer as road_map
from roadproof.extensions.surveys.classify.data import ClassesData
from roadproof.extensions.surveys.coverage import kept as coverage
from roadproof.extensions.surveys.explore.data import ExploreData
from roadproof.extensions.surveys.redundancy import RedundancyData
from roadproof.extensions.surveys.survey import SurveyData
from roadproof.extensions.traffic.answers import monitor, traffic
from roadproof.library.motion import INDUCTIONS
from roadproof.questions import overlap as overlap_question
from roadproof.questions.compare import ComparisonData
from roadproof.questions.data import QuestionFile
from roadproof.questions.order.data import OrderData
from roadproof.questions.overlap import OverlapData
from roadproof.questions.prove import ClaimsData
from roadproof.questions.witness import WitnessData

TITLES: Mapping[type, str] = {
    ClaimsData: "roadproof prove --json: claims, proved or refuted",
    ComparisonData: "roadproof compare --json: which of two formulas implies the other",
    library.Answer: "roadproof list --json: what the library holds",
    show.Answer: "roadproof show --format json: a scenario, a definition or a formula",
    check.Answer: "roadproof check --json: what evidence shows",
    assurance.Answer: "roadproof assurance --json: an argument in GSN, and which of its parts hold",
    monitor.Answer: "roadproof monitor --json: where a formula holds on one trace",
    traffic.Answer: (
        "results.json of roadproof evaluate, and its --json: dangers in recordings, and what matches them"
    ),
    catalogue_index.Index: ("roadproof catalogue --json: what tests show and mean, and what nobody tests"),
    ClassesData: "roadproof classify --json: classes that exclude each other",
    coverage.CoverageData: "roadproof coverage --json: which disturbances a set misses",
    SurveyData: "the surveys of contributors, --json: which of some formulas can hold on a drive",
    WitnessData: "roadproof witness --json: drives for scenarios and formulas",
    ExploreData: "roadproof explore --json: for which values there is a drive",
    OrderData: "roadproof order --json: which scenarios imply which",
    OverlapData: "roadproof overlap --json: which scenarios hold together",
    QuestionFile: "question.json: a question, from which its claims are listed",
    Undecided: "NAME.json in a folder of answers: why a claim is undecided",
    JudgedFile: "NAME.json in a folder of answers: what a given trace shows",
    RefutationFile: "NAME.json in a folder of answers: a trace on which a claim is false",
    PreventableData: (
        "roadproof preventable --json: from which initial values a driver prevents a collision"
    ),
    BoundaryFile: "NAME.json in a folder of answers: where on the lines of a plate a formula holds",
    bundle.Manifest: "manifest.json of roadproof bundle: what is in it, and what checks it",
    road_map.Answer: "roadproof road --json: the roads of a map",
    trace.Answer: "roadproof trace --json: which requirements are shown",
    trace_changes.Changes: "roadproof trace --baseline --json: what changed between two states",
    trace_lock.Lock: "requirements.lock.json: what every link of a trace rested on when it was accepted",
    RedundancyData: ("roadproof redundancy --json: which parts could be left out"),
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


def schemas() -> Iterator[tuple[str, JsonObject]]:
    """The name and the content of each schema."""
    for kind, title in TITLES.items():
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
