"""Checks assurance cases in Goal Structuring Notation: ``roadproof assurance`` and
``roadproof.assurance``.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Unpack
from xml.etree.ElementTree import Element as XmlElement

from roadproof.errors import RoadproofError
from roadproof.evidence.codec import write
from roadproof.evidence.finding import Finding
from roadproof.evidence.heading import heading
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.assurance.answers.assurance import (
    SCHEMA,
    ArgumentElement,
    ArgumentLimit,
    ArgumentOpenPoint,
    ArgumentSolution,
    AssuranceData,
)
from roadproof.extensions.assurance.argument.argument_page import argument_page
from roadproof.extensions.assurance.argument.drawing import as_file, draw_argument
from roadproof.extensions.assurance.case.case import AssuranceCase, CaseElement, ElementKind
from roadproof.extensions.assurance.case.limits import Limit
from roadproof.extensions.assurance.case.reading import read_case
from roadproof.extensions.assurance.case.states import ElementState, OpenPoint, open_points, propagate
from roadproof.extensions.assurance.keywords import AssuranceKeywords
from roadproof.extensions.assurance.settings import Assurance
from roadproof.extensions.assurance.solutions import SolutionCheck, check_evidence, digest_of, judge_solution
from roadproof.frontends.api.checking import Solver
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.loading import load_library
from roadproof.library.specification import Library
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.files import write_atomic
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode


@dataclass(frozen=True, repr=False)
class AssuranceReport:
    """A checked assurance case: the state of each element, and the check of each solution, both by id."""

    case: AssuranceCase
    solutions: Mapping[str, SolutionCheck]
    states: Mapping[str, ElementState]
    solver: Solver
    library: Library

    @property
    def state(self) -> ElementState:
        """The state of the top goal."""
        return self.states[self.case.top]

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: that of ``check`` for a broken case, 20 for an open one, else 0."""
        if self.state is ElementState.BROKEN:
            return max(x.exit_code for x in self.solutions.values() if x.state is ElementState.BROKEN)
        return ExitCode.AS_EXPECTED if self.state is ElementState.HOLDS else ExitCode.UNKNOWN

    @cached_property
    def open_points(self) -> tuple[OpenPoint, ...]:
        """The elements that prevent the top goal from holding, the worst first."""
        return tuple(open_points(self.case, self.states))

    @cached_property
    def elements(self) -> tuple[CaseElement, ...]:
        """The elements of the case, and one derived assumption for each solution whose evidence
        has limits.
        """
        limited = {x: f"{x}.limits" for x, check in self.solutions.items() if check.limits}
        derived = [
            CaseElement(name, ElementKind.ASSUMPTION, _limits_text(solution, self.solutions[solution].limits))
            for solution, name in limited.items()
        ]
        return (*(_with_limits(x, limited) for x in self.case.elements.values()), *derived)

    def reasons(self, name: str) -> tuple[Reason, ...]:
        """Return the reasons why a solution or an undeveloped element does not hold."""
        if name in self.solutions:
            return self.solutions[name].reasons
        return (ReasonKind.UNDEVELOPED(),)

    def as_data(self) -> JsonObject:
        """Return the plain data of ``--json``."""
        return write(self._answer)

    @cached_property
    def picture(self) -> bytes:
        """The argument as an SVG file."""
        return as_file(self._drawing)

    @property
    def page(self) -> str:
        """The argument, its evidence and its limits as an HTML page."""
        return argument_page(self._answer, self._drawing)

    @cached_property
    def _drawing(self) -> XmlElement:
        notes = {name: _evidence_text(self.case.elements[name], x) for name, x in self.solutions.items()}
        return draw_argument(self.case.title, self.elements, self.case.top, self.states, notes)

    @cached_property
    def _answer(self) -> AssuranceData:
        return AssuranceData(
                **heading(SCHEMA, self.library),
                case=str(self.case.path),
                sha256=digest_of(self.case.path),
                title=self.case.title,
                solver=self.solver,
                top=self.case.top,
                state=self.state.value,
                elements=tuple(map(self._element_data, self.elements)),
                open_points=tuple(
                    ArgumentOpenPoint(
                        element=x.element, state=x.state.value, reasons=self.reasons(x.element), path=x.path,
                        others=x.others,
                    )
                    for x in self.open_points
                ),
            )  # fmt: skip

    def _element_data(self, element: CaseElement) -> ArgumentElement:
        check, evidence = self.solutions.get(element.id), element.evidence
        solution = None
        if check is not None and evidence is not None:
            solution = ArgumentSolution(
                evidence=evidence.path, expect=evidence.expect, select=evidence.select,
                entries=evidence.entries, sha256=check.sha256, verdicts=check.verdicts, reasons=check.reasons,
            )  # fmt: skip
        state = self.states.get(element.id)
        limits = () if element.line else self.solutions[element.id.removesuffix(".limits")].limits
        return ArgumentElement(
            id=element.id,
            kind=element.kind.value,
            text=element.text,
            state=None if state is None else state.value,
            supported_by=element.supported_by,
            in_context_of=element.in_context_of,
            undeveloped=element.undeveloped,
            solution=solution,
            limits=tuple(ArgumentLimit(name=x.name, told=x.texts) for x in limits),
        )

    def __repr__(self) -> str:
        return f"<AssuranceReport: {self.case.path}, {self.state}>"

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        yield self.case.title
        yield from self._tree(self.case.top, "", set())
        for point in self.open_points:
            yield f"{point.state}: {' -> '.join(point.path)}" + (
                f" and {point.others} other way{'s' * (point.others > 1)}" if point.others else ""
            )
            yield from (f"  {reason}" for reason in self.reasons(point.element))
        counts = Counter(x.state for x in self.solutions.values())
        summary = ", ".join(f"{n} {state}" for state, n in counts.items())
        end = f"the top goal {self.case.top} {_state_phrase(self.state)}"
        yield f"{len(self.solutions)} solutions: {summary or 'none'}; {end}"

    def _tree(self, name: str, indent: str, shown: set[str]) -> Iterator[str]:
        """Yield the lines of an element and those below it; elements that were listed before come without
        support.
        """
        element = self.case.elements[name]
        again = " (see above)" if name in shown else ""
        yield f"{indent}{name:<4} {self.states[name]:<11} {element.kind}: {element.text}{again}"
        if not again:
            shown.add(name)
            for below in element.supported_by:
                yield from self._tree(below, f"{indent}  ", shown)


