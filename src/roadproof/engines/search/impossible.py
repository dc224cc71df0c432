"""No is explained: a proof that no trace satisfies a formula, and the parts of it that clash."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from roadproof.engines.modifier import left_open
from roadproof.engines.prove.induction import prove_of_scenarios
from roadproof.engines.prove.prover import ProofHeuristic, Result, prove
from roadproof.evidence.certificate import Certificate, certificate_data
from roadproof.evidence.strict import JsonObject
from roadproof.library.compose import negation, of_parts
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.parts import parts_of, texts_of
from roadproof.runtime.budget import Effort
from roadproof.runtime.records import dataclass

SHORTER = 1.5  # units of work for a proof with one part less


@dataclass(frozen=True)
class Impossibility:
    """``certificate`` proves for all time that a formula never holds at 0; ``core`` are parts that clash.

    ``minimal``: no part of the core can be left out and the rest still be proved to clash. ``of_core`` proves
    that the core never holds.
    """

    core: tuple[Formula, ...]
    minimal: bool
    certificate: Certificate
    of_core: Certificate

    @property
    def told(self) -> tuple[str, ...]:
        """The core as texts."""
        return texts_of(self.core)

    @property
    def plain(self) -> JsonObject:
        """The certificate as plain data."""
        return certificate_data(replace(self.certificate, tableau=None))  # which files alone have


def show_impossible(specification: Specification, query: Query, effort: Effort) -> Impossibility | None:
    """A proof in dense time that ``query`` never holds at 0, or None. Raises ``BudgetExceeded``."""
    return explain(specification, query, prove_of_scenarios(specification, negation(query), effort), effort)


def explain(
    specification: Specification, query: Query, proof: Result, effort: Effort
) -> Impossibility | None:
    """As ``show_impossible``, where the ``proof`` that ``query`` never holds is known already.

    Where a driver model says what begins, the core is that of what is left open, and proved to be one.
    """
    if not proof.holds or proof.certificate is None:
        return None
    left = effort.of(effort.units - proof.work)
    outline = left_open(specification)
    if outline is None:
        core, minimal, shown = _core(specification, query, left)
        return Impossibility(core, minimal, proof.certificate, shown or proof.certificate)
    shorter, minimal, _ = _core(outline, read_claim(outline, query.text), left)
    said, whole = {*texts_of(shorter)}, tuple(dict.fromkeys(parts_of(query.formula)))
    core = tuple(part for part in whole if {*texts_of((part,))} <= said)
    again = prove(specification, negation(of_parts(query, core)), effort.of(SHORTER)).certificate
    if again is None:
        core, minimal = whole, False
    return Impossibility(core, minimal, proof.certificate, again or proof.certificate)


_Core: TypeAlias = tuple[tuple[Formula, ...], bool, Certificate | None]


def _core(specification: Specification, query: Query, effort: Effort) -> _Core:
    """Leave out one part after the other where the rest still clashes; with a proof that what is left does.

    Each step goes by a hunch, and what is left is proved; where that fails, each step is proved instead.
    There is no proof where all parts are left.
    """
    proofs: list[Certificate] = []
    whole = tuple(dict.fromkeys(parts_of(query.formula)))
    kept, minimal = _shortened(query, whole, effort, ProofHeuristic(specification).has_proof)

    def is_proved(claim: Query, most: Effort) -> tuple[bool, float]:
        found = prove(specification, claim, most)
        proofs.extend(() if found.certificate is None else (found.certificate,))
        return found.holds, found.work

    if kept == whole:
        return kept, minimal, None
    if not is_proved(negation(of_parts(query, kept)), effort.of(SHORTER))[0]:
        kept, minimal = _shortened(query, whole, effort, is_proved)
    return kept, minimal, proofs[-1] if proofs else None


def _shortened(
    query: Query,
    kept: tuple[Formula, ...],
    effort: Effort,
    holds: Callable[[Query, Effort], tuple[bool, float]],
) -> tuple[tuple[Formula, ...], bool]:
    """The parts that are left, and whether each was tried; ``holds`` says also what the answer cost."""
    for part in kept:
        rest = tuple(p for p in kept if p != part)
        if effort.units <= 0:
            return kept, False
        if not rest:
            continue
        clashes, work = holds(negation(of_parts(query, rest)), effort.of(min(effort.units, SHORTER)))
        effort = effort.of(effort.units - work)
        if clashes:
            kept = rest
    return kept, True


def at_start(formula: Formula) -> Formula:
    """What a formula says of time 0 alone, which is judged quickly; true where that is nothing."""
    return f.conjunction(*(part for part in parts_of(formula) if f.is_state(part)))
