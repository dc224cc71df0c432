"""Certificates put to Coq: each is accepted, refused or unknown, and accepted only by Coq's word.

Several go into one file, so that Coq loads its library once. Where Coq refuses one, the others are put to it
without it; what is accepted has been in a file that Coq accepted whole, and that stands on known axioms.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from roadproof.errors import RoadproofError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.kernels import Ruling, Word
from roadproof.extensions.kernel.branch import NotFoundError
from roadproof.extensions.kernel.coq import Coq, CoqRun
from roadproof.extensions.kernel.search import find
from roadproof.extensions.kernel.source import Module, UnreasonedError, file, module
from roadproof.extensions.kernel.statement import Statement, state
from roadproof.extensions.kernel.tableau import Tableau, lines, read_lines
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Why

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
    """A certificate as a module of Coq, or why there is none."""

    module: Module | None
    limits: int = 0
    refusal: Ruling | None = None


def without_question(error: RoadproofError) -> CoqModule:
    """Evidence that says nothing that a kernel could be asked."""
    return CoqModule(None, refusal=Ruling(Word.REFUSED, Why.NOT_PUT(error)))


def without_text(error: RoadproofError) -> CoqModule:
    """Evidence whose claim or proof has no words in a kernel."""
    return CoqModule(None, refusal=Ruling(Word.UNKNOWN, Why.NOT_PRINTED(error)))


@dataclass
class KernelRulings:
    """Rulings by the name of a module; seconds of the processor and megabytes that Coq took."""

    rulings: dict[str, Ruling] = field(default_factory=dict)
    seconds: float = 0.0
    megabytes: float = 0.0


def find_tableau(certificate: Certificate, library: Library) -> tuple[str, ...] | None:
    """The lines of a tableau for a certificate, None where none is found. Coq is not asked."""
    try:
        return lines(find(state(certificate, library, certificate.query).goal))
    except (NotFoundError, RoadproofError):
        return None


def prepare(
    name: str,
    certificate: Certificate,
    library: Library,
    written: Callable[[str, Statement, Tableau], Module] = module,
) -> CoqModule:
    """The certificate as ``written`` for Coq: with its own tableau, or with one that is searched."""
    try:
        statement = state(certificate, library)
        tableau = _tableau(certificate, statement)
    except NotFoundError as error:
        return CoqModule(None, refusal=Ruling(Word.UNKNOWN, Why.NO_TABLEAU(error)))
    except RoadproofError as error:
        return without_question(error)
    try:
        return CoqModule(written(name, statement, tableau), statement.limits)
    except UnreasonedError as error:
        return CoqModule(None, refusal=Ruling(Word.UNKNOWN, error.reason, error.number))
    except RoadproofError as error:
        return without_text(error)


def _tableau(certificate: Certificate, statement: Statement) -> Tableau:
    if certificate.tableau is not None:
        return read_lines(certificate.tableau)
    return find(statement.goal)


def judge(coq: Coq, prepared: Mapping[str, CoqModule]) -> KernelRulings:
    """What Coq says of each, by name."""
    judged = KernelRulings({name: x.refusal for name, x in prepared.items() if x.refusal is not None})
    _settle(coq, [x.module for x in prepared.values() if x.module is not None], prepared, judged)
    return judged


def _settle(
    coq: Coq, modules: Sequence[Module], prepared: Mapping[str, CoqModule], judged: KernelRulings
) -> None:
    """One file, and where Coq stops in it, one for what stands before and one for what stands after."""
    if not modules:
        return
    ran = _put(coq, modules, judged)
    if ran.code == 0:
        _conclude(modules, prepared, ran, judged)
        return
    blamed = _blamed(modules, ran)
    if blamed is None and len(modules) > 1:
        half = len(modules) // 2
        _settle(coq, modules[:half], prepared, judged)
        _settle(coq, modules[half:], prepared, judged)
        return
    place, ruling = blamed or (0, Ruling(Word.UNKNOWN, Why.COQ_ENDED(_first(ran))))
    judged.rulings[modules[place].name] = ruling
    _settle(coq, modules[:place], prepared, judged)
    _settle(coq, modules[place + 1 :], prepared, judged)


def _put(coq: Coq, modules: Sequence[Module], judged: KernelRulings) -> CoqRun:
    ran = coq.run(file(modules) + closing(modules))
    judged.seconds += ran.seconds
    judged.megabytes = max(judged.megabytes, ran.megabytes)
    return ran


def closing(modules: Sequence[Module]) -> str:
    """The end of a file: all theorems as one thing, and what it rests on."""
    proved = "I"
    for x in modules:
        proved = f"(conj {x.name}.proved {proved})"
    return f"Definition {ALL} := {proved}.\nPrint Assumptions {ALL}.\n"


def _conclude(
    modules: Sequence[Module], prepared: Mapping[str, CoqModule], ran: CoqRun, judged: KernelRulings
) -> None:
    axioms = axioms_of(ran.said)
    for x in modules:
        limits = prepared[x.name].limits
        if axioms is None:
            ruling = Ruling(Word.UNKNOWN, Why.AXIOMS_UNSAID())
        elif set(axioms) - AXIOMS:
            ruling = Ruling(Word.REFUSED, Why.AXIOMS(", ".join(sorted(set(axioms) - AXIOMS))))
        else:
            ruling = Ruling(Word.ACCEPTED, NO_REASON, None, limits, axioms)
        judged.rulings[x.name] = ruling


def axioms_of(said: str) -> tuple[str, ...] | None:
    """The names that ``Print Assumptions`` prints, None where it does not speak."""
    if said.strip() == "Closed under the global context":
        return ()
    before, found, listed = said.partition("Axioms:\n")
    return tuple(_AXIOM.findall(listed)) if found and not before.strip() else None


def _blamed(modules: Sequence[Module], ran: CoqRun) -> tuple[int, Ruling] | None:
    """Which module Coq stopped at, and what that means for it; None where Coq does not say."""
    found = _PLACE.search(ran.complained)
    if found is None:
        return None
    line = int(found[1]) - _head_lines()
    for place, x in enumerate(modules):
        if line <= x.lines:
            return place, _why(x, line, " ".join(found[2].split()))
        line -= x.lines
    return None


def _why(module: Module, line: int, said: str) -> Ruling:
    if line >= module.theorem:
        if '"true = true"' in said:
            return Ruling(Word.REFUSED, Why.NOT_BY_COQ())
        if 'Unable to unify "true" with "false"' in said:
            return Ruling(Word.REFUSED, Why.NO_SCHEMA())
        return Ruling(Word.UNKNOWN, Why.COQ_SAYS(said))
    lemma = sum(line >= begins for begins in module.lemmas)
    if lemma:
        return Ruling(Word.UNKNOWN, Why.LEMMA(lemma), lemma)
    return Ruling(Word.UNKNOWN, Why.COQ_DOES_NOT_READ(said))


def _head_lines() -> int:
    return file([]).count("\n")


def _first(ran: CoqRun) -> str:
    return " ".join((ran.complained or ran.said).split())[:200] or f"exit code {ran.code}"


def batches(modules: Mapping[str, CoqModule], count: int) -> Iterator[dict[str, CoqModule]]:
    """About ``count`` parts of equal size."""
    names = list(modules)
    for place in range(min(count, len(names))):
        yield {name: modules[name] for name in names[place::count]}
