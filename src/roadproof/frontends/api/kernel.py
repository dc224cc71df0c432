"""Certificates and drives put to Coq, many at once: each process has one file for its share."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from roadproof.analysis.study import pool
from roadproof.analysis.study.pool import Progress
from roadproof.errors import RoadproofError
from roadproof.evidence import drive_file
from roadproof.evidence.answers.shared import Kernel
from roadproof.evidence.certificate import SCHEMAS_READ, Certificate, read_certificate_data
from roadproof.evidence.derivations.prepare import prepare as prepare_drive
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.finding import Acceptance, OtherVerdict
from roadproof.evidence.kernel import accept
from roadproof.evidence.kernel.accept import CoqModule, KernelRulings, Ruling, Word
from roadproof.evidence.kernel.coq import THEORIES, ready
from roadproof.evidence.kernel.source import file
from roadproof.evidence.strict import read_json
from roadproof.library.loading import load_library
from roadproof.library.specification import Library
from roadproof.reasons import Why
from roadproof.runtime.executors import Jobs
from roadproof.runtime.files import make_folder, write_whole
from roadproof.runtime.package_data import shipped
from roadproof.verdict import ExitCode

_OUTCOMES = {
    Word.ACCEPTED: Acceptance.ACCEPTED,
    Word.REFUSED: Acceptance.REJECTED,
    Word.UNKNOWN: Acceptance.UNDECIDED,
}
_EXIT = {
    Word.ACCEPTED: ExitCode.AS_EXPECTED,
    Word.UNKNOWN: ExitCode.UNKNOWN,
    Word.REFUSED: ExitCode.CROSSCHECK_FAILED,
}


@dataclass(frozen=True)
class KernelQuestion:
    """A certificate, or the file that it or a drive is in; ``home`` is its library, or the files of that."""

    name: str
    certificate: Certificate | Path
    home: Library | tuple[Path, ...]


@dataclass(frozen=True)
class KernelAnswer:
    """Rulings by name; seconds of the processor for all Coqs, megabytes of the largest, axioms used."""

    version: str
    rulings: Mapping[str, Ruling] = field(default_factory=dict)
    seconds: float = 0.0
    megabytes: float = 0.0

    @property
    def exit_code(self) -> ExitCode:
        """A proof of ours that Coq refuses is a cross-check that failed."""
        return max((_EXIT[x.word] for x in self.rulings.values()), default=ExitCode.AS_EXPECTED)

    @property
    def axioms(self) -> tuple[str, ...]:
        return tuple(sorted({name for x in self.rulings.values() for name in x.axioms}))

    @property
    def kept(self) -> Kernel:
        """As answers have it."""
        return Kernel(
            coqc=self.version,
            seconds=round(self.seconds, 1),
            megabytes=round(self.megabytes),
            axioms=self.axioms,
        )

    def __str__(self) -> str:
        held = f"at most {self.megabytes:.0f} MB" if self.megabytes else "nothing asked"
        axioms = ", ".join(self.axioms) or "none"
        return f"coqc {self.version}: {self.seconds:.1f} s of processor time, {held}; axioms: {axioms}"


def put(asked: Sequence[KernelQuestion], jobs: Jobs, progress: Progress | None = None) -> KernelAnswer:
    """What Coq says of each certificate and drive; nothing of others. Raises ``MissingSolverError``."""
    with ready() as coq:
        prepared = prepare_all(asked, jobs, progress)
        count = pool.count_workers(list(prepared), jobs) if prepared else 0
        parts = list(accept.batches(prepared, count))
        rulings: dict[str, Ruling] = {}
        seconds = megabytes = 0.0
        for judged in pool.in_order(
            pool.work(partial(accept.judge, coq), parts, jobs, _lost, progress, "files of Coq")
        ):
            rulings |= judged.rulings
            seconds += judged.seconds
            megabytes = max(megabytes, judged.megabytes)
        return KernelAnswer(coq.version, rulings, seconds, megabytes)


def write(asked: Sequence[KernelQuestion], folder: Path, jobs: Jobs) -> dict[str, str]:
    """A file for each certificate and drive, with the theories below; Coq is not asked.

    Comes back with why there is no file, by name, where there is none.
    """
    make_folder(folder / "Roadproof")
    for name in THEORIES:
        source = shipped("proofs") / "kernel" / f"{name}.v"
        write_whole(folder / "Roadproof" / source.name, source.read_bytes())
    reasons: dict[str, str] = {}
    for name, x in prepare_all(asked, jobs).items():
        if x.module is None:
            reasons[name] = x.refusal.reason if x.refusal else ""
        else:
            content = file([x.module]) + accept.closing([x.module])
            write_whole(folder / f"{name}.v", content.encode("ascii"))
    return reasons


def names_of(paths: Iterable[Path]) -> dict[Path, str]:
    """A name for each file that is one in Coq, too: of its own name, and of a number where that is taken."""
    found: dict[Path, str] = {}
    for path in paths:
        plain = re.sub(r"\W", "_", path.stem, flags=re.ASCII)[:100]
        plain = plain if plain[:1].isalpha() else f"claim_{plain}"
        name, count = plain, 1
        while name in found.values():
            count += 1
            name = f"{plain}_{count}"
        found[path] = name
    return found


def prepare_all(
    asked: Sequence[KernelQuestion], jobs: Jobs, progress: Progress | None = None
) -> dict[str, CoqModule]:
    made = pool.in_order(pool.work(_prepare, asked, jobs, _unprepared, progress, "claims to be printed"))
    return {x.name: y for x, y in zip(asked, made, strict=True) if y is not None}


def _prepare(asked: KernelQuestion) -> CoqModule | None:
    content: object = asked.certificate
    if isinstance(content, Path):
        try:
            content = _read(content)
        except RoadproofError:
            return None
    home = asked.home if isinstance(asked.home, Library) else load_library(asked.home)
    if isinstance(content, DriveFile):
        return prepare_drive(asked.name, content, home)
    return accept.prepare(asked.name, content, home) if isinstance(content, Certificate) else None


def _read(path: Path) -> Certificate | DriveFile | None:
    """Raises ``InputError`` for a file that is damaged."""
    content = read_json(path)
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema in drive_file.SCHEMAS_READ:
        return read_drive(content, str(path))
    return read_certificate_data(content, str(path)) if schema in SCHEMAS_READ else None


def _unprepared(asked: KernelQuestion, reason: str) -> CoqModule:
    return CoqModule(None, refusal=Ruling(Word.UNKNOWN, reason))


def _lost(part: Mapping[str, CoqModule], reason: str) -> KernelRulings:
    return KernelRulings({name: Ruling(Word.UNKNOWN, reason) for name in part})


def ruled(ruling: Ruling) -> OtherVerdict:
    """What Coq says, for a finding."""
    premises = ruling.premises
    words = "that is a premise" if premises.count == 1 else "that are premises"
    said = (f"under {premises} {words}",) if premises.count else ()
    untold = (
        *(("that the facts are true of motion",) * bool(premises.facts)),
        *(("that the inductions hold on every trace",) * bool(premises.inductions)),
    )
    unchecked = ("queries for solvers", *untold)
    return OtherVerdict(_OUTCOMES[ruling.word], Why.TOLD(ruling.reason), str(ruling), said, unchecked)
