"""Evidence checked again, without the programs that made it."""

import pickle
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, Unpack

from roadproof.engines.prove.properties import find_label
from roadproof.engines.solve.smt import Satisfiability as SolverAnswer
from roadproof.engines.solve.smt import check_sat
from roadproof.errors import RoadproofError, UsageError
from roadproof.evidence.answer import undecided
from roadproof.evidence.checking import Checker
from roadproof.evidence.codec import write
from roadproof.evidence.files import files_of
from roadproof.evidence.finding import Acceptance, Finding, SecondOpinion, exit_code, summary
from roadproof.evidence.heading import heading
from roadproof.evidence.kernels import KernelName
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.none_within_check import Derived
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api import check_data
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.settings import work_of
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.question_cases import finding_cases
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Check
from roadproof.library.loading import load_library
from roadproof.library.specification import Library, read_specification
from roadproof.library.words import legend, words_named_in
from roadproof.questions.checking import QuestionFolder, folders_in, read_folder
from roadproof.questions.foreign_code import all_foreign_code
from roadproof.questions.question import QUESTION
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime import pool
from roadproof.runtime.budget import Effort
from roadproof.runtime.cache import evict_old, load_bytes, store_bytes
from roadproof.runtime.executors import Jobs
from roadproof.runtime.package_data import program_digest
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.evidence.kernels import KernelAnswer, KernelQuestion
    from roadproof.frontends.api.question_answers import QuestionAnswers

Solver: TypeAlias = Literal["z3", "cvc5"]
Kernel: TypeAlias = KernelName
_Given: TypeAlias = Sequence[tuple[Path, tuple[Path, ...]]]


LISTS = ("prove", "witness")
"""The kinds of questions whose views are lists of their claims."""
CHECKED = "checked"
"""The folder of the cache with findings on files that were accepted."""


@dataclass(frozen=True, repr=False)
class CheckReport(Table, BuildResult):
    """A finding for each claim, with the definitions of ``library``.

    ``solver`` is who was asked about certificates. ``specs``: specification files that lie beside the
    evidence, and were read on top of it. ``kernel``: what Coq needed and stands on, where it was asked.
    ``not_checked``: by folder, the files in it that nothing is compared with. ``views``: by folder, what its
    accepted answers show together, where that is more than the claims. ``strict``: whether answers without
    evidence make the exit code 20.
    """

    findings: tuple[Finding, ...]
    solver: Solver | Kernel
    library: Library
    specs: tuple[Path, ...] = ()
    kernel: "KernelAnswer | None" = None
    not_checked: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    views: Mapping[str, "QuestionAnswers[Any]"] = field(default_factory=dict)
    strict: bool = False
    command: ClassVar[str] = "check"

    def cases(self) -> Iterator[Case]:
        return finding_cases(self.findings, self.strict)

    @property
    def accepted(self) -> bool:
        """Return whether there are claims, and every one is accepted."""
        return bool(self.findings) and all(x.outcome is Acceptance.ACCEPTED for x in self.findings)

    @property
    def counts(self) -> dict[Acceptance, int]:
        """Return how many claims came out how."""
        return dict(Counter(x.outcome for x in self.findings))

    @property
    def exit_code(self) -> ExitCode:
        return exit_code(self.findings, self.strict)

    def as_data(self) -> JsonObject:
        """Return the plain data of ``--json``."""
        answer = check_data.CheckData(
            **heading(check_data.SCHEMA, self.library),
            solver=self.solver,
            kernel=None if self.kernel is None else self.kernel.data,
            findings=tuple(
                check_data.ClaimFinding(**vars(x), accepted=x.outcome is Acceptance.ACCEPTED)
                for x in self.findings
            ),
            not_checked=self.not_checked,
        )
        return write(answer)

    def rows(self) -> list[Row]:
        """A row for each claim."""
        return [
            {
                "claim": " ".join(x.claim.split()),
                "verdict": x.verdict,
                "outcome": str(x.outcome),
                "reason": x.reason,
                "where": x.where,
            }
            for x in self.findings
        ]

    def __repr__(self) -> str:
        return f"<Checked: {', '.join(f'{n} {outcome}' for outcome, n in self.counts.items())}>"

    def __str__(self) -> str:
        lines = [f"read with {path}" for path in self.specs]
        lines += map(str, self.findings)
        words = words_named_in(self.library.select(), (x.claim for x in self.findings))
        lines += [f"  {line}" for line in legend(words)]
        kernel = [] if self.kernel is None else [str(self.kernel)]
        solver_name = "the extracted program" if self.solver == "extracted" else self.solver
        lines += [f"what {folder} shows ({x.question.kind}):\n{x}" for folder, x in self.views.items()]
        lines += [f"not checked in {folder}: {', '.join(x)}" for folder, x in self.not_checked.items()]
        return "\n".join([*lines, summary(self.findings, solver_name), *kernel])


