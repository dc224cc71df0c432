"""The summary at the top of a page: question and answer of each result, findings, and versions."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from roadproof.engines.prove.properties import find_task
from roadproof.evidence.codec import read
from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding, summary
from roadproof.evidence.strict import Json
from roadproof.extensions.catalogue.catalogue_data import Figure
from roadproof.extensions.pages.page.open_points import parts_left_out
from roadproof.extensions.pages.page.results import PageResult
from roadproof.extensions.pages.page.section_kind import OpenItem
from roadproof.extensions.pages.page.templates import render
from roadproof.frontends.report.sheet import excerpt
from roadproof.library.words import spans

OPEN: Final = ("UNKNOWN", "NONE-WITHIN", "PROVED-BOUNDED", "VACUOUS", "CROSSCHECK-FAILED", "undecided")
"""Verdicts that leave a question open."""
NOT_SHOWN: Final = ("unknown", "stale", "missing", "rejected", "refuted")
"""The states of requirements that evidence does not show, ordered."""
_SKIPPED = ("drive", "drives", "counterexample", "boundaries", "missed", "surely", "words")
_ANCHORS = {
    ("index", "claims"): "claim",
    ("verdicts", "verdicts"): "claim",
    ("overlap", "verdicts"): "pair",
    ("witness", "verdicts"): "sought",
    ("redundancy", "verdicts"): "change",
    ("classify", "classes"): "kind",
    ("coverage", "classes"): "class",
    ("preventable", "plates"): "plate",
    ("preventable", "lemmas"): "lemma",
}
"""The prefixes of ids of entries, by kind of result and field; other entries have no id of their own."""

_REMARKS = {"faults": "fault", "doubts": "doubt", "contradictions": "contradiction"}
"""A catalogue's remarks about its tests, by their words in counts."""


@dataclass(frozen=True)
class SummaryStatement:
    """A verdict with its statement; ``target``: the id of the part of the page with its evidence.

    ``expected``: whether a claim has the expected verdict; None for other statements.
    """

    verdict: str
    text: str
    target: str
    expected: bool | None = None


@dataclass(frozen=True)
class Overview:
    """The row of a section in the summary.

    ``counts``: counts in words; ``rejected``: the number of reasons to reject its evidence; ``points``: what
    is open beside the verdicts, such as situations that no test shows.
    """

    title: str
    question: str
    target: str
    name: str = ""
    subject: str = ""
    counts: str = ""
    statements: Sequence[SummaryStatement] = ()
    rejected: int = 0
    points: Sequence[SummaryStatement] = ()

    @property
    def verdicts(self) -> list[str]:
        """The verdict of each statement."""
        return [x.verdict for x in self.statements]

    @property
    def rank(self) -> int:
        """The urgency: 0 where evidence is rejected, 1 for surprising or open statements, else 2."""
        if self.rejected:
            return 0
        surprising = any(x.verdict == "REFUTED" and x.expected is False for x in self.statements)
        is_open = any(x.verdict in (*OPEN, *NOT_SHOWN) for x in self.statements)
        return 1 if surprising or self.points or is_open else 2


def overview(
    result: PageResult,
    title: str,
    question: str,
    rejected: int = 0,
    more: Iterable[OpenItem] = (),
    counts: str = "",
) -> Overview:
    """Return the row of a result in the summary; ``more``, ``counts``: as its section kind says."""
    entries = [*_statements(result)]
    target = f"result-{result.id}"
    statements = [
        SummaryStatement(_text(x, "verdict"), _statement_text(x), at, _is_expected(x, result))
        for x, at in entries
    ]
    subject = _subject(result, [x for x, _ in entries])
    every = (*more, *parts_left_out(result))
    points = [SummaryStatement(x.word, excerpt(x.text, 240), x.target) for x in every]
    shown = counts or _counts_of(result)
    return Overview(title, question, target, result.name, subject, shown, statements, rejected, points)


