"""The index of a folder of settled claims, which grows: former claims stay, unless they are asked again.

Claims of earlier versions, of which no answers are kept, are in the index alone. They stay there too, and are
asked again when somebody asks.
"""

from collections.abc import Mapping
from pathlib import Path

from roadproof.analysis.claims import Claims
from roadproof.analysis.study.evidence_store import INDEX, write_index
from roadproof.engines.prove.properties import name_of_claim
from roadproof.errors import UsageError
from roadproof.evidence.answers.proofs import SCHEMA, Claim, Index, Record
from roadproof.evidence.answers.read import index_fields
from roadproof.evidence.codec import read, write
from roadproof.evidence.heading import library_of
from roadproof.evidence.strict import LARGEST_INDEX, Fields, read_json
from roadproof.library.specification import read_specification

Entries = dict[str, Claim]


def former_claims(folder: Path, claims: Claims) -> Entries:
    """The entries of an index that is there already, by name.

    Raises ``UsageError`` where it is of another command, or its claims were read otherwise.
    """
    path = folder / INDEX
    if not path.exists():
        return {}
    data = index_fields(read_json(path, LARGEST_INDEX), str(path))
    if data.text("schema") != SCHEMA:
        raise UsageError(f"{path} is of another command: name another folder with --out")
    if not _read_alike(data, folder, claims):
        raise UsageError(
            f"{folder} holds claims that were read with other options or specification files, or under "
            "another library: name another folder with --out"
        )
    known = read(Index, data.content, data.where).claims
    return {name_of_claim(x.claim, x.set, x.assuming): x for x in known}


def _read_alike(data: Fields, folder: Path, claims: Claims) -> bool:
    library, options = claims.library, claims.question.said["options"]
    texts = {Path(x.name).name: x.text for x in library.files}
    kept = data.texts("specs") if data.has("specs") else ()
    there = {name: read_specification(folder / Path(name).name).text for name in kept}
    told = data.named_texts("options") if data.has("options") else {}
    same = library_of(data) in (None, library.fingerprint)
    return same and there == texts and dict(library.select(options=told).options) == options


def write_claims(folder: Path, claims: Claims, records: Mapping[str, Record]) -> None:
    """Write the index: former entries, each with its new answer if there is one, and then what is new.

    A file that only a former answer needed is removed.
    """
    former = former_claims(folder, claims)
    new = [name for name in claims.named if name in records]
    new += sorted(name for name in records if name not in claims.named)
    entries: Entries = {**former, **{name: records[name].claim for name in new}}
    write_index(folder, write(Index(**claims.question.heading, claims=tuple(entries.values()))))
    for name in _files(former) - _files(entries):
        (folder / name).unlink(missing_ok=True)


def _files(entries: Entries) -> set[str]:
    return {Path(x.evidence).name for x in entries.values() if x.evidence}