@takes(Check)
def check(*paths: str | Path, **options: Unpack[CheckKeywords]) -> CheckReport:
    """Check certificates, drive files and folders of them, as ``roadproof check`` does.

    ``solver``: z3 or cvc5; ``specs``: specification files that the claims were made with. ``kernel`` "coq":
    certificates are put to Coq instead, drives too, and both accepted by its word alone; "extracted": to the
    program that Coq made of its checkers. ``strict``: the exit
    code is 20 where an answer has no evidence, such as UNKNOWN or NONE-WITHIN. Raises
    ``InputError`` for a path that holds nothing, ``MissingSolverError``.
    """
    return _check(paths, Check.of(options), False, {})


def take_over(
    *paths: str | Path, folders: Sequence[QuestionFolder] = (), **options: Unpack[CheckKeywords]
) -> CheckReport:
    """Check evidence, but take over files that this version has accepted with these bytes before.

    ``folders``: those among the paths that were read already.
    """
    return _check(paths, Check.of(options), True, {x.folder: x for x in folders})


def _check(
    paths: Sequence[str | Path], settings: Check, takes_over: bool, known: Mapping[Path, QuestionFolder]
) -> CheckReport:
    if not paths:
        raise UsageError("check() needs at least one file or folder of evidence")
    if settings.kernel is None:
        # A solver that is missing is said once, before any work.
        check_sat("(set-logic QF_UF)(check-sat)", settings.solver)
    else:
        from roadproof.evidence.kernels import kernels

        kernels().require_installed(settings.kernel)
    named = tuple(Path(x) for x in settings.specs)
    library = load_library(named)
    there = _Evidence.read([Path(x) for x in paths], named, known)
    given = there.given
    answered, opinions = (
        (None, {}) if settings.kernel is None else _put_to_kernel(settings.kernel, given, settings)
    )
    work = [_FileJob(path, beside, opinions.get(str(path)), takes_over) for path, beside in given]
    judge = partial(_examine, settings.solver, work_of(settings))
    answers = pool.in_order(
        pool.work(judge, work, settings.jobs, _unknown_finding, settings.progress, "files")
    )
    by_path = {path: finding for (path, _), finding in zip(given, answers, strict=True)}
    beside = tuple(dict.fromkeys(path for x in there.folders for path in x.specs))
    findings = [*there.problems, *(by_path[file] for file in there.alone)]
    left: dict[str, tuple[str, ...]] = {}
    views: dict[str, QuestionAnswers[Any]] = {}
    for x in there.folders:
        shown = {name: x.finding(name, by_path[file], takes_over) for file, name in x.files.items()}
        findings += [*shown.values(), *x.undecided, *x.problems]
        if x.question.kind not in LISTS:
            views[str(x.folder)] = _accepted_view(x, shown)
        tables, others = _tables(x)
        findings += tables
        if others:
            left[str(x.folder)] = others
    evict_old(CHECKED)
    solver = settings.kernel or settings.solver
    return CheckReport(tuple(findings), solver, library, beside, answered, left, views, settings.strict)


@dataclass(frozen=True)
class _Evidence:
    """Evidence in files and folders: ``folders`` of answers, and files ``alone``, read with ``specs``.

    ``problems``: links, and folders whose question cannot be read.
    """

    folders: tuple[QuestionFolder, ...]
    alone: tuple[Path, ...]
    problems: tuple[Finding, ...]
    specs: tuple[Path, ...]

    @staticmethod
    def read(
        paths: Sequence[Path], specs: tuple[Path, ...], known: Mapping[Path, QuestionFolder]
    ) -> "_Evidence":
        """Raises ``InputError`` for a path that is not there or holds nothing; ``known``: folders read."""
        places = folders_in(paths)
        folders: list[QuestionFolder] = []
        damaged: list[Finding] = []
        for place in places:
            try:
                folders.append(known[place] if place in known else read_folder(place, specs))
            except RoadproofError as error:
                where = str(place / QUESTION)
                damaged.append(Finding(where, "", Acceptance.REJECTED, ReasonKind.TOLD(error)))
        alone, links = files_of(paths, places)
        return _Evidence(tuple(folders), tuple(alone), (*damaged, *links), specs)

    @property
    def given(self) -> _Given:
        """Every file, with the specification files that it is read with."""
        alone = [(file, self.specs) for file in self.alone]
        answered = ((x, file, name) for x in self.folders for file, name in x.files.items())
        return [*alone, *((file, (*self.specs, *x.specs_of(name))) for x, file, name in answered)]


