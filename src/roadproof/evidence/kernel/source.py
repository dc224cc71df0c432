"""Files of Coq: claims with their tableaux, one module each. The text of claims is the printer's."""

import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.kernel.constructors import term
from roadproof.evidence.kernel.derivation import rational
from roadproof.evidence.kernel.instant import Reason, reason
from roadproof.evidence.kernel.names import comment, literal
from roadproof.evidence.kernel.plain import comparisons
from roadproof.evidence.kernel.printer import CLOSE, Printer
from roadproof.evidence.kernel.statement import Statement
from roadproof.evidence.kernel.tableau import WIDTH, Tableau, coq_tree, q
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names

MOST_COMPARISONS = 8  # of a fact that Coq's own tactics are asked about; with more they do not end
HEAD = """\
From Coq Require Import QArith String List.
From Roadproof Require Import Meaning Text Linear Tableau Products Named.
From Roadproof Require Drive Shown Values.
Import ListNotations.
Open Scope string_scope.
Open Scope nat_scope.
Open Scope term_scope.
Open Scope formula_scope.
"""


class UnreasonedError(RoadproofError):
    """A fact about one instant has no reason, and is too large for Coq's own tactics; ``number`` from 1."""

    def __init__(self, number: int) -> None:
        super().__init__(
            f"lemma {number}, a fact about one instant, has no reason that was found, and more than "
            f"{MOST_COMPARISONS} comparisons: Coq's own tactics are not asked"
        )
        self.number = number


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
    return ClaimText(claim, printer.things, printer.definitions, own_signals(formula))


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
    out: list[str] = []
    printer = Printer(statement.formals)
    printed = claim_text(printer, statement.formula)
    facts = [printer.formula(without_names(lemma)) for lemma, _ in statement.lemmas]
    out += [f"Module {name}."]
    out += comment_lines(_said(statement))
    out += [*claim_lines(printed, statement.bounds), ""]
    out += ["(* From here on it is proof: what is proved is said in the theorem at the end. *)"]
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
    out += [
        "Theorem proved : Roadproof.Meaning.valid bounds claim.",
        "Proof.",
        *(f"  refine ({_theorem(statement, words)} claim tableau", f"    ({held}) _)."),
        "  vm_cast_no_check (eq_refl true).",
        "Qed.",
        f"End {name}.",
    ]
    return Module(name, "\n".join(out) + "\n", tuple(lemmas), theorem)


def _theorem(statement: Statement, facts: Sequence[str]) -> str:
    """The theorem by which a tableau proves the claim, up to what it is told of the claim."""
    given = f"[{'; '.join(map(literal, statement.parameters))}] bounds [{'; '.join(facts)}]"
    if not statement.demanded:
        return f"Roadproof.Tableau.accepted {given}"
    values = (f"({literal(name)}, {q(value)})" for name, value in statement.demanded.items())
    return f"Roadproof.Values.accepted_at {given} [{'; '.join(values)}]"


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
    if statement.premises.count:
        yield f"Under {statement.premises}: premises of the claim, not proved here."


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
