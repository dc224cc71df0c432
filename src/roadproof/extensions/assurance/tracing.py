"""Links requirements to evidence: ``roadproof trace`` and ``roadproof.requirements``."""

import os
from collections import Counter
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.errors import InputError
from roadproof.evidence.codec import read, write
from roadproof.evidence.finding import Finding
from roadproof.evidence.heading import heading
from roadproof.evidence.strict import LARGEST_INDEX, JsonObject, read_json
from roadproof.extensions.assurance.answers.trace import SCHEMA, LinkState, TraceData
from roadproof.extensions.assurance.answers.trace_changes import TraceChangesData
from roadproof.extensions.assurance.build_results.requirements import requirement_cases
from roadproof.extensions.assurance.keywords import RequirementsKeywords
from roadproof.extensions.assurance.requirements import report
from roadproof.extensions.assurance.requirements.changes import changes_between, counts_between
from roadproof.extensions.assurance.requirements.checked_evidence import read_findings
from roadproof.extensions.assurance.requirements.fingerprints import (
    TraceContext,
    lock_data,
    lock_path,
    read_lock,
)
from roadproof.extensions.assurance.requirements.requirement import RequirementSet
from roadproof.extensions.assurance.requirements.sources import read_requirements
from roadproof.extensions.assurance.requirements.states import States, Targets, read_targets, states_of
from roadproof.extensions.assurance.requirements.write_reqif import as_reqif
from roadproof.extensions.assurance.settings import Requirements as Settings
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.checking import take_over
from roadproof.frontends.api.definitions import values_of
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.sheet import as_csv, as_rows
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import values_with
from roadproof.library.diagnose import checked_library
from roadproof.library.specification import Library
from roadproof.runtime.files import make_folder, write_atomic, write_json
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode
from roadproof.world.models import load_vehicle


