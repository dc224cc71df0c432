"""A tab of a browser that shows the studio."""

from collections.abc import Iterator
from typing import Any

import pytest

from extensions.pages.studio.browser import Tab


@pytest.fixture
def tab(browser: Any, address: str) -> Iterator[Tab]:
    """The studio at the ``address`` of a test file; no fault may be left in the console."""
    made = Tab(browser, address)
    try:
        yield made
        assert made.faults == []
    finally:
        made.close()
