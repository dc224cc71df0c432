"""Many claims, each settled by itself and kept: what is asked, and what came out."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from roadproof.analysis.shipped_drives import shipped_drives
from roadproof.analysis.study.evidence_store import INDEX, EvidenceStore, Question, readings, write_index
from roadproof.analysis.study.frame import Unprepared
from roadproof.engines.prove.doubt import Cause, Doubt, Stop, doubt_of
from roadproof.engines.prove.properties import Task, find_label, name_of_claim
from roadproof.engines.prove.prover import Result
from roadproof.engines.search.settle import Settlement, in_doubt, settle, settle_bounded
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answers import proofs as kept
from roadproof.evidence.answers.proofs import SCHEMA, Claim, Index, Record
from roadproof.evidence.answers.read import index_fields
from roadproof.evidence.claim import valid_under
from roadproof.evidence.codec import ABSENT, read, write
from roadproof.evidence.countermodel import read_trace, trace_data
from roadproof.evidence.heading import library_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.refutation import judge_trace
from roadproof.evidence.strict import LARGEST_INDEX, Fields, JsonObject, read_json
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library, Query, Specification, read_specification
from roadproof.logic.custom_names import told_freedom
from roadproof.logic.first_instant import told_first_instants
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import Effort
from roadproof.runtime.canonical import digest
from roadproof.runtime.progress import about
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict

if TYPE_CHECKING:
    from roadproof.engines.search.question import SearchOptions, Setting

_BY_TRACE, _BY_DRIVE = "trace", "trace or drive"


@dataclass(frozen=True)
class ClaimResult:
    """A claim of the list or of the user, settled."""

    task: Task
    settled: Settlement

    @property
    def verdict(self) -> ClaimVerdict:
        return self.settled.verdict

    @property
    def expected(self) -> ClaimVerdict:
        """PROVED-BOUNDED is as good as PROVED where the question was about drives up to a horizon."""
        weaker = self.settled.bounded and self.task.expected is Verdict.PROVED
        return Verdict.PROVED_BOUNDED if weaker else self.task.expected

    def as_settled(self, file: str | None = None, kernel: kept.KernelSays | None = None) -> kept.ClaimAnswer:
        """As the answer has it; ``file``: where its certificate is; ``kernel``: what Coq says of it."""
        task, settled, result = self.task, self.settled, self.settled.result
        certificate = result.certificate
        return kept.ClaimAnswer(
            property=task.id,
            part=task.part,
            scenario=task.scenario,
            set=task.set_name,
            claim=task.claim,
            assuming=task.assuming,
            expected=self.expected,
            verdict=settled.verdict,
            refuted_by=settled.refuted_by,
            beyond_limits=settled.beyond or None,
            view="grid" if settled.verdict is Verdict.PROVED_BOUNDED else "dense",
            seconds=result.seconds,
            reason=result.reason,
            doubt=None if result.doubt is None else result.doubt.kept,
            limits=None if settled.limits is None else settled.limits.as_json(),
            assumptions=() if certificate is None else tuple(certificate.assumptions),
            premises=() if certificate is None else tuple(certificate.assumed.premises),
            certificate=None if certificate is None else file,
            counterexample=_counterexample(settled),
            kernel=kernel,
        )


def _counterexample(settled: Settlement) -> JsonObject | None:
    """The refuting drive, or else the countermodel, as plain data."""
    if settled.drive is not None:
        return {"kind": "drive", "drive": settled.drive.as_data()}
    found = settled.result.countermodel
    return None if found is None else trace_data(found)


@dataclass(frozen=True)
class Claims(Unprepared):
    """Claims to be settled, each in the specification of its spec set, as a ``study.frame.Study``.

    ``effort`` is for each; ``seek_drive``: whether a drive is looked for that refutes one; ``within``: where
    and by whom drives are looked for where a claim is about drives up to a horizon, None in dense time.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    tasks: tuple[Task, ...]
    specifications: Mapping[str, Specification]
    effort: Effort = field(default_factory=Effort)
    seek_drive: bool = True
    within: "tuple[Setting, SearchOptions] | None" = None

    @property
    def are_own(self) -> bool:
        """Whether the claims are of a user, and not of the list."""
        return any(not task.title for task in self.tasks)

    @property
    def library(self) -> Library:
        return next(iter(self.specifications.values())).library

    def specification_of(self, task: Task) -> Specification:
        """The definitions that a claim is read with."""
        return self.specifications[task.set_name]

    def supposed(self, task: Task) -> tuple[str, ...]:
        """What an answer supposes of the own signals of a claim, and first instants that it asks for."""
        formula = read_claim(self.specification_of(task), task.claim).formula
        return (*told_freedom(formula), *told_first_instants(formula))

    @cached_property
    def named(self) -> dict[str, Task]:
        """The tasks by the names under which answers are kept; what is asked twice is there once."""
        return {name_of(task): task for task in self.tasks}

    @property
    def question(self) -> Question:
        """Definitions and readings: claims that are proved later are kept beside the others."""
        said = readings(next(iter(self.specifications.values())))
        return Question(SCHEMA, said, {}, self.library, find_label)

    def pieces(self, known: Mapping[str, ClaimResult]) -> Sequence[Task]:
        """Those about no single scenario first: they take longest."""
        left = [task for name, task in self.named.items() if name not in known]
        return sorted(left, key=lambda task: task.scenario is not None)

    def settle(self, piece: Task) -> dict[str, ClaimResult]:
        """One claim settled: in dense time, or within bounds."""
        with about(piece.name if piece.title else " ".join(piece.claim.split())):
            return self._settle(piece)

    def _settle(self, piece: Task) -> dict[str, ClaimResult]:
        specification = self.specification_of(piece)
        query = read_claim(specification, piece.claim)
        if self.within is not None:
            from roadproof.engines.search.outcome import Search

            settled = settle_bounded(Search(specification, query, *self.within), shipped_drives())
        else:
            label = piece.id + (f"-{piece.part}" if piece.part else "")
            more = piece.scenario, self.seek_drive, piece.assuming
            settled = self._explained(piece, query, settle(specification, query, self.effort, label, *more))
        return {name_of(piece): ClaimResult(piece, settled)}

    def _explained(self, piece: Task, query: Query, settled: Settlement) -> Settlement:
        """The same, with the cause of an UNKNOWN."""
        result = settled.result
        if settled.verdict is not Verdict.UNKNOWN or result.stop is None:
            return settled
        from roadproof.engines.search.remedy import remedy_of

        asked = query, piece.assuming, result.stop, self.effort, self.seek_drive
        doubt = doubt_of(*asked, result.reason)
        option = remedy_of(self.specification_of(piece), query, piece.assuming, doubt.cause)
        doubt = replace(doubt, option=option)
        return replace(settled, result=replace(result, reason=Why.TOLD(doubt), doubt=doubt))

    def doubt(self, piece: Task, reason: Reason) -> dict[str, ClaimResult]:
        settled = replace(in_doubt(reason, stop=Stop.PROCESS), bounded=self.within is not None)
        doubt = Doubt(Cause.PROCESS, (), self.effort.units, reason)
        settled = replace(settled, result=replace(settled.result, doubt=doubt))
        return {name_of(piece): ClaimResult(piece, settled)}

    def is_sure(self, answer: ClaimResult) -> bool:
        """Whether there is evidence; PROVED-BOUNDED has none, and is about other limits the next time."""
        return answer.verdict in (Verdict.PROVED, Verdict.VACUOUS, Verdict.REFUTED)

    def wanted(self, known: Mapping[str, ClaimResult]) -> Collection[str]:
        return self.named

    def key(self, name: str) -> str | None:
        """None within bounds, where the answer has no evidence."""
        if self.within is not None:
            return None
        task = self.named[name]
        home = self.specification_of(task)
        claim = valid_under(home, read_claim(home, task.claim), task.assuming)
        called = task.id, task.part, task.scenario, task.set_name, " ".join(task.claim.split()), task.assuming
        return digest(claim.digest(), called, home.options, self.effort, self.seek_drive)

    def record(self, name: str, answer: ClaimResult, shelf: EvidenceStore) -> kept.Record:
        task, settled, result = answer.task, answer.settled, answer.settled.result
        evidence = shelf.certificate(f"{task.name}.json", result.certificate)
        if settled.drive is not None and result.certificate is None:
            evidence = shelf.drive(f"{task.name}-drive.json", settled.drive)
        claim = kept.Claim(
            property=task.id,
            part=task.part,
            scenario=task.scenario,
            set=task.set_name,
            claim=task.claim,
            assuming=task.assuming,
            verdict=answer.verdict,
            evidence=evidence,
            counterexample=ABSENT if evidence is not None else _counterexample(settled),
        )
        return kept.Record(claim=claim, reason=result.reason, seconds=result.seconds, asked=self._asked)

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, ClaimResult]:
        said, verdict = record.claim, record.claim.verdict
        name = name_of_claim(said.claim, said.set, said.assuming)
        told = (said.property, said.part, "", said.scenario, said.set, said.claim)
        task = self.named.get(name) or Task(*told, verdict, said.assuming)
        if task.claim.split() != said.claim.split():
            raise InputError(f"the answer '{name}' is about another claim: {said.claim[:120]}")
        refuted = verdict is Verdict.REFUTED
        certificate = None if refuted else shelf.read_certificate(said.evidence)
        drive = shelf.read_drive(said.evidence) if refuted else None
        trace = read_trace(said.counterexample, name) if refuted and drive is None else None
        if trace is not None:
            home = next(iter(self.specifications.values())).in_set(said.set)
            if judge_trace(said.counterexample, home, said.claim, name, said.assuming)[1]:
                raise InputError(f"the answer '{name}' has a trace that does not refute it")
        if refuted and name in self.named:
            self._check_refuted(name, record.asked, drive)
        result = Result(
            countermodel=trace,
            verdict=verdict,
            reason=record.reason,
            certificate=certificate,
            seconds=record.seconds,
        )
        return name, ClaimResult(task, Settlement(result, drive, None, refuted and self.within is not None))

    @property
    def _asked(self) -> str:
        """How a claim is refuted: by any trace, by a drive if there is one, or by a drive within limits."""
        if self.within is None:
            return _BY_DRIVE if self.seek_drive else _BY_TRACE
        place, search_options = self.within
        return f"{search_options.engine} {digest(place)[:16]}"

    def _check_refuted(self, name: str, asked: str, drive: JudgedDrive | None) -> None:
        """Raises ``InputError`` where a kept counterexample is less than what is asked for now."""
        if asked == self._asked:
            return
        if self.within is not None:
            raise InputError(f"the answer '{name}' is that to another question about drives, or about traces")
        if self.seek_drive and drive is None:
            raise InputError(f"the answer '{name}' is a trace, and no drive was looked for")


