"""Certificates and drives put to Coq or to the extracted program, many at once, a file a process."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from roadproof.errors import RoadproofError
from roadproof.evidence import drive_file
from roadproof.evidence.answer_files import REFUTATION, RefutationFile
from roadproof.evidence.certificate import SCHEMA, Certificate, read_certificate_data
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.kernels import (
    KernelAnswer,
    KernelName,
    KernelQuestion,
    Kernels,
    Ruling,
    Word,
)
from roadproof.evidence.none_within import SCHEMA as NONE_WITHIN
from roadproof.evidence.none_within import NoneWithinFile, read_none_within
from roadproof.evidence.strict import read_json
from roadproof.extensions.kernel import accept, coq, extracted, ocaml, programs
from roadproof.extensions.kernel.accept import CoqModule, KernelRulings
from roadproof.extensions.kernel.derivations.prepare import prepare as prepare_drive
from roadproof.extensions.kernel.derivations.prepare import prepare_trace
from roadproof.extensions.kernel.drive import module as source_drive
from roadproof.extensions.kernel.names import WORDS
from roadproof.extensions.kernel.source import file
from roadproof.extensions.kernel.source import module as source_proof
from roadproof.extensions.kernel.trace import Refutation
from roadproof.extensions.kernel.trace import trace_module as source_trace
from roadproof.library.loading import load_library
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime import pool
from roadproof.runtime.executors import Jobs
from roadproof.runtime.files import make_folder, write_whole
from roadproof.runtime.package_data import shipped
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass


def find(kernel: KernelName) -> None:
    """Raises ``MissingSolverError`` where what a kernel needs is not installed."""
    if kernel == "coq":
        coq.find()
    else:
        ocaml.find()


@contextmanager
def _judging(kernel: KernelName) -> Iterator[tuple[str, Callable[[Mapping[str, CoqModule]], KernelRulings]]]:
    """The version of a kernel, and its judge of prepared files."""
    if kernel == "coq":
        with coq.ready() as found:
            yield found.version, partial(accept.judge, found)
    else:
        with ocaml.ready() as program:
            yield program.version, partial(extracted.judge, program)


def put(
    asked: Sequence[KernelQuestion],
    jobs: Jobs,
    progress: Progress | None = None,
    kernel: KernelName = "coq",
) -> KernelAnswer:
    """What a kernel says of each certificate and drive; nothing of others. Raises ``MissingSolverError``."""
    with _judging(kernel) as (version, judge):
        prepared = prepare_all(asked, jobs, progress, kernel)
        count = pool.count_workers(list(prepared), jobs) if prepared else 0
        parts = list(accept.batches(prepared, count))
        rulings: dict[str, Ruling] = {}
        seconds = megabytes = 0.0
        for judged in pool.in_order(pool.work(judge, parts, jobs, _lost, progress, "files for the kernel")):
            rulings |= judged.rulings
            seconds += judged.seconds
            megabytes = max(megabytes, judged.megabytes)
        return KernelAnswer(version, rulings, seconds, megabytes, kernel)


def write(
    asked: Sequence[KernelQuestion], folder: Path, jobs: Jobs, kernel: KernelName = "coq"
) -> dict[str, Reason]:
    """A file for each certificate and drive, with the sources of the kernel below; it is not asked.

    Comes back with why there is no file, by name, where there is none.
    """
    home = shipped("proofs") / "kernel"
    for source in _sources(kernel):
        make_folder(folder / _FOLDER[kernel])
        write_whole(folder / _FOLDER[kernel] / source.name, (home / source).read_bytes())
    reasons: dict[str, Reason] = {}
    for name, x in prepare_all(asked, jobs, None, kernel).items():
        if x.module is None:
            reasons[name] = x.refusal.reason if x.refusal else NO_REASON
        elif kernel == "coq":
            content = file([x.module]) + accept.closing([x.module])
            write_whole(folder / f"{name}.v", content.encode("ascii"))
        else:
            write_whole(folder / f"{name}.txt", x.module.text.encode("ascii"))
    return reasons


_FOLDER: Mapping[KernelName, str] = {"coq": "Roadproof", "extracted": "ocaml"}


def _sources(kernel: KernelName) -> list[Path]:
    """What a kernel is made of, below proofs/kernel."""
    if kernel == "coq":
        return [Path(f"{name}.v") for name in coq.THEORIES]
    return [Path("ocaml") / f"{name}.ml" for name in ocaml.SOURCES]


def names_of(paths: Iterable[Path]) -> dict[Path, str]:
    """A name for each file that is one in Coq, too: of its own name, and of a number where that is taken.

    >>> list(names_of([Path("a b.json"), Path("a_b.json"), Path("1.json"), Path("fun.json")]).values())
    ['a_b', 'a_b_2', 'claim_1', 'fun_2']
    """
    found: dict[Path, str] = {}
    taken = set(WORDS)
    for path in paths:
        plain = re.sub(r"\W", "_", path.stem, flags=re.ASCII)[:100]
        plain = plain if plain[:1].isalpha() else f"claim_{plain}"
        name, count = plain, 1
        while name in taken:
            count += 1
            name = f"{plain}_{count}"
        taken.add(name)
        found[path] = name
    return found


def prepare_all(
    asked: Sequence[KernelQuestion],
    jobs: Jobs,
    progress: Progress | None = None,
    kernel: KernelName = "coq",
) -> dict[str, CoqModule]:
    prepare = partial(_prepare, kernel)
    made = pool.in_order(pool.work(prepare, asked, jobs, _unprepared, progress, "claims to be printed"))
    return {x.name: y for x, y in zip(asked, made, strict=True) if y is not None}


# How drives, traces and proofs are written for each kernel.
_COQ = source_drive, source_trace, source_proof
_EXTRACTED = extracted.drive, extracted.trace, extracted.proof


def _prepare(kernel: KernelName, asked: KernelQuestion) -> CoqModule | None:
    content: object = asked.certificate
    if isinstance(content, Path):
        try:
            content = _read(content)
        except RoadproofError:
            return None
    home = asked.home if isinstance(asked.home, Library) else load_library(asked.home)
    if isinstance(content, NoneWithinFile):
        return _none_within(kernel, asked.name, content, home)
    drive, trace, proof = _COQ if kernel == "coq" else _EXTRACTED
    if isinstance(content, Refutation):
        return prepare_trace(asked.name, content, home, trace)
    if isinstance(content, DriveFile):
        return prepare_drive(asked.name, content, home, drive)
    return accept.prepare(asked.name, content, home, proof) if isinstance(content, Certificate) else None


def _none_within(kernel: KernelName, name: str, file: NoneWithinFile, home: Library) -> CoqModule:
    """The programs that the encoder derives, with the trees of a file."""
    from roadproof.engines.search.none_within import derive

    try:
        derived = derive(file, home)
    except RoadproofError as error:
        return accept.without_question(error)
    trees = (tree for _, tree in file.refutations)
    pairs = list(zip(derived.programs, trees, strict=True))
    written = programs.prepare if kernel == "coq" else programs.form
    return written(name, [file.formula, derived.limits], pairs)


def _read(path: Path) -> Certificate | DriveFile | NoneWithinFile | Refutation | None:
    """Raises ``InputError`` for a file that is damaged."""
    content = read_json(path)
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema in drive_file.SCHEMAS_READ:
        return read_drive(content, str(path))
    if schema == NONE_WITHIN:
        return read_none_within(content, str(path))
    if schema == REFUTATION:
        file = read(RefutationFile, content, str(path))
        return Refutation(file.claim, file.set, file.options, file.assuming, file.trace, str(path))
    return read_certificate_data(content, str(path)) if schema == SCHEMA else None


def _unprepared(asked: KernelQuestion, reason: Reason) -> CoqModule:
    return CoqModule(None, refusal=Ruling(Word.UNKNOWN, reason))


def _lost(part: Mapping[str, CoqModule], reason: Reason) -> KernelRulings:
    return KernelRulings({name: Ruling(Word.UNKNOWN, reason) for name in part})


@dataclass(frozen=True)
class CoqAndExtracted(Kernels):
    """Coq, and the program that it makes of its checkers."""

    def find(self, kernel: KernelName) -> None:
        find(kernel)

    def put(
        self,
        asked: Sequence[KernelQuestion],
        jobs: Jobs,
        progress: Progress | None = None,
        kernel: KernelName = "coq",
    ) -> KernelAnswer:
        return put(asked, jobs, progress, kernel)

    def write(
        self, asked: Sequence[KernelQuestion], folder: Path, jobs: Jobs, kernel: KernelName = "coq"
    ) -> dict[str, Reason]:
        return write(asked, folder, jobs, kernel)

    def names_of(self, paths: Iterable[Path]) -> dict[Path, str]:
        return names_of(paths)

    def find_tableau(self, proof: Certificate, library: Library) -> tuple[str, ...] | None:
        return accept.find_tableau(proof, library)


KERNELS = CoqAndExtracted()
