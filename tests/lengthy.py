"""Tests that take long: ``make test`` leaves them to ``make long``, and CI runs both.

A test is in lengthy.txt when it takes more than about five seconds of an idle core, and a quicker one beside
it asks the same of less: what it adds is breadth. Entries are beginnings of node ids.
"""

from pathlib import Path

import pytest

COLLECTED = pytest.StashKey[list[pytest.Item]]()
"""All tests that were found, before any is left out."""

LENGTHY = tuple(Path(__file__).with_suffix(".txt").read_text("utf-8").splitlines())
