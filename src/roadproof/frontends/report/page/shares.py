"""Values of sections about recordings: classes with their shares, an evaluation, one monitored trace."""

from collections import Counter

from roadproof.evidence.answers import classify, monitor
from roadproof.evidence.answers import traffic as evaluations
from roadproof.evidence.codec import read, write
from roadproof.frontends.report.classify import sheet_of
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.results import Result, Words


def classes(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Classes; ``claims``: counted by kind."""
    index = read(classify.Index, result.data, result.name)
    claims = Counter((x.kind, x.verdict) for x in index.claims)
    return {"answer": index, "sheet": sheet_of(index.classes), "claims": [*claims.items()]}


def traffic(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """The results table of recordings; ``numbers``: those of its scenarios, as texts and numbers."""
    answer = read(evaluations.Answer, result.data, result.name)
    numbers = dict.fromkeys(n for x in answer.table for n in x.scenarios)
    return {"answer": answer, "numbers": [(n, int(n)) for n in numbers]}


def monitored(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """The answer of ``monitor --json``, which holds no trace: its verdict, and when each part is true."""
    answer = read(monitor.Answer, result.data, result.name)
    strips = [(x.formula, x.true) for x in answer.parts]
    return {"answer": answer, "strips": strips, "overruled": [write(x) for x in answer.overruled]}
