"""The check of certificates by Coq: each is accepted, refused or unknown, and accepted by Coq alone.

Several certificates go into one file, since loading the library is slow. If Coq refuses one, the others are
checked again without it. Every accepted certificate was in a file that Coq accepted as a whole and that uses
known axioms only.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from roadproof.errors import RoadproofError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.kernels import KernelRuling, KernelVerdict
from roadproof.extensions.kernel.branch import NotFoundError
from roadproof.extensions.kernel.coq import Coq, CoqRun
from roadproof.extensions.kernel.search import search_tableau
from roadproof.extensions.kernel.source import Module, UnreasonedError, file, module
from roadproof.extensions.kernel.statement import Statement, state
from roadproof.extensions.kernel.tableau import Tableau, lines, read_lines
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, ReasonKind

# Those of Coq's real numbers and of classical logic; nothing else may be relied on.
AXIOMS = frozenset(
    {
        "ClassicalDedekindReals.sig_forall_dec",
        "ClassicalDedekindReals.sig_not_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
        "Classical_Prop.classic",
    }
)
ALL = "all_that_is_proved"
_PLACE = re.compile(r'^File "[^"\n]*evidence\.v", line (\d+), characters [^\n]*\n((?:.|\n)*)', re.MULTILINE)
_AXIOM = re.compile(r"^([A-Za-z_][\w.']*)(?: :|$)", re.MULTILINE)


@dataclass(frozen=True)
class CoqModule:
    """A certificate as a Coq module, or the ruling that explains why there is no module."""

    module: Module | None
    limits: int = 0
    refusal: KernelRuling | None = None


def refused_module(error: RoadproofError) -> CoqModule:
    """Return the result for evidence that contains nothing for a kernel to check."""
    return CoqModule(None, refusal=KernelRuling(KernelVerdict.REFUSED, ReasonKind.NOT_PUT(error)))


def unprintable_module(error: RoadproofError) -> CoqModule:
    """Return the result for evidence whose claim or proof cannot be written in Coq."""
    return CoqModule(None, refusal=KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.NOT_PRINTED(error)))


@dataclass
class KernelRulings:
    """The rulings by name of module, with the processor time and memory that Coq took."""

    rulings: dict[str, KernelRuling] = field(default_factory=dict)
    seconds: float = 0.0
    megabytes: float = 0.0


def find_tableau(certificate: Certificate, library: Library) -> tuple[str, ...] | None:
    """Return the lines of a tableau for a certificate, found without Coq; None if the search fails."""
    try:
        return lines(search_tableau(state(certificate, library, certificate.query).goal))
    except (NotFoundError, RoadproofError):
        return None


def prepare(
    name: str,
    certificate: Certificate,
    library: Library,
    print_module: Callable[[str, Statement, Tableau], Module] = module,
) -> CoqModule:
    """Return the Coq module of a certificate, with its own tableau or a tableau found by search.

    ``print_module`` writes the module; the extracted program has another format.
    """
    try:
        statement = state(certificate, library)
        tableau = _tableau(certificate, statement)
    except NotFoundError as error:
        return CoqModule(None, refusal=KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.NO_TABLEAU(error)))
    except RoadproofError as error:
        return refused_module(error)
    try:
        return CoqModule(print_module(name, statement, tableau), statement.limits)
    except UnreasonedError as error:
        return CoqModule(None, refusal=KernelRuling(KernelVerdict.UNKNOWN, error.reason, error.number))
    except RoadproofError as error:
        return unprintable_module(error)


def _tableau(certificate: Certificate, statement: Statement) -> Tableau:
    if certificate.tableau is not None:
        return read_lines(certificate.tableau)
    return search_tableau(statement.goal)


def judge(coq: Coq, prepared: Mapping[str, CoqModule]) -> KernelRulings:
    """Return Coq's rulings on prepared modules, by name."""
    judged = KernelRulings({name: x.refusal for name, x in prepared.items() if x.refusal is not None})
    _judge_modules(coq, [x.module for x in prepared.values() if x.module is not None], prepared, judged)
    return judged


