"""The folder of ``roadproof prove --out``: certificates, drives, and the index that names them.

A folder grows: claims that are proved later are added to it, and a claim that is asked again takes the place
of its former answer. All claims of a folder are read with the same options and specification files.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from roadproof.cli.evidence import keep_specifications
from roadproof.cli.options import write_json, write_text
from roadproof.cli.prove_answers import Answered, counterexample
from roadproof.errors import UsageError
from roadproof.files import make_folder

INDEX = "index.json"


class ProofFolder:
    """Raises ``UsageError`` where the folder holds claims that were read otherwise."""

    def __init__(self, folder: Path, options: Mapping[str, str], specs: Sequence[Path]) -> None:
        from roadproof.spec.library import load_library

        make_folder(folder)
        self.folder = folder
        self.library = load_library(specs)
        chosen = dict(self.library.select(options=options).options)
        self.entries = {_key(entry): entry for entry in self._former(chosen, specs)}
        self.files: dict[str, str] = {}
        self.head = {
            "schema": "roadproof/index/1",
            "options": chosen,
            "specs": keep_specifications(folder, specs),
        }

    def add(self, answered: Answered) -> None:
        """Write the evidence of an answer, in place of that of a former one, and then the index.

        So a run that is broken off leaves a folder that says what it holds.
        """
        file = _write_evidence(answered, self.folder)
        if file is not None:
            self.files[answered.task.name] = str(self.folder / file)
        entry = _entry(answered, file)
        former = self.entries.get(_key(entry), {}).get("evidence")
        self.entries[_key(entry)] = entry
        write_json({**self.head, "claims": list(self.entries.values())}, str(self.folder / INDEX))
        if former not in (None, file):
            (self.folder / Path(former).name).unlink(missing_ok=True)

    def _former(self, options: dict[str, str], specs: Sequence[Path]) -> list[dict[str, Any]]:
        """The entries of an index that is there already."""
        from roadproof.evidence.answers.proofs import SCHEMA
        from roadproof.evidence.answers.read import index_fields
        from roadproof.evidence.strict import LARGEST_INDEX, read_json
        from roadproof.spec.library import read_specification

        path = self.folder / INDEX
        if not path.exists():
            return []
        data = index_fields(read_json(path, LARGEST_INDEX), str(path))
        if data.text("schema") != SCHEMA:
            raise UsageError(f"{path} is of another command: name another folder with --out")
        texts = {x.name: read_specification(x).text for x in specs}
        kept = data.texts("specs") if data.has("specs") else ()
        there = {name: read_specification(self.folder / Path(name).name).text for name in kept}
        told = data.named_texts("options") if data.has("options") else {}
        if there != texts or self.library.select(options=told).options != options:
            raise UsageError(
                f"{self.folder} holds claims that were read with other options or specification files: name "
                "another folder with --out"
            )
        return data.items("claims")


def _key(entry: Mapping[str, Any]) -> tuple[str, str]:
    return " ".join(str(entry["claim"]).split()), str(entry["set"])


def _write_evidence(answered: Answered, folder: Path) -> str | None:
    """The certificate, or else the refuting drive, as a file; its name."""
    from roadproof.evidence.certificate import to_json

    name, settled = answered.task.name, answered.settled
    if settled.result.certificate is not None:
        write_text(folder / f"{name}.json", to_json(settled.result.certificate))
        return f"{name}.json"
    if settled.drive is not None:
        write_json(settled.drive.as_data(), str(folder / f"{name}-drive.json"))
        return f"{name}-drive.json"
    return None


def _entry(answered: Answered, file: str | None) -> dict[str, Any]:
    """What was asked and answered, and where the evidence is: a file beside the index, or in it."""
    task = answered.task
    entry = {
        "property": task.id,
        "part": task.part,
        "scenario": task.scenario,
        "set": task.set_name,
        "claim": task.claim,
        "verdict": str(answered.verdict),
        "evidence": file,
    }
    return entry if file is not None else {**entry, "counterexample": counterexample(answered.settled)}