def _state_phrase(state: ElementState) -> str:
    return "holds" if state is ElementState.HOLDS else f"is {state}"


def _with_limits(element: CaseElement, limited: Mapping[str, str]) -> CaseElement:
    """Return an element with the derived assumptions of its solutions added to its context."""
    more = tuple(limited[x] for x in element.supported_by if x in limited)
    if not more:
        return element
    return replace(element, in_context_of=(*element.in_context_of, *more))


def _evidence_text(solution: CaseElement, check: SolutionCheck) -> str:
    """Return the text below a solution in the picture: its path and its verdicts."""
    path = solution.evidence.path if solution.evidence else ""
    counts = ", ".join(f"{n} {word}" for word, n in check.verdicts.items())
    return f"{path}: {counts}" if counts else path


def _limits_text(solution: str, limits: Sequence[Limit]) -> str:
    """Return the limits of a solution in one line: single limits in full, several of one name as a count."""
    texts = [f"{x.name}: {x.texts[0]}" if len(x.texts) == 1 else f"{x.name} ({len(x.texts)})" for x in limits]
    return f"{solution} holds within: {'; '.join(texts)}"


@takes(Assurance)
def assurance(case: str | Path, **options: Unpack[AssuranceKeywords]) -> AssuranceReport:
    """Check an assurance case: check each solution as ``check`` does, and derive the state of the goals
    above.

    ``case``: a TOML file. ``strict``: a solution is undecided where its expected verdict has no evidence,
    such as NONE-WITHIN. Raises ``InputError`` for a case that is not well-formed.
    """
    settings = Assurance.of(options)
    argument = read_case(Path(case))
    check_keywords = CheckKeywords(
        solver=settings.solver, specs=settings.specs, effort=settings.effort, timeout=settings.timeout,
        jobs=settings.jobs, progress=settings.progress,
    )  # fmt: skip
    reports: dict[Path, tuple[Finding, ...] | RoadproofError] = {}
    checks: dict[str, SolutionCheck] = {}
    for solution in argument.solutions:
        assert solution.evidence is not None
        path = argument.path.parent / solution.evidence.path
        if solution.evidence.expect and path not in reports:
            reports[path] = check_evidence(path, check_keywords)
        checks[solution.id] = judge_solution(path, solution.evidence, reports.get(path), settings.strict)
    states = propagate(argument, {name: x.state for name, x in checks.items()})
    library = load_library([Path(x) for x in settings.specs])
    report = AssuranceReport(argument, checks, states, settings.solver, library)
    if settings.svg is not None:
        write_atomic(Path(settings.svg), report.picture)
    if settings.page is not None:
        write_atomic(Path(settings.page), report.page.encode())
    return report