def name_of(task: Task) -> str:
    """Under which name the answer to a claim is kept, whatever the list calls it."""
    return name_of_claim(task.claim, task.set_name, task.assuming)


# --- the index of a folder of settled claims, which grows ------------------------------------------

Entries = dict[str, Claim]


def former_claims(folder: Path, claims: Claims) -> Entries:
    """The entries of an index that is there already, by name.

    Raises ``UsageError`` where it is of another command, or its claims were read otherwise.
    """
    path = folder / INDEX
    if not path.exists():
        return {}
    data = index_fields(read_json(path, LARGEST_INDEX), str(path))
    if data.text("schema") != SCHEMA:
        raise UsageError(f"{path} belongs to another command: name another folder with --out")
    if not _read_alike(data, folder, claims):
        raise UsageError(
            f"{folder} holds claims for other options, specification files or "
            "another library: name another folder with --out"
        )
    known = read(Index, data.content, data.where).claims
    return {name_of_claim(x.claim, x.set, x.assuming): x for x in known}


def _read_alike(data: Fields, folder: Path, claims: Claims) -> bool:
    library, options = claims.library, claims.question.options
    texts = {Path(x.name).name: x.text for x in library.files}
    kept = data.texts("specs") if data.has("specs") else ()
    there = {name: read_specification(folder / Path(name).name).text for name in kept}
    told = data.named_texts("options") if data.has("options") else {}
    same = library_of(data) == library.fingerprint
    return same and there == texts and dict(library.select(options=told).options) == options


def write_claims(folder: Path, claims: Claims, records: Mapping[str, Record]) -> None:
    """Write the index: former entries, each with its new answer if there is one, and then what is new.

    A file that only a former answer needed is removed.
    """
    former = former_claims(folder, claims)
    new = [name for name in claims.named if name in records]
    new += sorted(name for name in records if name not in claims.named)
    entries: Entries = {**former, **{name: records[name].claim for name in new}}
    write_index(folder, write(Index(**claims.question.heading, claims=tuple(entries.values()))))
    for name in _files(former) - _files(entries):
        (folder / name).unlink(missing_ok=True)


def _files(entries: Entries) -> set[str]:
    return {Path(str(x.evidence)).name for x in entries.values() if x.evidence}
