"""Coq files: claims with their tableaux, one module each. ``printer.py`` prints the claims."""

import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.kernels import limits_text
from roadproof.extensions.kernel.constructors import term
from roadproof.extensions.kernel.derivation import rational
from roadproof.extensions.kernel.instant import InstantProof, find_instant_proof
from roadproof.extensions.kernel.names import comment, literal, q
from roadproof.extensions.kernel.plain import comparisons
from roadproof.extensions.kernel.printer import FIXED_SPACE, Printer
from roadproof.extensions.kernel.statement import Instance, Statement
from roadproof.extensions.kernel.tableau import WIDTH, Tableau, coq_tree
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.logic.terms import Term
from roadproof.reasons import ReasonKind

MOST_COMPARISONS = 8  # of a fact that Coq's own tactics are asked about; with more they do not end
HEAD = """\
From Coq Require Import QArith String List.
From Roadproof Require Import Meaning Text Linear Tableau Products Named.
From Roadproof Require Drive Shown Values Motion Schemas Programs Refuted.
Import ListNotations.
Open Scope string_scope.
Open Scope nat_scope.
Open Scope term_scope.
Open Scope formula_scope.
"""


class UnreasonedError(RoadproofError):
    """A fact about one instant has no proof, and is too large for Coq's own tactics; ``number`` from 1."""

    def __init__(self, number: int) -> None:
        self.number, self.reason = number, ReasonKind.LEMMA_TOO_LARGE(number, MOST_COMPARISONS)
        super().__init__(self.reason)


@dataclass(frozen=True)
class Module:
    """A claim as a Coq module, with the first lines of the facts about one instant and of the theorem."""

    name: str
    text: str
    lemmas: tuple[int, ...]
    theorem: int

    @property
    def lines(self) -> int:
        """The number of lines."""
        return self.text.count("\n")


@dataclass(frozen=True)
class ClaimText:
    """A claim as text of Coq, with the definitions that it uses."""

    claim: str
    things: Sequence[str]
    definitions: Sequence[str]
    custom: Sequence[t.CustomSignal]


def claim_text(printer: Printer, formula: Formula) -> ClaimText:
    """Return the printed claim. Raises ``InputError`` if it cannot be printed."""
    claim = printer.formula(formula)
    return ClaimText(claim, (*printer.things,), (*printer.definitions,), custom_signals_in_order(formula))


def custom_signals_in_order(formula: Formula) -> Sequence[t.CustomSignal]:
    """Return the custom signals of a formula. Raises ``InputError`` if one has two declarations."""
    signals = custom_signals_of([formula])
    if len({(x.name, x.vehicle) for x in signals}) < len(signals):
        raise InputError(f"a signal is declared in two ways: {', '.join(x.text for x in signals)}")
    return signals


def module(name: str, statement: Statement, tableau: Tableau) -> Module:
    """Return the module that proves a statement.

    Raises ``InputError`` if it cannot be printed, and ``UnreasonedError``.
    """
    printer = Printer(statement.formals)
    claim = claim_text(printer, statement.formula)
    lines_of_module = [f"Module {name}.", *comment_lines(_description(statement))]
    lines_of_module += [*claim_lines(claim, statement.bounds), ""]
    lines_of_module += ["(* From here on it is proof: what is proved is said in the theorem at the end. *)"]
    supposed = _supposed(printer, statement)
    facts = [printer.formula(without_names(lemma)) for lemma, _ in statement.lemmas]
    lines_of_module += printer.things[len(claim.things) :]
    lines_of_module += (line for x in printer.definitions[len(claim.definitions) :] for line in wrapped(x))
    lines_of_module += supposed.lines
    lemmas: list[int] = []
    fact_names = [printer.names.new(f"fact_{number}") for number in range(1, len(facts) + 1)]
    proofs = [printer.names.new(f"{word}_holds") for word in fact_names]
    for (lemma, _), word, proof, fact in zip(statement.lemmas, fact_names, proofs, facts, strict=True):
        lemmas.append(len(lines_of_module) + 1)
        lines_of_module += wrapped(f"Definition {word} : formula := {fact}.")
        proof_of_fact = find_instant_proof(lemma, statement.bounds, claim.custom)
        if proof_of_fact is None and len(set(comparisons(lemma))) > MOST_COMPARISONS:
            raise UnreasonedError(len(lemmas))
        lines_of_module += _lemma_lines(proof_of_fact, word, proof)
    conjunction = "Forall_nil _"
    for proof in reversed(proofs):
        conjunction = f"Forall_cons _ {proof} ({conjunction})"
    theorem = len(lines_of_module) + 1
    lines_of_module += ["Definition tableau : tree := ("]
    lines_of_module += [*coq_tree(tableau), ").", ""]
    lines_of_module += [*_theorem(statement, supposed, fact_names, conjunction), f"End {name}."]
    return Module(name, "\n".join(lines_of_module) + "\n", tuple(lemmas), theorem)


@dataclass(frozen=True)
class _Supposed:
    """The formula that a tableau proves, by name: the claim, possibly with ``schemas`` as premises."""

    word: str
    schemas: str
    lines: Sequence[str]


def _supposed(printer: Printer, statement: Statement) -> _Supposed:
    if not statement.instances:
        return _Supposed("claim", "", ())
    instances = "; ".join(instance_text(printer, x) for x in statement.instances)
    supposed, schemas = printer.names.new("supposed"), printer.names.new("schemas")
    lines = [
        *wrapped(f"Definition {supposed} : formula := {printer.formula(statement.supposed)}."),
        *wrapped(f"Definition {schemas} : list Roadproof.Schemas.schema := [{instances}]."),
    ]
    return _Supposed(supposed, schemas, lines)