def _judge_modules(
    coq: Coq, modules: Sequence[Module], prepared: Mapping[str, CoqModule], judged: KernelRulings
) -> None:
    """Check modules in one file; if Coq stops in one of them, check the others separately."""
    if not modules:
        return
    run = _run_coq(coq, modules, judged)
    if run.code == 0:
        _rule_accepted(modules, prepared, run, judged)
        return
    failure = _first_failure(modules, run)
    if failure is None and len(modules) > 1:
        half = len(modules) // 2
        _judge_modules(coq, modules[:half], prepared, judged)
        _judge_modules(coq, modules[half:], prepared, judged)
        return
    place, ruling = failure or (
        0,
        KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.COQ_ENDED(_first_message(run))),
    )
    judged.rulings[modules[place].name] = ruling
    _judge_modules(coq, modules[:place], prepared, judged)
    _judge_modules(coq, modules[place + 1 :], prepared, judged)


def _run_coq(coq: Coq, modules: Sequence[Module], judged: KernelRulings) -> CoqRun:
    run = coq.run(file(modules) + closing(modules))
    judged.seconds += run.seconds
    judged.megabytes = max(judged.megabytes, run.megabytes)
    return run


def closing(modules: Sequence[Module]) -> str:
    """Return the end of a file: all theorems as one term, and the command that prints its axioms."""
    conjunction = "I"
    for x in modules:
        conjunction = f"(conj {x.name}.proved {conjunction})"
    return f"Definition {ALL} := {conjunction}.\nPrint Assumptions {ALL}.\n"


def _rule_accepted(
    modules: Sequence[Module], prepared: Mapping[str, CoqModule], run: CoqRun, judged: KernelRulings
) -> None:
    """Add the rulings for a file that Coq accepted: its axioms must be known ones."""
    axioms = axioms_of(run.output)
    for coq_module in modules:
        limits = prepared[coq_module.name].limits
        if axioms is None:
            ruling = KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.AXIOMS_UNSAID())
        elif set(axioms) - AXIOMS:
            ruling = KernelRuling(
                KernelVerdict.REFUSED, ReasonKind.AXIOMS(", ".join(sorted(set(axioms) - AXIOMS)))
            )
        else:
            ruling = KernelRuling(KernelVerdict.ACCEPTED, NO_REASON, None, limits, axioms)
        judged.rulings[coq_module.name] = ruling


def axioms_of(output: str) -> tuple[str, ...] | None:
    """Return the axiom names in the output of ``Print Assumptions``; None if it has another form."""
    if output.strip() == "Closed under the global context":
        return ()
    before, heading, listed = output.partition("Axioms:\n")
    return tuple(_AXIOM.findall(listed)) if heading and not before.strip() else None


def _first_failure(modules: Sequence[Module], run: CoqRun) -> tuple[int, KernelRuling] | None:
    """Return the module at which Coq stopped, and its ruling; None if Coq reports no place."""
    error_place = _PLACE.search(run.errors)
    if error_place is None:
        return None
    line = int(error_place[1]) - _head_lines()
    for place, coq_module in enumerate(modules):
        if line <= coq_module.lines:
            return place, _ruling_at(coq_module, line, " ".join(error_place[2].split()))
        line -= coq_module.lines
    return None


def _ruling_at(module: Module, line: int, error: str) -> KernelRuling:
    if line >= module.theorem:
        if '"true = true"' in error:
            return KernelRuling(KernelVerdict.REFUSED, ReasonKind.NOT_BY_COQ())
        if 'Unable to unify "true" with "false"' in error:
            return KernelRuling(KernelVerdict.REFUSED, ReasonKind.NO_SCHEMA())
        return KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.COQ_SAYS(error))
    lemma = sum(line >= begins for begins in module.lemmas)
    if lemma:
        return KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.LEMMA(lemma), lemma)
    return KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.COQ_DOES_NOT_READ(error))


def _head_lines() -> int:
    return file([]).count("\n")


def _first_message(run: CoqRun) -> str:
    return " ".join((run.errors or run.output).split())[:200] or f"exit code {run.code}"


def split_evenly(modules: Mapping[str, CoqModule], count: int) -> Iterator[dict[str, CoqModule]]:
    """Yield about ``count`` parts of equal size."""
    names = list(modules)
    for place in range(min(count, len(names))):
        yield {name: modules[name] for name in names[place::count]}
