"""What a catalogue of tests shows, what it misses, and drives for what is missing."""

import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

from roadproof.analysis.catalogue.completing import Known, complete
from roadproof.analysis.catalogue.courses import Courses, courses_of, of_drive
from roadproof.analysis.catalogue.decisions import Decision, Drivers, decide_formula
from roadproof.analysis.catalogue.entries import Abstract, Catalogue, Concrete
from roadproof.analysis.catalogue.examination import Examination, examine
from roadproof.analysis.catalogue.figures import SCENARIOS, Figure, figures, figures_beside, kind_of
from roadproof.analysis.catalogue.meaning import Kept, Meanings, gap_answers, scenarios_shown
from roadproof.analysis.catalogue.ranges import Span, spans_of
from roadproof.analysis.catalogue.request import NEAR, Look, Request
from roadproof.analysis.catalogue.showing import ConcreteAnswer
from roadproof.analysis.catalogue.sides import decisions_of, read_side_name
from roadproof.analysis.catalogue.tested import Remark, Target, Tested, all_facts, targets_of, tested
from roadproof.analysis.coverage.answers import ClassAnswer
from roadproof.analysis.coverage.claims import Covered
from roadproof.api.answer import Picture, Row, picture
from roadproof.api.completing import Completed, write_completions
from roadproof.api.definitions import Among, Definitions, load
from roadproof.api.restricting import drivers_of, restricted
from roadproof.api.settings import Vehicles, basis_of, one_of
from roadproof.api.studied import Studied, drawn
from roadproof.errors import UsageError
from roadproof.evidence.kinds import Evidence
from roadproof.hands import Jobs
from roadproof.preventing.models import MODELS
from roadproof.preventing.restriction import restriction_of
from roadproof.report import catalogue as report
from roadproof.report import catalogue_drivers as decisions
from roadproof.report.catalogue_drives import Drawn, draw_tests
from roadproof.searching.question import Objective
from roadproof.spec.bind import values_with
from roadproof.spec.scenarios import number_in, numbers_of
from roadproof.study.pool import Progress, Say
from roadproof.verdict import ExitCode, Verdict


