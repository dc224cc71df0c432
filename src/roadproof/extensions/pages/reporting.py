"""Presents results of any kind as one page: ``roadproof report`` and ``roadproof.page``."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, Unpack

from roadproof.errors import RoadproofError, UsageError
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.extensions.pages import settings
from roadproof.extensions.pages.keywords import PageKeywords
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, PageSources, read_results
from roadproof.extensions.pages.page.sections import drive_section, evidence_section, section
from roadproof.extensions.pages.page.summary import summary_section
from roadproof.extensions.pages.page.templates import page as page_of
from roadproof.frontends.api.checking import CheckReport, take_over
from roadproof.frontends.report.sheet import excerpt
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.loading import load_library
from roadproof.library.scenarios import numbers_of
from roadproof.library.specification import Library
from roadproof.library.words import words_of
from roadproof.questions.question import QUESTION
from roadproof.runtime.files import atomic_file, utf8
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode

PAGE: Final = "page.html"
"""The page in a folder of answers."""


@dataclass(frozen=True, repr=False)
class Page:
    """A page as ``text`` and where it was written.

    ``checked``: the report on the evidence in it. ``sources``: the results that it shows.
    """

    path: Path
    text: str
    drives: int
    results: int
    checked: CheckReport | None
    sources: PageSources

    @property
    def exit_code(self) -> ExitCode:
        """The exit code of the evidence; the page shows evidence that is not accepted, and says so."""
        return max((x.outcome.exit_code for x in self._findings), default=ExitCode.AS_EXPECTED)

    @property
    def _findings(self) -> tuple[Finding, ...]:
        return () if self.checked is None else self.checked.findings

    def __repr__(self) -> str:
        return f"<Page: {self.path}>"

    def __str__(self) -> str:
        counts = [(self.results, "result"), (self.drives, "drive")]
        content = ", ".join(f"{n} {word}{'s' if n != 1 else ''}" for n, word in counts)
        wrong = sum(x.outcome is not Acceptance.ACCEPTED for x in self._findings)
        bad = (
            f"; {wrong} of {len(self._findings)} claims are not accepted, and the page says why"
            if wrong
            else ""
        )
        size = f"{len(utf8(self.text)) / 1e6:.1f} MB"
        return f"{self.path}: {content}, {size}, in one file that needs no network{bad}"


@takes(settings.PageSettings)
def page(*results: str | Path, out: str | Path, **options: Unpack[PageKeywords]) -> Page:
    """Write one HTML file about results: folders of ``out``, evidence, and answers as JSON.

    Evidence is checked again while the page is made, and each claim states the outcome. ``specs``:
    specification files that the results were made with. Raises ``InputError`` for a file that is no result or
    cannot be written, ``UsageError``.
    """
    question = settings.PageSettings.of(options)
    if not results:
        raise UsageError("name at least one result: a folder, a JSON answer, or evidence")
    paths = [Path(x) for x in results]
    target = Path(out)
    if target.suffix.lower() not in (".html", ".htm"):
        raise UsageError(f"out={target}: name a file that ends with .html")
    named = tuple(Path(x) for x in question.specs)
    sources = read_results(paths, named)
    checked = None
    if sources.checkable:
        keywords = CheckKeywords(
            solver=question.solver, specs=named, jobs=question.jobs, progress=question.progress
        )
        checked = take_over(*sources.checkable, folders=sources.folders, **keywords)
    library = load_library((*named, *(checked.specs if checked else ())))
    findings = () if checked is None else checked.findings
    context = PageContext(library, _by_file(findings), _rejected(findings), folder=target.parent)
    evidence_paths = {path.resolve() for path in sources.evidence}
    alone = [x for x in findings if Path(x.where).is_file() and Path(x.where).resolve() in evidence_paths]
    sections = sorted(
        [
            *(
                [drive_section(alone, context)]
                if any(x.kind == "drive" and x.outcome is Acceptance.ACCEPTED for x in alone)
                else []
            ),
            *(section(x, context, _scenario_names(x, library)) for x in sources.results),
        ],
        key=lambda x: x.overview.rank,
    )
    sections += [evidence_section(alone, context, question.solver)] if alone else []
    heading = question.title or excerpt(f"roadproof: {', '.join(x.stem or str(x) for x in paths)}", 120)
    summary = summary_section(
        [x.overview for x in sections],
        findings,
        question.solver,
        sources.results,
        _provenance(checked, library),
    )
    text = page_of(heading, summary, [x.html for x in sections], context.documents)
    with atomic_file(target) as file:
        file.write(utf8(text))
    return Page(target, text, len(context.documents), len(sources.results) + bool(alone), checked, sources)


def folder_page(folder: Path) -> None:
    """Write the page about the answers in a folder into it."""
    page(folder, out=folder / PAGE, title=folder.resolve().name)


def _provenance(checked: CheckReport | None, library: Library) -> Iterator[tuple[str, str]]:
    """Yield the version that made the page, and the fields of answers that nothing was compared with."""
    yield "page made by", f"roadproof {VERSION} with definitions {library.fingerprint}"
    if checked is not None:
        for folder, fields in checked.not_checked.items():
            yield f"not checked in {folder}", ", ".join(fields)


def _rejected(findings: Sequence[Finding]) -> dict[str, list[str]]:
    """Return the objections to each question itself, in words, by its path."""
    rejections: dict[str, list[str]] = {}
    for x in findings:
        if x.outcome is not Acceptance.ACCEPTED and Path(x.where).name == QUESTION:
            rejections.setdefault(x.where, []).append(f"{x.label}: {x.reason}" if x.label else x.reason)
    return rejections


def _by_file(findings: Sequence[Finding]) -> dict[Path, Finding]:
    """Return the finding about each file of evidence; for several claims in one file, the first that is
    rejected.
    """
    by_path: dict[Path, Finding] = {}
    for finding in findings:
        path = Path(finding.where)
        if not path.is_file():
            continue
        known = by_path.get(path.resolve())
        if known is None or known.outcome is Acceptance.ACCEPTED:
            by_path[path.resolve()] = finding
    return by_path


def _scenario_names(result: PageResult, library: Library) -> Mapping[int, str]:
    """Return the names of scenarios in the set of a result, by number."""
    sets = result.data.get("set") or result.data.get("sets") or "base"
    first = sets[0] if isinstance(sets, list) else sets
    try:
        home = library.select(str(first).partition(",")[0])
    except RoadproofError:
        home = library.select()
    return {n: words_of(home, n).name for n in numbers_of(home)}
