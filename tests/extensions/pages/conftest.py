"""A browser for tests of pages."""

from collections.abc import Iterator
from typing import Any

import pytest

from extensions.pages.studio.browser import browsing


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """A real browser, for tests that are skipped where there is none."""
    with browsing() as made:
        yield made