@dataclass(frozen=True, repr=False)
class Traced(Table, BuildResult):
    """Requirements with the evidence for each; ``answer``: the data of ``--json``.

    ``given``: the requirements as read. ``lock``: the lock file, with what links rested on when they were
    accepted.
    """

    answer: TraceData
    given: RequirementSet
    library: Library
    lock: Path
    accepted: bool = False
    command: ClassVar[str] = "trace"

    def cases(self) -> Iterator[Case]:
        return requirement_cases(self.answer)

    @property
    def states(self) -> dict[str, LinkState]:
        """The state of each requirement, by its id."""
        return {x.id: x.state for x in self.answer.requirements}

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: 10 where a requirement is not shown or evidence is rejected, 20 where one is
        undecided.
        """
        return self.answer.exit_code

    def as_data(self) -> JsonObject:
        """Return the plain data of ``--json``."""
        return write(self.answer)

    def rows(self) -> list[Row]:
        """Return a row for each link, and for each requirement without links."""
        return as_rows(report.sheet_of(self.answer))

    def save(self, folder: str | Path) -> Path:
        """Write trace.html, trace.csv, trace.md and trace.json into a folder. Raises ``InputError``."""
        from roadproof.extensions.pages.reporting import page

        home = Path(folder)
        make_folder(home)
        write_json(home / "trace.json", self.as_data())
        write_atomic(home / "trace.csv", as_csv(report.sheet_of(self.answer)).encode())
        write_atomic(home / "trace.md", report.as_markdown(self.answer).encode())
        page(home / "trace.json", out=home / "trace.html", title=f"Requirements: {self.given.file.name}")
        return home

    def save_reqif(self, file: str | Path) -> Path:
        """Write the requirements with their states and links as ReqIF 1.2. Raises ``InputError``."""
        path = Path(file)
        fixed = os.environ.get("SOURCE_DATE_EPOCH", "")
        changed = int(fixed) if fixed.isdecimal() else int(self.given.file.stat().st_mtime)
        when = datetime.fromtimestamp(changed, UTC)
        identifiers = {x.id: x.identifier for x in self.given.requirements}
        write_atomic(path, as_reqif(self.answer, self.given.file.stem, when, identifiers))
        return path

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {state}" for state, n in Counter(self.states.values()).items())
        return f"<Traced: {counts}>"

    def __str__(self) -> str:
        lines = report.as_lines(self.answer)
        if self.accepted:
            lines.append(f"accepted: {self.lock} says what every link rests on")
        elif not self.answer.locked:
            lines.append(
                "no link was ever accepted, so none is stale by what it rests on; --accept writes a lock file"
            )
        return "\n".join(lines)


@takes(Settings)
def requirements(file: str | Path, **options: Unpack[RequirementsKeywords]) -> Traced:
    """Check which requirements of a file are shown by evidence, which is checked again.

    ``file``: ``requirements.toml``, a .reqif or .sdoc file, or a folder of Doorstop. ``accept``: write the
    lock file beside it, which records what each link rests on. Raises ``InputError``, ``MissingSolverError``.
    """
    question = Settings.of(options)
    path = Path(file)
    requirement_set = read_requirements(path).with_specs(map(Path, question.specs))
    settings = requirement_set.settings
    library = checked_library(settings.specs)
    home = library.select(settings.set_name, settings.options)
    values = values_of(library, settings.parameters, f"{path}, trace, parameters: ")
    context = TraceContext(
        home,
        path.parent,
        values_with(library, values),
        {name: load_vehicle(model) for name, model in settings.vehicles.items()},
    )
    targets = read_targets(requirement_set, context)
    lock = lock_path(path)
    locked = read_lock(lock)
    evidence = read_findings(_findings(requirement_set, targets, question), settings.evidence_specs, home)
    states = states_of(requirement_set, targets, evidence, context, locked)
    if question.accept:
        write_json(lock, lock_data(states.rests_on))
        locked = dict(states.rests_on)
        states = states_of(requirement_set, targets, evidence, context, locked)
    answer = _answer(requirement_set, states, context, locked is not None)
    return Traced(answer, requirement_set, library, lock, question.accept)


def _findings(requirement_set: RequirementSet, targets: Targets, question: Settings) -> tuple[Finding, ...]:
    """Check the evidence of a trace, and the files that links name; return the findings.

    Missing files are skipped: their links have no evidence.
    """
    folder, paths = requirement_set.file.parent, [*requirement_set.settings.evidence]
    named = [folder / x.link.target for y in targets.values() for x in y if x.link.kind == "evidence"]
    covered = [x.resolve() for x in paths]
    beside = [x for x in named if not any(y == x.resolve() or y in x.resolve().parents for y in covered)]
    there = dict.fromkeys(x for x in (*paths, *beside) if x.is_file() or _has_evidence(x))
    if not there:
        return ()
    keywords = CheckKeywords(
        solver=question.solver,
        specs=requirement_set.settings.evidence_specs,
        jobs=question.jobs,
        progress=question.progress,
    )
    return take_over(*there, **keywords).findings


def _has_evidence(folder: Path) -> bool:
    return folder.is_dir() and next(folder.rglob("*.json"), None) is not None


def _answer(
    requirement_set: RequirementSet, states: States, context: TraceContext, locked: bool
) -> TraceData:
    library = context.home.library
    absent = [x for x in requirement_set.settings.evidence if not (x.is_file() or _has_evidence(x))]
    return TraceData(
        **heading(SCHEMA, library),
        file=str(requirement_set.file),
        set=context.home.set_name,
        options=context.home.options,
        parameters={name: str(value) for name, value in context.values.items()},
        specs=tuple(map(str, requirement_set.settings.specs)),
        locked=locked,
        requirements=states.requirements,
        unlinked=tuple(x.as_linked for x in states.unlinked),
        notes=(*requirement_set.notes, *(f"{x} holds no evidence yet" for x in absent)),
    )


@dataclass(frozen=True, repr=False)
class TraceChanges(Table):
    """The changes between two states of requirements."""

    answer: TraceChangesData

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: 10 where something got worse or was removed, else 0."""
        return self.answer.exit_code

    def as_data(self) -> JsonObject:
        """Return the plain data of ``--json``."""
        return write(self.answer)

    def rows(self) -> list[Row]:
        """Return a row for each change."""
        return as_rows(report.changes_sheet(self.answer))

    def __repr__(self) -> str:
        return f"<TraceChanges: {len(self.answer.changes)}>"

    def __str__(self) -> str:
        return "\n".join(report.changes_lines(self.answer))


def requirement_changes(before: str | Path, after: str | Path) -> TraceChanges:
    """Return the changes between two answers of ``requirements``, both saved as JSON. Raises
    ``InputError``.
    """
    old, new = (_saved(Path(x)) for x in (before, after))
    return TraceChanges(
        TraceChangesData(
            roadproof=new.roadproof,
            library=new.library,
            before=str(before),
            after=str(after),
            changes=changes_between(old, new),
            counts=counts_between(old, new),
        )
    )


def _saved(path: Path) -> TraceData:
    content = read_json(path, LARGEST_INDEX)
    if not isinstance(content, dict) or content.get("schema") != SCHEMA:
        raise InputError(f"{path} is no answer of trace: name a trace.json, or a file of trace --json")
    return read(TraceData, content, str(path))