def _statements(result: PageResult) -> Iterator[tuple[Mapping[str, Json], str]]:
    """Yield the entries that have a verdict, each with the id of its part of the page."""
    if result.kind in ("order", "trace"):
        yield from _implications(result) if result.kind == "order" else _requirements(result)
        return
    count = 0
    for key, value in result.data.items():
        prefix = _ANCHORS.get((result.kind, key))
        entries = value if isinstance(value, list) else [value]
        if result.kind == "redundancy":  # its section has those that are needed last
            entries = sorted(entries, key=lambda x: isinstance(x, dict) and x.get("redundant") is False)
        for k, entry in enumerate(entries):
            target = f"{prefix}-{result.id}-{k}" if prefix else f"result-{result.id}"
            for x in () if key in _SKIPPED else _entries_with_verdict(entry):
                count += 1
                yield x, target
    if not count and isinstance(result.data.get("verdict"), str):
        yield result.data, f"result-{result.id}"


def _requirements(result: PageResult) -> Iterator[tuple[Mapping[str, Json], str]]:
    """Yield the requirements, with their states as verdicts."""
    requirements = result.data.get("requirements")
    for k, x in enumerate(requirements if isinstance(requirements, list) else []):
        if isinstance(x, dict):
            text = f"{_text(x, 'id')}: {_text(x, 'title') or _text(x, 'text')}"
            yield {"verdict": x.get("state"), "name": text}, f"requirement-{result.id}-{k}"


def _implications(result: PageResult) -> Iterator[tuple[Mapping[str, Json], str]]:
    for key, verdict in (("proved", "PROVED"), ("missing", "REFUTED"), ("doubts", "UNKNOWN")):
        entries = result.data.get(key)
        for k, x in enumerate(entries if isinstance(entries, list) else []):
            if isinstance(x, dict):
                target = f"implied-{result.id}-{k}" if key == "proved" else f"result-{result.id}"
                text = f"{x.get('from')} implies {x.get('to')}"
                yield {"verdict": verdict, "name": text}, target


def _entries_with_verdict(value: Json) -> Iterator[Mapping[str, Json]]:
    if isinstance(value, list):
        for x in value:
            yield from _entries_with_verdict(x)
    elif isinstance(value, dict) and isinstance(value.get("verdict"), str):
        yield value
    elif isinstance(value, dict):
        for key, x in value.items():
            if key not in _SKIPPED:
                yield from _entries_with_verdict(x)


def _text(x: Mapping[str, Json], key: str) -> str:
    """Return a field as text, empty where it is missing."""
    value = x.get(key)
    return "" if value is None else str(value)


def _statement_text(x: Mapping[str, Json]) -> str:
    """Return an entry in words: a claim's property, a pair's scenarios, else a name or a formula."""
    scenario, reason, inside = _text(x, "scenario"), _text(x, "reason"), _text(x, "set")
    numbered = f"scenario {scenario}" if scenario else ""
    if _text(x, "property") not in ("", "claim"):
        name = "-".join(filter(None, (_text(x, "property"), _text(x, "part"))))
        task = find_task(_text(x, "claim"), inside)
        head = " ".join(filter(None, (name, numbered, "" if task is None else task.title)))
    elif "a" in x and "b" in x:
        head = f"scenarios {_text(x, 'a')} and {_text(x, 'b')}"
    else:
        named = next(filter(None, (_text(x, key) for key in ("name", "claim", "formula", "description"))), "")
        head = ": ".join(filter(None, (numbered, named)))
    of = f" in {inside}" if inside else ""
    return excerpt(f"{head}{of}{f': {reason}' if reason else ''}", 240)


def _is_expected(x: Mapping[str, Json], result: PageResult) -> bool | None:
    """Return whether a claim has the verdict that the answer or the list of properties expects; None for
    other entries.
    """
    if result.kind not in ("index", "verdicts"):
        return None
    if isinstance(x.get("expected"), str):
        return x.get("expected") == x.get("verdict")
    task = find_task(_text(x, "claim"), _text(x, "set"))
    return task is not None and not x.get("assuming") and task.expected == x.get("verdict")


def _subject(result: PageResult, statements: Iterable[Mapping[str, Json]]) -> str:
    """Return the scenarios and spec sets that a result is about."""
    entries = [result.data, *statements]
    settings = result.data.get("settings")
    entries += [settings] if isinstance(settings, dict) else []
    numbers = {
        n for x in entries for key in ("scenario", "scenarios", "a", "b") for n in _integers(x.get(key))
    }
    sets = [y for x in entries for key in ("set", "sets", "set_a", "set_b") for y in _texts(x.get(key))]
    named = dict.fromkeys(sets)
    parts = [f"scenario{'s' if len(numbers) > 1 else ''} {spans(numbers)}"] if numbers else []
    parts += [f"set{'s' if len(named) > 1 else ''} {', '.join(named)}"] if named else []
    return excerpt("; ".join(parts), 200)


