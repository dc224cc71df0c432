"""Tables of test cases in TOML files beside the tests."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any


def read_table(test_file: str, name: str) -> Any:
    """A table in ``test_x.toml`` beside ``test_x.py``, a list or a dictionary; rows are tuples."""
    rows = _read(Path(test_file).with_suffix(".toml"))[name]
    return dict(rows) if isinstance(rows, dict) else list(rows)


@cache
def _read(path: Path) -> dict[str, Any]:
    tables: dict[str, Any] = _with_tuples(tomllib.loads(path.read_text("utf-8")))
    return tables


def _with_tuples(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _with_tuples(each) for key, each in value.items()}
    return tuple(map(_with_tuples, value)) if isinstance(value, list) else value
