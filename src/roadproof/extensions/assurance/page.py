"""The section about requirements on a report page."""

import os
from pathlib import Path
from urllib.parse import quote

from roadproof.evidence.codec import read
from roadproof.extensions.assurance.answers import trace
from roadproof.extensions.assurance.requirements.report import counted
from roadproof.extensions.catalogue.concrete_claims import JUDGED
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import SectionKind, Values
from roadproof.extensions.pages.reporting import PAGE


def _traced(result: PageResult, context: PageContext, words: Words) -> Values:
    """Return the values of the template: the requirements of an answer, and how many are in each state.

    ``row_of`` returns the address of a test's row in the page of its catalogue, where there is one.
    """
    answer = read(trace.TraceData, result.data, result.name)

    def row_of(where: str) -> str:
        file = Path(where)
        page = file.with_name(PAGE)
        if not (file.name.startswith(JUDGED) and page.is_file()):
            return ""
        return f"{quote(Path(os.path.relpath(page, context.folder)).as_posix())}#{file.stem}"

    return {"answer": answer, "counted": counted(answer), "row_of": row_of}


TRACE = SectionKind("Requirements", "Which of them are shown?", "trace", _traced)
