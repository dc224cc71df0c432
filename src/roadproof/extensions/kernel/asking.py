"""The kernels of this extension, run in parallel: Coq, and the program extracted from its checkers."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from roadproof.core_record import CERTIFICATE, DRIVES, NONE_WITHIN, REFUTATION
from roadproof.errors import RoadproofError
from roadproof.evidence.answer_files import RefutationFile
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import read_certificate_data
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.kernels import (
    KernelAnswer,
    KernelName,
    KernelQuestion,
    KernelRuling,
    Kernels,
    KernelVerdict,
)
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.none_within_file import read_none_within
from roadproof.evidence.strict import read_json
from roadproof.extensions.kernel import accept, coq, extracted, ocaml, programs
from roadproof.extensions.kernel.accept import CoqModule, KernelRulings
from roadproof.extensions.kernel.derivations.prepare import prepare as prepare_drive
from roadproof.extensions.kernel.derivations.prepare import prepare_trace
from roadproof.extensions.kernel.drive import drive_module as source_drive
from roadproof.extensions.kernel.names import WORDS
from roadproof.extensions.kernel.source import file
from roadproof.extensions.kernel.source import module as source_proof
from roadproof.extensions.kernel.trace import TraceQuestion
from roadproof.extensions.kernel.trace import trace_module as source_trace
from roadproof.library.loading import load_library
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime import pool
from roadproof.runtime.executors import Jobs
from roadproof.runtime.files import make_folder, write_atomic
from roadproof.runtime.package_data import shipped_folder
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass


def require_installed(kernel: KernelName) -> None:
    """Raise ``MissingSolverError`` if a program that the kernel needs is not installed."""
    if kernel == "coq":
        coq.find_coqc()
    else:
        ocaml.find_ocamlopt()


@contextmanager
def _judging(kernel: KernelName) -> Iterator[tuple[str, Callable[[Mapping[str, CoqModule]], KernelRulings]]]:
    """Yield the version of a kernel, and the function that judges prepared modules."""
    if kernel == "coq":
        with coq.ready() as coq_program:
            yield coq_program.version, partial(accept.judge, coq_program)
    else:
        with ocaml.ready() as program:
            yield program.version, partial(extracted.judge, program)


def check_with_kernel(
    questions: Sequence[KernelQuestion],
    jobs: Jobs,
    progress: Progress | None = None,
    kernel: KernelName = "coq",
) -> KernelAnswer:
    """Return the rulings on certificates, drives and traces; other questions get none.

    Raises ``MissingSolverError``.
    """
    with _judging(kernel) as (version, judge):
        prepared = prepare_all(questions, jobs, progress, kernel)
        count = pool.count_workers(list(prepared), jobs) if prepared else 0
        parts = list(accept.split_evenly(prepared, count))
        rulings: dict[str, KernelRuling] = {}
        seconds = megabytes = 0.0
        for judged in pool.in_order(pool.work(judge, parts, jobs, _lost, progress, "files for the kernel")):
            rulings |= judged.rulings
            seconds += judged.seconds
            megabytes = max(megabytes, judged.megabytes)
        return KernelAnswer(version, rulings, seconds, megabytes, kernel)


def write(
    questions: Sequence[KernelQuestion], folder: Path, jobs: Jobs, kernel: KernelName = "coq"
) -> dict[str, Reason]:
    """Write a file for each question, with the sources of the kernel beside them; the kernel does not run.

    Returns the reasons for missing files, by name.
    """
    home = shipped_folder("proofs") / "kernel"
    for source in _sources(kernel):
        make_folder(folder / _FOLDER[kernel])
        write_atomic(folder / _FOLDER[kernel] / source.name, (home / source).read_bytes())
    reasons: dict[str, Reason] = {}
    for name, prepared in prepare_all(questions, jobs, None, kernel).items():
        if prepared.module is None:
            reasons[name] = prepared.refusal.reason if prepared.refusal else NO_REASON
        elif kernel == "coq":
            content = file([prepared.module]) + accept.closing([prepared.module])
            write_atomic(folder / f"{name}.v", content.encode("ascii"))
        else:
            write_atomic(folder / f"{name}.txt", prepared.module.text.encode("ascii"))
    return reasons


_FOLDER: Mapping[KernelName, str] = {"coq": "Roadproof", "extracted": "ocaml"}


def _sources(kernel: KernelName) -> list[Path]:
    """Return the paths of the kernel's sources, below proofs/kernel."""
    if kernel == "coq":
        return [Path(f"{name}.v") for name in coq.THEORIES]
    return [Path("ocaml") / f"{name}.ml" for name in ocaml.SOURCES]


