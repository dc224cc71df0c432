"""What a catalogue of tests shows, what it misses, and drives for what is missing."""

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Any, ClassVar, Literal, TypeAlias

from roadproof.analysis.catalogue.asked import Asked
from roadproof.analysis.catalogue.completing import Completion, complete
from roadproof.analysis.catalogue.entries import Abstract, Catalogue, Concrete
from roadproof.analysis.catalogue.meaning import Facts, Meanings
from roadproof.analysis.catalogue.reading import FILE_NAME, read_catalogue
from roadproof.analysis.catalogue.showing import ConcreteAnswer, Freedom, show
from roadproof.analysis.catalogue.tested import Remark, Tested, all_facts, targets_of, tested
from roadproof.analysis.catalogue.writing import catalogue_text
from roadproof.analysis.classify.classes import plan_of
from roadproof.analysis.classify.divide import divide
from roadproof.api.answer import Picture, Row, picture
from roadproof.api.definitions import Among, Definitions, load
from roadproof.api.settings import basis_of, one_of
from roadproof.api.studied import Studied, drawn
from roadproof.errors import UsageError
from roadproof.evidence.kinds import Evidence
from roadproof.files import hold_folder, json_bytes, write_whole
from roadproof.hands import Jobs
from roadproof.report import catalogue as report
from roadproof.spec.scenarios import numbers_of
from roadproof.study import pool
from roadproof.study.pool import Progress, Say
from roadproof.verdict import ExitCode, Verdict

_Look: TypeAlias = Literal["fixed", "any"]
NEAR = 0.5
BATCH = 20


