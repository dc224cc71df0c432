"""``python -m roadproof.evidence.schemas FOLDER``: write the JSON Schemas that follow from definitions."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from roadproof.evidence.answers import order, overlap, redundancy, shared
from roadproof.evidence.codec import notes_of
from roadproof.evidence.json_schema import COMMON, Shared, schema_of, shared_schemas

ANSWERS = {
    order: "roadproof order --json, and index.json of its folder: which scenarios imply which",
    overlap: "roadproof overlap --json, and index.json of its folder: which scenarios hold together",
    redundancy: "roadproof redundancy --json, and index.json of its folder: which parts could be left out",
}


def shared_types() -> dict[str, Any]:
    """The types that several answers share, by their name among the definitions of common.json."""
    kinds = (x for module in (shared, overlap) for x in vars(module).values())
    return {
        note.name: x for x in kinds for note in notes_of(x) if isinstance(note, Shared) and not note.by_hand
    }


def schemas(common: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """The name and the content of each schema; ``common``: that of shared types, as it stands."""
    for answer, title in ANSWERS.items():
        name = f"{title.split()[1]}.json"
        yield name, schema_of(answer.Index, answer.Record, name, title)
    definitions = {**common["$defs"], **shared_schemas(shared_types())}
    yield COMMON, {**common, "$defs": definitions}


def main(folder: Path) -> None:
    common = json.loads((folder / COMMON).read_text("utf-8"))
    for name, content in schemas(common):
        (folder / name).write_text(as_text(content), "utf-8")


def as_text(content: dict[str, Any]) -> str:
    """A schema as its file has it."""
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