def _integers(value: Json) -> list[int]:
    values = value if isinstance(value, list) else [value]
    return [x for x in values if isinstance(x, int) and not isinstance(x, bool)]


def _texts(value: Json) -> list[str]:
    return [x for x in (value if isinstance(value, list) else [value]) if isinstance(x, str)]


def _counts_of(result: PageResult) -> str:
    """Return the counts of a catalogue or of recordings in words, empty for other results."""
    data = result.data
    if result.kind == "catalogue":
        counts = (("tests", "test"), *((key, words) for key, words in _REMARKS.items()))
        totals = [(len(x) if isinstance(x := data.get(key), list) else 0, words) for key, words in counts]
        parts = [f"{n} {_plural(words, n)}" for n, words in totals if n]
        parts += [
            f"{x.total - x.tested} of {x.total} {x.kind} not tested (set {x.set_name})"
            for x in _figures(result)
            if x.tested < x.total
        ]
        return ", ".join(parts)
    if result.kind != "traffic-results":
        return ""
    table = data.get("table")
    rows = [x for x in table if isinstance(x, dict)] if isinstance(table, list) else []
    sums: dict[str, Counter[str]] = {}
    for x in rows:
        if x.get("min_danger") == rows[0].get("min_danger"):
            numbers = {key: x[key] for key in ("matching", "traces") if isinstance(x.get(key), int)}
            sums.setdefault(str(x.get("set")), Counter()).update(numbers)
    many = data.get("recordings")
    read = f"{many} {_plural('recording', many)}, {data.get('vehicles')} vehicles"
    matches = [f"{n['matching']} of {n['traces']} critical traces match in {of}" for of, n in sums.items()]
    return excerpt("; ".join([read, *matches]), 300)


def _figures(result: PageResult) -> list[Figure]:
    """Return the figures of a catalogue for all road sectors."""
    figures = result.data.get("figures")
    every = [read(Figure, x, result.name) for x in figures] if isinstance(figures, list) else []
    return [x for x in every if not x.sector]


def _plural(word: str, count: object) -> str:
    return word if count == 1 else f"{word}s"


def summary_section(
    overviews: Sequence[Overview],
    findings: Sequence[Finding],
    solver: str,
    results: Sequence[PageResult],
    lines: Iterable[tuple[str, str]],
) -> str:
    """Return the summary as HTML: a row for each section, findings by importance, versions and digests.

    ``solver`` checked the ``findings``; ``lines`` are names with values that stand before the versions.
    """
    statements = [x for section in overviews for x in section.statements]
    return render(
        "summary.html",
        overviews=overviews,
        checked=summary(findings, solver) if any(x.kind != NO_EVIDENCE for x in findings) else "",
        wrong=[x for x in findings if x.outcome is not Acceptance.ACCEPTED and x.kind != NO_EVIDENCE],
        open=[*(y for x in overviews for y in x.points), *(x for x in statements if x.verdict in OPEN)],
        unshown=sorted(
            (x for x in statements if x.verdict in NOT_SHOWN), key=lambda x: -NOT_SHOWN.index(x.verdict)
        ),
        traced=bool(results) and all(x.kind == "trace" for x in results),
        refuted=[x for x in statements if x.verdict == "REFUTED" and x.expected is False],
        controls=[x for x in statements if x.verdict == "REFUTED" and x.expected],
        lines=[*lines, *_origins(results)],
        files=[(x.name, x.digest) for x in results],
    )


def _origins(results: Sequence[PageResult]) -> Iterator[tuple[str, str]]:
    """Yield the versions, definitions and settings of results."""
    for name, key in (("results made by roadproof", "roadproof"), ("definitions", "library")):
        values = dict.fromkeys(str(x.data[key]) for x in results if isinstance(x.data.get(key), str))
        if values:
            yield name, ", ".join(values)
    for options in dict.fromkeys(map(_equations, results)):
        if options:
            yield "readings", options
    specs = dict.fromkeys(str(y) for x in results for y in _texts(x.data.get("specs")))
    if specs:
        yield "specification files", ", ".join(specs)


def _equations(result: PageResult) -> str:
    options = result.data.get("options")
    return ", ".join(f"{k}={v}" for k, v in options.items()) if isinstance(options, dict) else ""
