"""The answers of surveys on a page."""

from collections.abc import Mapping

from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import SectionKind, Values


class Part:
    """A list of entries that the template ``plain`` shows as a table."""

    def __init__(self, key: str, value: list[Mapping[str, object]]) -> None:
        self.key, self.value = key, value
        self.columns = ["scenario", "verdict"]


def _shown(result: PageResult, context: PageContext, words: Words) -> Values:
    verdicts = result.data["verdicts"]
    assert isinstance(verdicts, list)
    entries = [{"scenario": x["name"], "verdict": x["verdict"]} for x in verdicts if isinstance(x, dict)]
    return {"parts": [Part("alone", entries)]}


SURVEY = SectionKind("Scenarios alone", "Which can hold while no other one does?", "plain", _shown)
