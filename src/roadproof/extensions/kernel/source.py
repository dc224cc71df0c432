"""Files of Coq: claims with their tableaux, one module each. The text of claims is the printer's."""

import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.kernels import limits_told
from roadproof.extensions.kernel.constructors import term
from roadproof.extensions.kernel.derivation import rational
from roadproof.extensions.kernel.instant import Reason, reason
from roadproof.extensions.kernel.names import comment, literal, q
from roadproof.extensions.kernel.plain import comparisons
from roadproof.extensions.kernel.printer import CLOSE, Printer
from roadproof.extensions.kernel.statement import Instance, Statement
from roadproof.extensions.kernel.tableau import WIDTH, Tableau, coq_tree
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.logic.terms import Term
from roadproof.reasons import Why

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
    """A fact about one instant has no reason, and is too large for Coq's own tactics; ``number`` from 1."""

    def __init__(self, number: int) -> None:
        self.number, self.reason = number, Why.LEMMA_TOO_LARGE(number, MOST_COMPARISONS)
        super().__init__(self.reason)


@dataclass(frozen=True)
class Module:
    """A claim as a module of Coq, with the lines at which facts about one instant and the theorem begin."""

    name: str
    text: str
    lemmas: tuple[int, ...]
    theorem: int

    @property
    def lines(self) -> int:
        return self.text.count("\n")


@dataclass(frozen=True)
class ClaimText:
    """A claim as text of Coq, with what it rests on."""

    claim: str
    things: Sequence[str]
    definitions: Sequence[str]
    own: Sequence[t.Own]


def claim_text(printer: Printer, formula: Formula) -> ClaimText:
    """Raises ``InputError`` for what is not printed."""
    claim = printer.formula(formula)
    return ClaimText(claim, (*printer.things,), (*printer.definitions,), own_signals(formula))


def own_signals(formula: Formula) -> Sequence[t.Own]:
    """The signals of a specification. Raises ``InputError`` where one is declared in two ways."""
    own = own_of([formula])
    if len({(x.name, x.vehicle) for x in own}) < len(own):
        raise InputError(f"a signal is declared in two ways: {', '.join(x.told for x in own)}")
    return own


def module(name: str, statement: Statement, tableau: Tableau) -> Module:
    """The module that proves a statement.

    Raises ``InputError`` for what is not printed, and ``UnreasonedError``.
    """
    printer = Printer(statement.formals)
    printed = claim_text(printer, statement.formula)
    out = [f"Module {name}.", *comment_lines(_said(statement))]
    out += [*claim_lines(printed, statement.bounds), ""]
    out += ["(* From here on it is proof: what is proved is said in the theorem at the end. *)"]
    supposed = _supposed(printer, statement)
    facts = [printer.formula(without_names(lemma)) for lemma, _ in statement.lemmas]
    out += printer.things[len(printed.things) :]
    out += (line for x in printer.definitions[len(printed.definitions) :] for line in wrapped(x))
    out += supposed.lines
    lemmas: list[int] = []
    words = [printer.names.new(f"fact_{number}") for number in range(1, len(facts) + 1)]
    proofs = [printer.names.new(f"{word}_holds") for word in words]
    for (lemma, _), word, proof, fact in zip(statement.lemmas, words, proofs, facts, strict=True):
        lemmas.append(len(out) + 1)
        out += wrapped(f"Definition {word} : formula := {fact}.")
        found = reason(lemma, statement.bounds, printed.own)
        if found is None and len(set(comparisons(lemma))) > MOST_COMPARISONS:
            raise UnreasonedError(len(lemmas))
        out += _proved(found, word, proof)
    held = "Forall_nil _"
    for proof in reversed(proofs):
        held = f"Forall_cons _ {proof} ({held})"
    theorem = len(out) + 1
    out += ["Definition tableau : tree := ("]
    out += [*coq_tree(tableau), ").", ""]
    out += [*_theorem(statement, supposed, words, held), f"End {name}."]
    return Module(name, "\n".join(out) + "\n", tuple(lemmas), theorem)


@dataclass(frozen=True)
class _Supposed:
    """What a tableau proves, by the word for it: the claim, or with instances of ``schemas`` as premises."""

    word: str
    schemas: str
    lines: Sequence[str]