@dataclass(frozen=True, repr=False)
class Catalogued(Studied[Meanings, Facts]):
    """What tests show and mean. ``near``: how far apart tests that say the same may begin (m, m/s)."""

    concrete: tuple[ConcreteAnswer, ...] = ()
    catalogue: Catalogue = field(default_factory=lambda: Catalogue(()))
    near: float = NEAR
    pieces: ClassVar[str] = "questions about abstract tests"

    @cached_property
    def tested(self) -> Tested:
        """What is tested, what is missing, and what is to be said of tests."""
        facts = all_facts(self.found.answers)
        words = targets_of(self.study.asked)
        return tested(self.study.asked, self.concrete, self.study.entries, facts, words, self.near)

    @property
    def tests(self) -> tuple[str, ...]:
        """The tests by id, in order."""
        return tuple(x.id for x in self.catalogue.entries)

    @property
    def missing(self) -> tuple[str, ...]:
        """The scenarios and classes that no test shows."""
        return tuple(x.name for x in self.tested.missing)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """COVERED for each scenario and class that a test shows, else GAPS."""
        return {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in self.tested.targets}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        found = (y for x in all_facts(self.found.answers) for y in (x.certificate, x.drive))
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
        """A row for each scenario and class."""
        return [
            {
                "target": x.name,
                "words": x.words,
                "sector": x.sector,
                "verdict": str(self.verdicts[x.name]),
                "tests": len(x.tested),
                "tested_by": ", ".join(x.tested),
                "possible_in": ", ".join(x.possible),
            }
            for x in self.tested.targets
        ]

    def _index(self, records: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
        found = self.tested
        return {
            **self.study.question.heading,
            "view": "dense",
            "tests": [self._test(x) for x in self.catalogue.entries],
            "targets": [
                {
                    "name": x.name,
                    "words": x.words,
                    "sector": x.sector,
                    "tested": list(x.tested),
                    "possible": list(x.possible),
                    "covered": {name: list(bounds) for name, bounds in x.covered.items()},
                }
                for x in found.targets
            ],
            "not_tested": list(self.missing),
            "facts": [fact for record in records.values() for fact in record["facts"]],
            "faults": _remarks(found.faults),
            "doubts": _remarks(found.doubts),
            "alike": _remarks(found.alike),
            "contradictions": _remarks(found.contradictions),
            "notes": list(self.catalogue.notes),
            "seconds": round(self.seconds, 1),
        }

    def _test(self, entry: Concrete | Abstract) -> dict[str, Any]:
        data: dict[str, Any] = {"id": entry.id, "title": entry.title}
        if isinstance(entry, Abstract):
            return data | {"formula": entry.query.text, "claims": list(entry.claims)}
        answer = next(x for x in self.concrete if x.entry == entry)
        shown = [{**vars(x), "vehicles": list(x.vehicles)} for x in answer.shown]
        return data | {
            "file": entry.place,
            "claims": list(answer.claims),
            "dense": answer.dense,
            "shown": shown,
            "begins": dict(answer.begins),
            "fault": answer.fault,
        }

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Which test shows which scenario, and how many tests each class has."""
        yield "matrix", picture(report.draw_matrix(self.tests, self.tested))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """A table for a spreadsheet, a report for CI, and the picture."""
        written = {"matrix.csv": self.to_csv().encode(), "junit.xml": self.to_junit().encode()}
        return written | drawn(self.pictures() if pictures else {})

    def to_csv(self) -> str:
        """A row a test, a column a scenario or class: x shown or implied, o by some drives of the test."""
        return report.as_csv(self.tests, self.tested)

    def to_junit(self) -> str:
        """Tests that fail where they are not what they claim, and what is to be tested, as JUnit's XML."""
        return report.as_junit(self.tests, self.tested)

    def __str__(self) -> str:
        return report.as_text(len(self.tests), self.tested, self.catalogue.notes)

    def complete(self, out: str | Path, jobs: Jobs = None, progress: Progress | None = None) -> "Completed":
        """Write a drive for all that no test shows into a folder, as tests with a ``catalogue.toml``.

        Raises ``InputError``.
        """
        asked, folder = self.study.asked, Path(out)
        made = complete(self.study.basis, asked, self.missing, jobs, progress)
        words = targets_of(asked)
        drives = {name: x.drive for name, x in made.items() if x.drive is not None}
        with hold_folder(folder):
            for name, drive in drives.items():
                write_whole(folder / f"{name}.json", json_bytes(drive.as_data()))
            if drives:
                listed = {name: words[name] for name in drives}
                write_whole(folder / FILE_NAME, catalogue_text(listed).encode())
        return Completed(folder, tuple(made.values()))


@dataclass(frozen=True)
class Completed:
    """The drives that were written into ``folder``, and what was proved empty or not found."""

    folder: Path
    completions: tuple[Completion, ...]

    def __str__(self) -> str:
        drives = sum(x.drive is not None for x in self.completions)
        lines = (
            [f"{drives} drive{'s' * (drives != 1)} for what was not tested in {self.folder}"]
            if drives
            else []
        )
        lines += [f"{x.target}: nothing shows it: that is proved" for x in self.completions if x.empty]
        lines += [f"{x.target}: {x.reason}" for x in self.completions if not (x.drive or x.empty)]
        return "\n".join(lines) or "nothing was missing"


def _remarks(remarks: Iterable[Remark]) -> list[dict[str, Any]]:
    return [{"tests": list(x.tests), "told": x.told} for x in remarks]


def catalogue(
    *paths: str | Path,
    among: Among = None,
    using: Definitions | None = None,
    classes: bool = True,
    roles: _Look = "fixed",
    lanes: _Look = "fixed",
    start: _Look = "fixed",
    near: float = NEAR,
    effort: float = 60.0,
    timeout: float | None = None,
    out: str | Path | None = None,
    jobs: Jobs = None,
    progress: Progress | None = None,
    say: Say | None = None,
) -> Catalogued:
    """Which scenarios and classes the tests in folders and files show, and which nobody tests.

    ``classes``: whether scenarios are divided into classes (``classify``), which need whole rows of the table
    in ``among``; ``roles``, ``lanes``, ``start``: whether those are looked at that a test fixes, or "any".
    ``near``: how far apart tests that say the same may begin, in m and m/s. ``out``: a folder for evidence on
    abstract tests. Raises ``InputError``, ``TextError``, ``UsageError``.
    """
    begun = time.monotonic()
    home = using or load()
    for name, choice in (("roles", roles), ("lanes", lanes), ("start", start)):
        one_of(name, choice, _Look)
    if not near >= 0:
        raise UsageError(f"near={near}: write a number, 0 or more")
    tests = read_catalogue(paths, home.alone)
    numbers = home.among(among) or numbers_of(home.alone)
    basis = basis_of(home, effort, timeout)
    made = None
    if classes:
        division = divide(basis, plan_of(home.alone, numbers), jobs, progress, in_few_words=False)
        if division.cut_off:
            told = "; ".join(x.reason for x in division.doubts)
            raise UsageError(f"which classes there are is in doubt ({told}): give more time, or no classes")
        made = division.classes
    asked = Asked(home.alone, numbers, made, home.all_values())
    abstract = tuple(x for x in tests.entries if isinstance(x, Abstract))
    concrete = tuple(x for x in tests.entries if isinstance(x, Concrete))
    freedom = Freedom(roles == "any", lanes == "any", start == "any")
    answers = _shown(concrete, asked, freedom, jobs, progress)
    more = {"concrete": answers, "catalogue": tests, "near": near}
    study = Meanings(basis, abstract, asked)
    return Catalogued.asked(study, out, jobs, progress, say, more=lambda: more, begun=begun)


def _shown(
    entries: Sequence[Concrete], asked: Asked, freedom: Freedom, jobs: Jobs, progress: Progress | None
) -> tuple[ConcreteAnswer, ...]:
    batches = [entries[k : k + BATCH] for k in range(0, len(entries), BATCH)]
    done = pool.work(partial(_batch, asked, freedom), batches, jobs, None, progress, "batches of tests")
    return tuple(answer for answers in pool.in_order(done) for answer in answers)


def _batch(asked: Asked, freedom: Freedom, entries: Sequence[Concrete]) -> list[ConcreteAnswer]:
    return [show(entry, asked, freedom) for entry in entries]
