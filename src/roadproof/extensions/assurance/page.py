"""The section about requirements on a report page."""

from roadproof.evidence.codec import read
from roadproof.extensions.assurance.answers import trace
from roadproof.extensions.assurance.requirements.report import counted
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import SectionKind, Values


def _traced(result: PageResult, context: PageContext, words: Words) -> Values:
    """Return the values of the template: the requirements of an answer, and how many are in each state."""
    answer = read(trace.TraceData, result.data, result.name)
    return {"answer": answer, "counted": counted(answer)}


TRACE = SectionKind("Requirements", "Which of them are shown?", "trace", _traced)