def _supposed(printer: Printer, statement: Statement) -> _Supposed:
    if not statement.instances:
        return _Supposed("claim", "", ())
    made = "; ".join(instance_text(printer, x) for x in statement.instances)
    supposed, schemas = printer.names.new("supposed"), printer.names.new("schemas")
    lines = [
        *wrapped(f"Definition {supposed} : formula := {printer.formula(statement.supposed)}."),
        *wrapped(f"Definition {schemas} : list Roadproof.Schemas.schema := [{made}]."),
    ]
    return _Supposed(supposed, schemas, lines)


def instance_text(printer: Printer, instance: Instance) -> str:
    """An instance as a term of Schemas.v."""
    shown = (printer.term(x) if isinstance(x, Term) else printer.formula(x) for x in instance.arguments)
    return " ".join([f"Roadproof.Schemas.{instance.schema}", *(f"({x})" for x in shown)])


def _theorem(statement: Statement, supposed: _Supposed, facts: Sequence[str], held: str) -> Iterator[str]:
    """That the claim is valid; where it is not what the tableau proves, that is a lemma before."""
    given = f"[{'; '.join(map(literal, statement.parameters))}] bounds [{'; '.join(facts)}]"
    checker = "Tableau.accepted"
    if statement.demanded:
        values = (f"({literal(name)}, {q(value)})" for name, value in statement.demanded.items())
        checker, given = "Values.accepted_at", f"{given} [{'; '.join(values)}]"
    word = "Lemma tableau_proves" if statement.instances else "Theorem proved"
    yield f"{word} : Roadproof.Meaning.valid bounds {supposed.word}."
    yield "Proof."
    yield f"  refine (Roadproof.{checker} {given} {supposed.word} tableau"
    yield f"    ({held}) _)."
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
    """A claim with what it rests on, as it stands in a module; ``bounds``: name, and strictly above 0."""
    kinds = [f"{'above_0' if strict else 'at_least_0'} {literal(p)}" for p, strict in bounds.items()]
    kinds += own_bounds(printed.own, lambda x: f"{rational(x)}%Q")
    return [
        *(*printed.things, ""),
        *(line for definition in printed.definitions for line in wrapped(definition)),
        *("", *wrapped(f"Definition bounds : list bound := [{'; '.join(kinds)}].")),
        *wrapped(f"Definition claim : formula := {printed.claim}."),
    ]


def own_bounds(signals: Iterable[t.Own], number: Callable[[Fraction], str]) -> Iterator[str]:
    """The bounds within which signals of a specification are declared; ``number`` prints them."""
    for x in signals:
        for word, bound in (("own_at_least", x.low), ("own_at_most", x.high)):
            if bound is not None:
                vehicle = literal(x.vehicle) if x.vehicle else '""'
                yield f"{word} {literal(x.name)} {vehicle} {number(bound)}"


def _proved(found: Reason | None, word: str, proof: str) -> Iterator[str]:
    """A fact about one instant with its proof: by its reason, else by what Coq's tactics find."""
    yield f"Lemma {proof} : Roadproof.Meaning.valid_always bounds {word}."
    if found is None:
        yield "Proof. some_instant. Qed."
        return
    yield "Proof."
    atoms = "; ".join(map(term, found.atoms))
    yield from wrapped(f"  refine (Roadproof.Products.settled bounds [{atoms}] {word} {found.written} _).")
    yield "  vm_cast_no_check (eq_refl true)."
    yield "Qed."


def file(modules: Sequence[Module]) -> str:
    """A file with modules, one after the other."""
    return HEAD + "".join(x.text for x in modules)


def _said(statement: Statement) -> Iterator[str]:
    options = ", ".join(f"{name}={value}" for name, value in sorted(statement.options.items()))
    yield f"{statement.label or 'A claim'}, set {statement.set_name}, options {options or 'none'}:"
    yield statement.claim
    if statement.values:
        yield f"At {', '.join(statement.values)}: numbers in place of these parameters."
    if any(not x.is_induction for x in statement.instances):
        yield "It holds of every motion (Motion.v)."
    if statement.limits:
        yield f"Premises: {limits_told(statement.limits)} of vehicles, which the claim assumes."


def comment_lines(said: Iterable[str]) -> list[str]:
    """Words as a comment of Coq."""
    shown = [line for words in said for line in textwrap.wrap(comment(words), WIDTH - 6)]
    return [
        f"(* {shown[0]}",
        *(f"   {line}" for line in shown[1:-1]),
        *(f"   {line}" for line in shown[-1:]),
        "*)",
    ]


def wrapped(text: str) -> list[str]:
    """A definition in lines; names and texts have no blanks in them."""
    lines = textwrap.wrap(text, WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
    return [line.replace(CLOSE, " ") for line in lines]