@dataclass(frozen=True, repr=False)
class Catalogued(Studied[Meanings, Kept]):
    """What tests show and mean; ``examination`` has the tests, and what concrete ones show."""

    examination: Examination = field(kw_only=True)
    pieces: ClassVar[str] = "questions about abstract tests"

    @property
    def concrete(self) -> tuple[ConcreteAnswer, ...]:
        """What concrete tests show, in order."""
        return self.examination.concrete

    @property
    def catalogue(self) -> Catalogue:
        """The tests."""
        return self.examination.tests

    @cached_property
    def tested(self) -> Tested:
        """What is tested, what is missing, and what is to be said of tests."""
        facts = all_facts(self.found.answers)
        words = targets_of(self.study.asked)
        gaps = None if self.study.gaps is None else self.gap_answers
        return tested(
            self.study.asked,
            self.concrete,
            self.study.entries,
            facts,
            words,
            self.examination.request.near,
            gaps,
        )

    @cached_property
    def gap_answers(self) -> dict[str, ClassAnswer | None]:
        """Where it was asked, what is known of each class of gaps by name: None of those that tests show."""
        if self.study.gaps is None or self.study.survey is None:
            return {}
        known = self.study.survey.classes_in(gap_answers(self.found.answers))
        return {n: known(part) for n, part in self.study.gaps.parts.items()}

    @cached_property
    def figures(self) -> tuple[Figure, ...]:
        """How much is tested: by spec set, kind and road sector."""
        facts, set_name = all_facts(self.found.answers), self.study.basis.specification.set_name
        found = figures(set_name, self.tested.targets, self.tested.gaps)
        pairs = zip(self.study.beside, self.examination.beside, strict=True)
        return (*found, *(x for asked, answers in pairs for x in figures_beside(asked, answers, facts)))

    @cached_property
    def spans(self) -> tuple[Span, ...]:
        """Where it was asked, how tests of each class begin, and how drives of it can."""
        if not self.study.reaches:
            return ()
        covered = {x.name: x.covered for x in self.tested.targets}
        return tuple(spans_of(covered, all_facts(self.found.answers)))

    @cached_property
    def decisions(self) -> tuple[tuple[str, Decision], ...]:
        """What becomes of each test, by id, under each driver model, in the order of tests."""
        drivers = self.examination.drivers
        concrete = {x.entry.id: x.decisions for x in self.concrete}
        if drivers is None:
            return ()
        found: list[tuple[str, Decision]] = []
        for entry in self.catalogue.entries:
            made: Iterable[Decision] = concrete.get(entry.id, ())
            if isinstance(entry, Abstract):
                made = self._of_formula(entry, drivers)
            found += [(entry.id, x) for x in made]
        return tuple(found)

    def _of_formula(self, entry: Abstract, drivers: Drivers) -> Iterator[Decision]:
        """What becomes of an abstract test by the drives of it that were found, each once."""
        facts = [x for x in all_facts(self.found.answers) if x.test == entry.id]
        drives = {repr(x.drive.file.drive): x.drive for x in facts if x.drive is not None}
        scenarios = scenarios_shown(facts)
        sides = [read_side_name(x.other) for x in facts if x.relation == "open"]
        missed = {(x[0], x[2]) for x in sides if x is not None}
        return decide_formula(decisions_of(drives.values(), scenarios, self.study.asked, drivers), missed)

    @property
    def tests(self) -> tuple[str, ...]:
        """The tests by id, in order."""
        return tuple(x.id for x in self.catalogue.entries)

    @property
    def missing(self) -> tuple[str, ...]:
        """What is to be tested, and no test shows: scenarios, classes, with ``gaps`` classes of gaps."""
        return tuple(x.name for x in self.tested.missing)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """COVERED for what a test shows, else GAPS: scenarios, classes, with ``gaps`` classes of gaps.

        Classes of gaps that are proved empty are IMPOSSIBLE; UNKNOWN are those not known to be.
        """
        found = {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in self.tested.targets}
        gaps = self.tested.gaps
        if gaps.asked:
            found |= {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in gaps.targets}
            found |= dict.fromkeys(gaps.open, Verdict.UNKNOWN)
            found |= {x.name: Verdict.IMPOSSIBLE for x in gaps.empty}
        return found

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        found = [y for x in all_facts(self.found.answers) for y in (x.certificate, x.drive)]
        claims = gap_answers(self.found.answers).values() if self.tested.gaps.asked else ()
        found += [x.certificate for x in claims if isinstance(x, Covered)]
        for answer in self.gap_answers.values():
            found += [] if answer is None else [answer.certificate, *(gap.drive for gap in answer.gaps)]
        return tuple(x for x in found if x is not None)

    @property
    def exit_code(self) -> ExitCode:
        found = self.tested
        if found.contradictions:
            return ExitCode.CROSSCHECK_FAILED
        if found.doubts:
            return ExitCode.UNKNOWN
        return ExitCode.UNEXPECTED if found.missing or found.faults else ExitCode.AS_EXPECTED

    def rows(self) -> list[Row]:
        """A row for each scenario and class, and for each class of gaps that is shown or asked for."""
        verdicts, gaps = self.verdicts, self.tested.gaps
        return [
            {
                "target": x.name,
                "words": x.words,
                "sector": x.sector,
                "verdict": str(verdicts.get(x.name, Verdict.COVERED)),
                "tests": len(x.tested),
                "tested_by": ", ".join(x.tested),
                "possible_in": ", ".join(x.possible),
            }
            for x in (*self.tested.all_targets, *gaps.empty)
        ]

    def _index(self, records: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
        found = self.tested
        return {
            **self.study.question.heading,
            "view": "dense",
            "request": self.examination.request.as_data(),
            "tests": [self._test(x) for x in self.catalogue.entries],
            "targets": [_target(x) for x in found.targets],
            "gaps": self._gaps(records),
            "not_tested": list(self.missing),
            "figures": [vars(x) for x in self.figures],
            "decisions": [_decision(test, x) for test, x in self.decisions],
            "ranges": [_range(x) for x in self.spans],
            "facts": [fact for record in records.values() for fact in record["facts"]],
            "faults": _remarks(found.faults),
            "doubts": _remarks(found.doubts),
            "alike": _remarks(found.alike),
            "contradictions": _remarks(found.contradictions),
            "notes": list(self.notes),
            "seconds": round(self.seconds, 1),
        }

    def _gaps(self, records: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
        """The classes of gaps: those that tests show, or all with what shows that they are empty or not."""
        gaps = self.tested.gaps
        kept = [x for record in records.values() if (x := record.get("gaps"))]
        return {
            "asked": gaps.asked,
            "classes_in_all": gaps.total,
            "targets": [_target(x) for x in gaps.targets],
            "empty": [x.name for x in gaps.empty],
            "open": dict(gaps.open),
            "claims": [x["claim"] for x in kept if "claim" in x and gaps.asked],
            "classes": [y for x in kept if gaps.asked for y in x.get("classes", ())],
        }

    def _test(self, entry: Concrete | Abstract) -> dict[str, Any]:
        data: dict[str, Any] = {"id": entry.id, "title": entry.title}
        if isinstance(entry, Abstract):
            return data | {"formula": entry.query.text, "claims": list(entry.claims)}
        answer = next(x for x in self.concrete if x.entry == entry)
        shown = [{**vars(x), "vehicles": list(x.vehicles)} for x in answer.shown]
        return data | {
            "file": entry.place,
            "sha256": answer.sha256,
            "copy_of": entry.copy_of,
            "roles": dict(answer.roles),
            "claims": list(answer.claims),
            "dense": answer.dense,
            "shown": shown,
            "begins": dict(answer.begins),
            "fault": answer.fault,
            "why": _why(answer),
        }

    @property
    def notes(self) -> tuple[str, ...]:
        """On files that are no tests, samples that contradict themselves, drives made with other values."""
        doubted: dict[str, list[str]] = {}
        made: dict[tuple[str, ...], list[str]] = {}
        for x in self.concrete:
            for note in x.notes:
                doubted.setdefault(note, []).append(x.entry.id)
            if x.made_with:
                made.setdefault(x.made_with, []).append(x.entry.id)
        others = (
            f"made with {', '.join(those)}, and judged with what is asked for: {', '.join(tests)}"
            for those, tests in made.items()
        )
        told = (f"{', '.join(tests)}: {note}" for note, tests in doubted.items())
        return (*self.catalogue.notes, *told, *others)

    @property
    def in_force(self) -> tuple[str, ...]:
        """What was asked otherwise than by default: spec set, readings, parameters, a driver model."""
        basis = self.study.basis
        home = basis.specification
        driver = restriction_of(home.options)
        said = [] if home.set_name == "base" else [f"set {home.set_name}"]
        known = {} if driver is None else driver.options
        readings = {k: v for k, v in home.options.items() if k not in known}
        said += [f"{k} = {v}" for k, v in readings.items() if v != home.library.options[k].values[0]]
        declared = values_with(home.library, {})
        said += [f"{k} = {v} (SI)" for k, v in basis.values.items() if v != declared[k]]
        return (*said, *(() if driver is None else (str(driver),)))

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Which test shows which scenario and gap, how many tests each class has; then all tests, small."""
        yield "matrix", picture(report.draw_matrix(self.tests, self.tested, self.in_force))
        for k, page in enumerate(draw_tests(self._drawn()), 1):
            yield f"tests-{k}", picture(page)

    def _drawn(self) -> list[Drawn]:
        """The tests to be drawn, by the first scenario that each shows."""
        targets = [x for x in self.tested.targets if kind_of(x.name) == SCENARIOS]
        groups = {
            test: f"{number_in(x.name)} {x.words}"
            for x in reversed(targets)
            for test in (*x.possible, *x.tested)
        }
        runs = {x.test: x.drive for x in all_facts(self.found.answers) if x.relation == "runs"}
        courses: dict[str, Courses | None] = {}
        for entry in self.catalogue.entries:
            if isinstance(entry, Concrete):
                courses[entry.id] = courses_of(entry)
            elif (drive := runs.get(entry.id)) is not None:
                courses[entry.id] = of_drive(drive.file)
        drawn = [
            Drawn(test, groups.get(test, "no scenario"), x) for test, x in courses.items() if x is not None
        ]
        order = [*dict.fromkeys(f"{number_in(x.name)} {x.words}" for x in targets), "no scenario"]
        return sorted(drawn, key=lambda x: order.index(x.group))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """A table for a spreadsheet, a report for CI, and the picture."""
        written = {
            "matrix.csv": self.to_csv().encode(),
            "figures.csv": report.figures_csv(self.figures).encode(),
            "drivers.csv": decisions.as_csv(self.decisions).encode(),
            "junit.xml": self.to_junit().encode(),
        }
        return written | drawn(self.pictures() if pictures else {})

    def to_csv(self) -> str:
        """A row a test, a column a scenario, class, gap: x shown or implied, o by some drives of the test."""
        return report.as_csv(self.tests, self.tested, self.in_force)

    def to_junit(self) -> str:
        """Tests that fail where they are not what they claim, and what is to be tested, as JUnit's XML."""
        return report.as_junit(self.tests, self.tested, self.in_force)

    def __str__(self) -> str:
        drivers = decisions.as_lines(self.decisions)
        told = report.as_text(len(self.tests), self.tested, self.notes, self.figures, drivers)
        ranges = report.range_lines(self.spans, self.study.basis.horizon)
        return "\n".join([*ranges, told])

    def complete(
        self,
        out: str | Path,
        objective: Objective = "smooth",
        spread: int = 1,
        formats: str | Iterable[str] = (),
        jobs: Jobs = None,
        progress: Progress | None = None,
        specs: Iterable[str | Path] = (),
    ) -> Completed:
        """Write a drive for all that no test shows into a folder, as tests with a ``catalogue.toml``.

        ``objective``: what drives are to be like, as for ``witness``. ``spread``: until each class has so
        many tests, or each scenario where there are no classes, further drives that begin far from all that
        it has (``far.distance``). ``formats``: for which other tools they are written too, as by ``export``,
        each with an entry; ``specs``: specification files that these need. Raises ``InputError``,
        ``UsageError``.
        """
        one_of("objective", objective, Objective)
        if spread < 1:
            raise UsageError(f"spread={spread}: write how many tests each class is to have, 1 or more")
        asked = self.study.asked
        basis = replace(self.study.basis, objective=objective)
        made = complete(basis, asked, self.missing, self._known(), spread, jobs, progress)
        words = {x.name: x.words for x in (*self.tested.all_targets, *self.tested.gaps.empty)}
        like = "" if objective == "smooth" else f", {objective}"
        titles = {
            x.name: words[x.target] + like + (", far from the others" if x.apart is not None else "")
            for x in made
        }
        return write_completions(Path(out), made, titles, asked, formats, specs)

    def _known(self) -> Known:
        """What is known of targets before drives are looked for."""
        begins = {x.name: [y.begins for y in self.concrete if x.name in y.names] for x in self.tested.targets}
        copies = {x.entry.id for x in self.concrete if x.entry.copy_of in self.tests}
        tests = {x.name: len({*x.tested} - copies) for x in self.tested.targets}
        gaps = {name: x for name, x in self.gap_answers.items() if x is not None and x.gaps}
        return Known(begins, tests, gaps)


def _decision(test: str, decision: Decision) -> dict[str, Any]:
    return {
        "test": test,
        **vars(decision),
        "vehicles": list(decision.vehicles),
        "start": dict(decision.start),
    }


def _range(span: Span) -> dict[str, Any]:
    return {
        "target": span.target,
        "term": span.term,
        "tested": list(span.tested),
        "reached": list(span.reached),
        "untested": [list(part) for part in span.untested],
        "share": round(span.share, 4),
        "beyond": list(span.beyond),
    }


def _target(target: Target) -> dict[str, Any]:
    return {
        "name": target.name,
        "words": target.words,
        "sector": target.sector,
        "tested": list(target.tested),
        "possible": list(target.possible),
        "covered": {name: list(bounds) for name, bounds in target.covered.items()},
    }


def _why(answer: ConcreteAnswer) -> dict[str, Any] | None:
    if answer.why is None:
        return None
    sets = {name: [*held] for name, held in answer.why.sets.items()}
    return {**vars(answer.why), "vehicles": [*answer.why.vehicles], "sets": sets}


def _remarks(remarks: Iterable[Remark]) -> list[dict[str, Any]]:
    return [{"tests": list(x.tests), "told": x.told} for x in remarks]


def catalogue(
    *paths: str | Path,
    among: Among = None,
    using: Definitions | None = None,
    classes: bool = True,
    gaps: bool = False,
    explore: bool = False,
    roles: Look = "fixed",
    lanes: Look = "fixed",
    start: Look = "fixed",
    near: float = NEAR,
    preventable: str | None = None,
    unpreventable: str | None = None,
    drivers: Iterable[str] | None = None,
    vehicles: Vehicles = None,
    effort: float = 60.0,
    timeout: float | None = None,
    out: str | Path | None = None,
    jobs: Jobs = None,
    progress: Progress | None = None,
    say: Say | None = None,
) -> Catalogued:
    """Which scenarios and classes the tests in folders and files show, and which nobody tests.

    The first spec set of ``using`` is asked about; of further ones there are figures. ``classes``: whether
    scenarios are divided into classes (``classify``), which need whole rows of the table in ``among``;
    ``gaps``: whether each class of gaps that there is (``coverage``) is to be tested too; ``explore``: also
    how far drives of each class that is tested can go, and which part of that nobody tests. ``roles``,
    ``lanes``, ``start``: whether those are looked at that a test fixes, or "any". ``near``: how far apart
    tests that say the same may begin, in m and m/s. ``preventable``, ``unpreventable``: as for ``witness``;
    gaps are then a question for ``coverage``. ``drivers``: the driver models that are asked what becomes of
    the scenarios that tests show, all where None. ``out``: a folder for evidence on abstract tests, gaps
    and ranges. Raises ``InputError``, ``TextError``, ``UsageError``.
    """
    begun = time.monotonic()
    plain = using or load()
    wanted = restricted(plain, preventable, unpreventable, among)
    models = tuple(MODELS if drivers is None else drivers)
    request = Request(
        tuple(map(str, paths)), wanted.sets, classes, gaps, explore, roles, lanes, start, float(near), models
    )
    basis = basis_of(replace(wanted, sets=wanted.sets[:1]), effort, timeout, vehicles)
    numbers = wanted.among(among) or numbers_of(wanted.specification)
    asked = drivers_of(wanted, models)
    made = examine(request, basis, numbers, plain.specification, asked, jobs, progress)
    return Catalogued.asked(
        made.study, out, jobs, progress, say, more=lambda: {"examination": made}, begun=begun
    )
