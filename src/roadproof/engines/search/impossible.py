"""Explains why a formula never holds: a proof, and a small set of its parts that clash."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from roadproof.engines.modifier import with_opaque_driver
from roadproof.engines.prove.induction import prove_via_opaque_driver
from roadproof.engines.prove.prover import ProofHeuristic, ProverResult, prove
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import certificate_data
from roadproof.evidence.strict import JsonObject
from roadproof.library.compose import conjunction_of, negation
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
    """A proof for all time that a formula never holds at 0, and ``core``, parts of it that clash.

    ``minimal``: without any part of the core, no clash could be proved. ``of_core`` proves that the core
    never holds.
    """

    core: tuple[Formula, ...]
    minimal: bool
    certificate: Certificate
    of_core: Certificate

    @property
    def core_texts(self) -> tuple[str, ...]:
        """The core as texts."""
        return texts_of(self.core)

    @property
    def plain(self) -> JsonObject:
        """The certificate as plain data."""
        return certificate_data(replace(self.certificate, tableau=None))  # which files alone have


def show_impossible(specification: Specification, query: Query, effort: Effort) -> Impossibility | None:
    """Return a proof in dense time that ``query`` never holds at 0, or None. Raises ``BudgetExceeded``."""
    return explain_impossibility(
        specification, query, prove_via_opaque_driver(specification, negation(query), effort), effort
    )


def explain_impossibility(
    specification: Specification, query: Query, proof: ProverResult, effort: Effort
) -> Impossibility | None:
    """Return clashing parts of ``query``, given the ``proof`` that it never holds; None without a proof.

    Where a driver model restricts the question, the core is found with an opaque driver, then proved.
    """
    if not proof.holds or proof.certificate is None:
        return None
    left = effort.with_units(effort.units - proof.work)
    outline = with_opaque_driver(specification)
    if outline is None:
        core, minimal, shown = _core(specification, query, left)
        return Impossibility(core, minimal, proof.certificate, shown or proof.certificate)
    shorter, minimal, _ = _core(outline, read_claim(outline, query.text), left)
    texts, whole = {*texts_of(shorter)}, tuple(dict.fromkeys(parts_of(query.formula)))
    core = tuple(part for part in whole if {*texts_of((part,))} <= texts)
    again = prove(
        specification, negation(conjunction_of(query, core)), effort.with_units(SHORTER)
    ).certificate
    if again is None:
        core, minimal = whole, False
    return Impossibility(core, minimal, proof.certificate, again or proof.certificate)


_Core: TypeAlias = tuple[tuple[Formula, ...], bool, Certificate | None]


def _core(specification: Specification, query: Query, effort: Effort) -> _Core:
    """Leave out parts as long as the rest still clashes; return the rest, whether it is minimal, and a proof.

    Each step is tested by a heuristic and the rest is proved; where that fails, each step is proved instead.
    No proof is returned where all parts remain.
    """
    proofs: list[Certificate] = []
    whole = tuple(dict.fromkeys(parts_of(query.formula)))
    core, minimal = _shortened(query, whole, effort, ProofHeuristic(specification).has_proof)

    def is_proved(claim: Query, most: Effort) -> tuple[bool, float]:
        result = prove(specification, claim, most)
        proofs.extend(() if result.certificate is None else (result.certificate,))
        return result.holds, result.work

    if core == whole:
        return core, minimal, None
    if not is_proved(negation(conjunction_of(query, core)), effort.with_units(SHORTER))[0]:
        core, minimal = _shortened(query, whole, effort, is_proved)
    return core, minimal, proofs[-1] if proofs else None


def _shortened(
    query: Query,
    core: tuple[Formula, ...],
    effort: Effort,
    holds: Callable[[Query, Effort], tuple[bool, float]],
) -> tuple[tuple[Formula, ...], bool]:
    """Return the remaining parts, and whether each was tried; ``holds`` also returns the work it took."""
    for part in core:
        rest = tuple(p for p in core if p != part)
        if effort.units <= 0:
            return core, False
        if not rest:
            continue
        clashes, work = holds(
            negation(conjunction_of(query, rest)), effort.with_units(min(effort.units, SHORTER))
        )
        effort = effort.with_units(effort.units - work)
        if clashes:
            core = rest
    return core, True


def at_start(formula: Formula) -> Formula:
    """Return the parts of a formula about time 0 alone, which are judged quickly; true where it has none."""
    return f.conjunction(*(part for part in parts_of(formula) if f.is_state(part)))