def instance_text(printer: Printer, instance: Instance) -> str:
    """Return an instance as a term of Schemas.v."""
    shown = (printer.term(x) if isinstance(x, Term) else printer.formula(x) for x in instance.arguments)
    return " ".join([f"Roadproof.Schemas.{instance.schema}", *(f"({x})" for x in shown)])


def _theorem(
    statement: Statement, supposed: _Supposed, facts: Sequence[str], proof_of_facts: str
) -> Iterator[str]:
    """Yield the theorem that the claim is valid, after a lemma if the tableau proves another formula."""
    arguments = f"[{'; '.join(map(literal, statement.parameters))}] bounds [{'; '.join(facts)}]"
    checker = "Tableau.accepted"
    if statement.demanded:
        values = (f"({literal(name)}, {q(value)})" for name, value in statement.demanded.items())
        checker, arguments = "Values.accepted_at", f"{arguments} [{'; '.join(values)}]"
    word = "Lemma tableau_proves" if statement.instances else "Theorem proved"
    yield f"{word} : Roadproof.Meaning.valid bounds {supposed.word}."
    yield "Proof."
    yield f"  refine (Roadproof.{checker} {arguments} {supposed.word} tableau"
    yield f"    ({proof_of_facts}) _)."
    yield "  vm_cast_no_check (eq_refl true)."
    yield "Qed."
    if statement.instances:
        is_general = all(x.is_induction for x in statement.instances)
        valid = "Meaning.valid" if is_general else "Motion.valid_of_motions"
        holds = "holds_by_induction" if is_general else "holds_of_motions"
        yield f"Theorem proved : Roadproof.{valid} bounds claim."
        yield "Proof."
        yield f"  refine (Roadproof.Schemas.{holds} bounds {supposed.schemas} {supposed.word} claim"
        yield "    tableau_proves _)."
        yield "  vm_compute. reflexivity."
        yield "Qed."


def claim_lines(printed: ClaimText, bounds: Mapping[str, bool]) -> list[str]:
    """Return a claim and its definitions as lines of a module; ``bounds``: name, and strictly above 0."""
    kinds = [f"{'above_0' if strict else 'at_least_0'} {literal(p)}" for p, strict in bounds.items()]
    kinds += bounds_of_custom_signals(printed.custom, lambda x: f"{rational(x)}%Q")
    return [
        *(*printed.things, ""),
        *(line for definition in printed.definitions for line in wrapped(definition)),
        *("", *wrapped(f"Definition bounds : list bound := [{'; '.join(kinds)}].")),
        *wrapped(f"Definition claim : formula := {printed.claim}."),
    ]


def bounds_of_custom_signals(
    signals: Iterable[t.CustomSignal], number: Callable[[Fraction], str]
) -> Iterator[str]:
    """Yield the declared bounds of custom signals; ``number`` prints a number."""
    for signal in signals:
        for word, bound in (("own_at_least", signal.low), ("own_at_most", signal.high)):
            if bound is not None:
                vehicle = literal(signal.vehicle) if signal.vehicle else '""'
                yield f"{word} {literal(signal.name)} {vehicle} {number(bound)}"


def _lemma_lines(instant_proof: InstantProof | None, word: str, proof: str) -> Iterator[str]:
    """Yield a fact about one instant with its proof; without one, Coq's tactics must prove it."""
    yield f"Lemma {proof} : Roadproof.Meaning.valid_always bounds {word}."
    if instant_proof is None:
        yield "Proof. some_instant. Qed."
        return
    yield "Proof."
    atoms = "; ".join(map(term, instant_proof.atoms))
    yield from wrapped(
        f"  refine (Roadproof.Products.settled bounds [{atoms}] {word} {instant_proof.proof_text} _)."
    )
    yield "  vm_cast_no_check (eq_refl true)."
    yield "Qed."


def file(modules: Sequence[Module]) -> str:
    """Return a Coq file with modules, one after the other."""
    return HEAD + "".join(x.text for x in modules)


def _description(statement: Statement) -> Iterator[str]:
    options = ", ".join(f"{name}={value}" for name, value in sorted(statement.options.items()))
    yield f"{statement.label or 'A claim'}, set {statement.set_name}, options {options or 'none'}:"
    yield statement.claim
    if statement.values:
        yield f"At {', '.join(statement.values)}: numbers in place of these parameters."
    if any(not x.is_induction for x in statement.instances):
        yield "It holds of every motion (Motion.v)."
    if statement.limits:
        yield f"Premises: {limits_text(statement.limits)} of vehicles, which the claim assumes."


def comment_lines(texts: Iterable[str]) -> list[str]:
    """Return texts as a Coq comment."""
    shown = [line for words in texts for line in textwrap.wrap(comment(words), WIDTH - 6)]
    return [
        f"(* {shown[0]}",
        *(f"   {line}" for line in shown[1:-1]),
        *(f"   {line}" for line in shown[-1:]),
        "*)",
    ]


def wrapped(text: str) -> list[str]:
    """Return a definition as lines; names and strings contain no blanks."""
    lines = textwrap.wrap(text, WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
    return [line.replace(FIXED_SPACE, " ") for line in lines]