def names_of(paths: Iterable[Path]) -> dict[Path, str]:
    """Return for each file a name that is valid in Coq; duplicates get a number.

    >>> list(names_of([Path("a b.json"), Path("a_b.json"), Path("1.json"), Path("fun.json")]).values())
    ['a_b', 'a_b_2', 'claim_1', 'fun_2']
    """
    names: dict[Path, str] = {}
    taken = set(WORDS)
    for path in paths:
        base = re.sub(r"\W", "_", path.stem, flags=re.ASCII)[:100]
        base = base if base[:1].isalpha() else f"claim_{base}"
        name, count = base, 1
        while name in taken:
            count += 1
            name = f"{base}_{count}"
        taken.add(name)
        names[path] = name
    return names


def prepare_all(
    questions: Sequence[KernelQuestion],
    jobs: Jobs,
    progress: Progress | None = None,
    kernel: KernelName = "coq",
) -> dict[str, CoqModule]:
    """Return the module of each question by name, prepared in parallel; unknown kinds of files have none."""
    prepare = partial(_prepare, kernel)
    modules = pool.in_order(pool.work(prepare, questions, jobs, _failed, progress, "claims to be printed"))
    return {x.name: y for x, y in zip(questions, modules, strict=True) if y is not None}


# How drives, traces and proofs are written for each kernel.
_COQ = source_drive, source_trace, source_proof
_EXTRACTED = extracted.drive, extracted.trace, extracted.proof


def _prepare(kernel: KernelName, question: KernelQuestion) -> CoqModule | None:
    content: object = question.certificate
    if isinstance(content, Path):
        try:
            content = _read(content)
        except RoadproofError:
            return None
    library = question.home if isinstance(question.home, Library) else load_library(question.home)
    if isinstance(content, NoneWithinFile):
        return _none_within(kernel, question.name, content, library)
    drive, trace, proof = _COQ if kernel == "coq" else _EXTRACTED
    if isinstance(content, TraceQuestion):
        return prepare_trace(question.name, content, library, trace)
    if isinstance(content, DriveFile):
        return prepare_drive(question.name, content, library, drive)
    return (
        accept.prepare(question.name, content, library, proof) if isinstance(content, Certificate) else None
    )


def _none_within(kernel: KernelName, name: str, file: NoneWithinFile, library: Library) -> CoqModule:
    """Return the module of the programs that the encoder derives from a file, with the trees in the file."""
    from roadproof.engines.search.none_within import derive

    try:
        derived = derive(file, library)
    except RoadproofError as error:
        return accept.refused_module(error)
    trees = (tree for _, tree in file.refutations)
    pairs = list(zip(derived.programs, trees, strict=True))
    print_module = programs.prepare if kernel == "coq" else programs.form
    return print_module(name, [file.formula, derived.limits], pairs)


def _read(path: Path) -> Certificate | DriveFile | NoneWithinFile | TraceQuestion | None:
    """Return the content of a file; None for an unknown schema. Raises ``InputError`` for a damaged file."""
    content = read_json(path)
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema in DRIVES:
        return read_drive(content, str(path))
    if schema == NONE_WITHIN:
        return read_none_within(content, str(path))
    if schema == REFUTATION:
        file = read(RefutationFile, content, str(path))
        return TraceQuestion(file.claim, file.set, file.options, file.assuming, file.trace, str(path))
    return read_certificate_data(content, str(path)) if schema == CERTIFICATE else None


def _failed(question: KernelQuestion, reason: Reason) -> CoqModule:
    return CoqModule(None, refusal=KernelRuling(KernelVerdict.UNKNOWN, reason))


def _lost(part: Mapping[str, CoqModule], reason: Reason) -> KernelRulings:
    return KernelRulings({name: KernelRuling(KernelVerdict.UNKNOWN, reason) for name in part})


@dataclass(frozen=True)
class CoqAndExtracted(Kernels):
    """Coq, and the program extracted from its checkers."""

    def require_installed(self, kernel: KernelName) -> None:
        require_installed(kernel)

    def check(
        self,
        questions: Sequence[KernelQuestion],
        jobs: Jobs,
        progress: Progress | None = None,
        kernel: KernelName = "coq",
    ) -> KernelAnswer:
        return check_with_kernel(questions, jobs, progress, kernel)

    def write(
        self, questions: Sequence[KernelQuestion], folder: Path, jobs: Jobs, kernel: KernelName = "coq"
    ) -> dict[str, Reason]:
        return write(questions, folder, jobs, kernel)

    def names_of(self, paths: Iterable[Path]) -> dict[Path, str]:
        return names_of(paths)

    def find_tableau(self, proof: Certificate, library: Library) -> tuple[str, ...] | None:
        return accept.find_tableau(proof, library)


KERNELS = CoqAndExtracted()
