"""A ``catalogue.toml`` for drives that complete a catalogue."""

import json
from collections.abc import Mapping


def catalogue_text(targets: Mapping[str, str]) -> str:
    """An entry for the drive of each target, NAME.json, by name, with its words as the title."""
    entries = [
        f"[[test]]\nid = {_quoted(name)}\ntitle = {_quoted(words)}\nfile = {_quoted(f'{name}.json')}\n"
        f"claims = [{_quoted(name)}]\n"
        for name, words in targets.items()
    ]
    return "\n".join(entries)


def _quoted(text: str) -> str:
    """A basic string of TOML, which is one of JSON."""
    return json.dumps(text, ensure_ascii=False)
