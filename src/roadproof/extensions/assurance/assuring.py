"""Assurance cases in Goal Structuring Notation, with each solution checked again."""

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
from roadproof.extensions.assurance.answers import assurance as kept
from roadproof.extensions.assurance.argument.argument_page import argument_page
from roadproof.extensions.assurance.argument.drawing import as_file, draw_argument
from roadproof.extensions.assurance.case.case import Case, Element, Kind
from roadproof.extensions.assurance.case.limits import Limit
from roadproof.extensions.assurance.case.reading import read_case
from roadproof.extensions.assurance.case.states import OpenPoint, State, open_points, propagate
from roadproof.extensions.assurance.keywords import AssuranceKeywords
from roadproof.extensions.assurance.settings import Assurance
from roadproof.extensions.assurance.solutions import SolutionCheck, check_evidence, digest_of, judge_solution
from roadproof.frontends.api.checking import Solver
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.loading import load_library
from roadproof.library.specification import Library
from roadproof.reasons import Reason, Why
from roadproof.runtime.files import write_whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode


@dataclass(frozen=True, repr=False)
class AssuranceReport:
    """A case with the state of each element; ``solutions`` by id."""

    case: Case
    solutions: Mapping[str, SolutionCheck]
    states: Mapping[str, State]
    solver: Solver
    library: Library

    @property
    def state(self) -> State:
        """That of the top goal."""
        return self.states[self.case.top]

    @property
    def exit_code(self) -> ExitCode:
        """Where the case is broken that of ``check`` for its evidence; 20 where it is open."""
        if self.state is State.BROKEN:
            return max(x.exit_code for x in self.solutions.values() if x.state is State.BROKEN)
        return ExitCode.AS_EXPECTED if self.state is State.HOLDS else ExitCode.UNKNOWN

    @cached_property
    def open_points(self) -> tuple[OpenPoint, ...]:
        """The elements that keep the top goal from holding, the worst first."""
        return tuple(open_points(self.case, self.states))

    @cached_property
    def elements(self) -> tuple[Element, ...]:
        """The elements of the case, and an assumption for each solution whose evidence has limits."""
        limited = {x: f"{x}.limits" for x, found in self.solutions.items() if found.limits}
        derived = [
            Element(name, Kind.ASSUMPTION, _limits_told(solution, self.solutions[solution].limits))
            for solution, name in limited.items()
        ]
        return (*(_with_limits(x, limited) for x in self.case.elements.values()), *derived)

    def reasons(self, name: str) -> tuple[Reason, ...]:
        """Why a solution or an undeveloped element does not hold."""
        if name in self.solutions:
            return self.solutions[name].reasons
        return (Why.UNDEVELOPED(),)

    def as_data(self) -> JsonObject:
        """As the plain data of ``--json``."""
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
        more = {name: _evidence_told(self.case.elements[name], x) for name, x in self.solutions.items()}
        return draw_argument(self.case.title, self.elements, self.case.top, self.states, more)

    @cached_property
    def _answer(self) -> kept.Answer:
        return kept.Answer(
                **heading(kept.SCHEMA, self.library),
                case=str(self.case.path),
                sha256=digest_of(self.case.path),
                title=self.case.title,
                solver=self.solver,
                top=self.case.top,
                state=self.state.value,
                elements=tuple(map(self._kept, self.elements)),
                open_points=tuple(
                    kept.OpenPoint(
                        element=x.element, state=x.state.value, reasons=self.reasons(x.element), path=x.path,
                        others=x.others,
                    )
                    for x in self.open_points
                ),
            )  # fmt: skip

    def _kept(self, element: Element) -> kept.Element:
        found, said = self.solutions.get(element.id), element.evidence
        solution = None
        if found is not None and said is not None:
            solution = kept.Solution(
                evidence=said.path, expect=said.expect, select=said.select, entries=said.entries,
                sha256=found.sha256, verdicts=found.verdicts, reasons=found.reasons,
            )  # fmt: skip
        state = self.states.get(element.id)
        limits = () if element.line else self.solutions[element.id.removesuffix(".limits")].limits
        return kept.Element(
            id=element.id,
            kind=element.kind.value,
            text=element.text,
            state=None if state is None else state.value,
            supported_by=element.supported_by,
            in_context_of=element.in_context_of,
            undeveloped=element.undeveloped,
            solution=solution,
            limits=tuple(kept.Limit(name=x.name, told=x.told) for x in limits),
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
        told = ", ".join(f"{n} {state}" for state, n in counts.items())
        end = f"the top goal {self.case.top} {_said(self.state)}"
        yield f"{len(self.solutions)} solutions: {told or 'none'}; {end}"

    def _tree(self, name: str, indent: str, shown: set[str]) -> Iterator[str]:
        """An element and those below it; one that was shown before without them."""
        element = self.case.elements[name]
        again = " (see above)" if name in shown else ""
        yield f"{indent}{name:<4} {self.states[name]:<11} {element.kind}: {element.text}{again}"
        if not again:
            shown.add(name)
            for below in element.supported_by:
                yield from self._tree(below, f"{indent}  ", shown)


def _said(state: State) -> str:
    return "holds" if state is State.HOLDS else f"is {state}"


def _with_limits(element: Element, limited: Mapping[str, str]) -> Element:
    """An element with the derived assumptions of the solutions that support it."""
    more = tuple(limited[x] for x in element.supported_by if x in limited)
    if not more:
        return element
    return replace(element, in_context_of=(*element.in_context_of, *more))


def _evidence_told(solution: Element, found: SolutionCheck) -> str:
    """What the picture says of the evidence of a solution."""
    path = solution.evidence.path if solution.evidence else ""
    counts = ", ".join(f"{n} {word}" for word, n in found.verdicts.items())
    return f"{path}: {counts}" if counts else path


def _limits_told(solution: str, limits: Sequence[Limit]) -> str:
    """The limits of a solution in a line: those that are few in words, the others counted."""
    told = [f"{x.name}: {x.told[0]}" if len(x.told) == 1 else f"{x.name} ({len(x.told)})" for x in limits]
    return f"{solution} holds within: {'; '.join(told)}"


@takes(Assurance)
def assurance(case: str | Path, **options: Unpack[AssuranceKeywords]) -> AssuranceReport:
    """Check an assurance case: each solution as ``check`` does, and what follows for the goals above it.

    ``case``: a TOML file. ``strict``: a solution is undecided where the verdict it
    expects has no evidence, such as NONE-WITHIN. Raises ``InputError`` for a case that is not well-formed.
    """
    asked = Assurance.of(options)
    read = read_case(Path(case))
    told = CheckKeywords(
        solver=asked.solver, specs=asked.specs, effort=asked.effort, timeout=asked.timeout, jobs=asked.jobs,
        progress=asked.progress,
    )  # fmt: skip
    reports: dict[Path, tuple[Finding, ...] | RoadproofError] = {}
    found: dict[str, SolutionCheck] = {}
    for solution in read.solutions:
        assert solution.evidence is not None
        path = read.path.parent / solution.evidence.path
        if solution.evidence.expect and path not in reports:
            reports[path] = check_evidence(path, told)
        found[solution.id] = judge_solution(path, solution.evidence, reports.get(path), asked.strict)
    states = propagate(read, {name: x.state for name, x in found.items()})
    library = load_library([Path(x) for x in asked.specs])
    report = AssuranceReport(read, found, states, asked.solver, library)
    if asked.svg is not None:
        write_whole(Path(asked.svg), report.picture)
    if asked.page is not None:
        write_whole(Path(asked.page), report.page.encode())
    return report
