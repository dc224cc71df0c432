"""The list of tests that take long names tests that there are."""

from pathlib import Path

import pytest

from lengthy import LENGTHY

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("entry", LENGTHY)
def test_each_entry_is_a_test(entry: str) -> None:
    path, _, name = entry.partition("::")
    assert f"def {name.partition('[')[0]}" in (ROOT / path).read_text("utf-8")