def _accepted_view(folder: QuestionFolder, shown: Mapping[str, Finding]) -> "QuestionAnswers[Any]":
    """The answers of a folder, those in doubt whose evidence is not accepted."""
    from roadproof.frontends.api.rebuilding import rebuilt  # which takes long to import

    refused = {n: x.reason for n, x in shown.items() if x.outcome is not Acceptance.ACCEPTED}
    doubted = {name: undecided(folder.answers[name].claim, reason) for name, reason in refused.items()}
    return rebuilt(replace(folder, answers={**folder.answers, **doubted}))


def _tables(folder: QuestionFolder) -> tuple[list[Finding], tuple[str, ...]]:
    """A finding for each table of a folder that its answers do not make; and what is not compared."""
    from roadproof.frontends.api.rebuilding import rebuilt  # what makes tables takes long to import

    others = {x: folder.folder / x for x in folder.others}
    if not any(x.endswith((".csv", ".dot", ".xml")) for x in others):
        return [], folder.others
    made = rebuilt(folder).files(False)
    wrong = [x for x, content in made.items() if x in others and others[x].read_bytes() != content]
    rejected = [Finding(str(others[x]), "", Acceptance.REJECTED, ReasonKind.OTHER_TABLE()) for x in wrong]
    return rejected, tuple(x for x in folder.others if x not in made)


def _put_to_kernel(
    kernel: Kernel, given: _Given, settings: Check
) -> tuple["KernelAnswer", dict[str, SecondOpinion]]:
    """Return the rulings of a kernel on all files, and on each by its path."""
    from roadproof.evidence.kernels import kernels, second_opinion

    answered = kernels().check(_kernel_questions(given), settings.jobs, settings.progress, kernel)
    names = [(str(path), name) for path, name in kernels().names_of(path for path, _ in given).items()]
    rulings = answered.rulings
    return answered, {path: second_opinion(rulings[name]) for path, name in names if name in rulings}


@dataclass(frozen=True)
class Sources:
    """Files that were written for a kernel: ``count`` of questions, and why others have no file, by path."""

    count: int
    reasons: Mapping[Path, str]


def write_sources(
    *paths: str | Path,
    folder: str | Path,
    specs: Iterable[str | Path] = (),
    jobs: Jobs = None,
    kernel: Kernel = "coq",
) -> Sources:
    """Write what would be put to a kernel for each certificate; nothing is checked.

    Raises ``InputError`` for a path that holds nothing, and where it cannot be written.
    """
    from roadproof.evidence.kernels import kernels

    named = tuple(Path(x) for x in specs)
    given = _Evidence.read([Path(x) for x in paths], named, {}).given
    questions = _kernel_questions(given)
    reasons = kernels().write(questions, Path(folder), jobs, kernel)
    by_name = {name: path for path, name in kernels().names_of(path for path, _ in given).items()}
    return Sources(len(questions) - len(reasons), {by_name[x]: reason for x, reason in reasons.items()})


def _kernel_questions(given: _Given) -> list["KernelQuestion"]:
    from roadproof.evidence.kernels import KernelQuestion, kernels

    names = kernels().names_of(path for path, _ in given)
    return [KernelQuestion(names[path], path, specs) for path, specs in given]


@dataclass(frozen=True)
class _FileJob:
    """A file with the specification files that it is read with, and what Coq said of it."""

    path: Path
    specs: tuple[Path, ...]
    opinion: SecondOpinion | None
    takes_over: bool = False

    def key(self, solver: str) -> bytes:
        """Return a key of all that the finding depends on: bytes of files, solver, program and packages."""
        texts = (read_specification(x).text.encode() for x in self.specs)
        digests = (sha256(x).hexdigest() for x in (self.path.read_bytes(), *texts))
        packages = (y for x in all_foreign_code() for y in x)
        return "|".join((solver, program_digest(), *digests, *packages)).encode()


def _unknown_finding(job: _FileJob, reason: Reason) -> Finding:
    """The finding on a file that nothing is known of."""
    return Finding(str(job.path), "", Acceptance.UNDECIDED, reason)


def _examine(solver: str, effort: Effort, job: _FileJob) -> Finding:
    """Check one file by what its schema says that it is."""

    def derive(file: NoneWithinFile, library: Library) -> Derived:
        from roadproof.engines.search.none_within import derive as derive_programs  # loads the encoder

        return derive_programs(file, library)

    def answer(script: str) -> SolverAnswer:
        return check_sat(script, solver, effort.meter())

    def examine() -> Finding:
        return Checker(load_library(job.specs), answer, find_label, job.opinion, derive).check(job.path)

    if job.opinion is not None or not job.path.is_file():
        return examine()
    key = job.key(solver)
    name = f"checked-{sha256(key).hexdigest()[:32]}"
    known = load_bytes(CHECKED, name, key) if job.takes_over else None
    if known is not None:
        finding: Finding = pickle.loads(known)
        return replace(finding, where=str(job.path))
    finding = examine()
    if finding.outcome is Acceptance.ACCEPTED:
        store_bytes(CHECKED, name, pickle.dumps(finding), key)
    return finding
