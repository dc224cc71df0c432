"""Two formulas side by side: which implies which, by a proof or a drive in each direction."""

import json
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from roadproof.effort import Late
from roadproof.evidence.certificate import to_json
from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import text
from roadproof.logic.syntax import Claim, Expression
from roadproof.prove.prover import prove
from roadproof.spec.library import Specification, load_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Outcome, Request, as_formula, ask

Relation: TypeAlias = Literal["equivalent", "stronger", "weaker", "incomparable", "unknown"]

PROOF = 5.0  # units of work for a proof before a drive is looked for


@dataclass(frozen=True)
class Direction:
    """``claim`` is ``F1 -> F2``: PROVED with a certificate, REFUTED with a drive, or neither."""

    claim: str
    verdict: Verdict
    reason: str
    certificate: str | None
    drive: dict[str, Any] | None


@dataclass(frozen=True)
class Comparison:
    """How the first formula relates to the second: stronger is to imply it and not the reverse."""

    first: str
    second: str
    relation: Relation
    forward: Direction
    backward: Direction


def compare(first: Request, second: Request) -> Comparison:
    """Compare the formulas of two requests, each in its own spec set, on the road and grid of the first.

    Raises as ``ask`` does.
    """
    specification = load_library(first.specs).select(first.set_name, first.options)
    _, one = as_formula(specification, first.what)
    _, other = as_formula(specification.in_set(second.set_name), second.what)
    if second.set_name != first.set_name:
        other = qualified(specification, other, second.set_name)
    forward = _imply(specification, first, one, other)
    backward = _imply(specification, first, other, one)
    return Comparison(one, other, _relation(forward, backward), forward, backward)


def _relation(forward: Direction, backward: Direction) -> Relation:
    match forward.verdict, backward.verdict:
        case Verdict.PROVED, Verdict.PROVED:
            return "equivalent"
        case Verdict.PROVED, Verdict.REFUTED:
            return "stronger"
        case Verdict.REFUTED, Verdict.PROVED:
            return "weaker"
        case Verdict.REFUTED, Verdict.REFUTED:
            return "incomparable"
        case _:
            return "unknown"


def _imply(specification: Specification, request: Request, one: str, other: str) -> Direction:
    """Which of the two is so; UNKNOWN where the clock cuts the search off."""
    claim = f"({one}) -> ({other})"
    try:
        return _decide(specification, request, claim, f"({one}) and not ({other})")
    except Late as late:
        return Direction(claim, Verdict.UNKNOWN, str(late), None, None)


def _decide(specification: Specification, request: Request, claim: str, against: str) -> Direction:
    """Ask for a proof first, which takes a moment where there is one, then for a drive."""
    effort = request.means.effort
    proof = prove(specification, claim, effort.of(min(PROOF, effort.units)))
    if proof.certificate is not None:
        return Direction(claim, Verdict.PROVED, proof.reason, to_json(proof.certificate), None)
    found: Outcome = ask(replace(request, what=against, count=1))
    if found.drives:
        return Direction(claim, Verdict.REFUTED, "", None, found.drives[0])
    if found.impossibility is not None:
        certificate = json.dumps(found.impossibility.certificate, indent=2, ensure_ascii=False)
        return Direction(claim, Verdict.PROVED, "", certificate, None)
    verdict = Verdict.PROVED_BOUNDED if found.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
    return Direction(claim, verdict, found.reason, None, None)


def qualified(specification: Specification, formula: str, set_name: str) -> str:
    """``formula`` with every definition taken from the spec set ``set_name``."""

    def visit(expression: Expression) -> Expression:
        match expression:
            case syntax.Call(name, arguments, at):
                of_set = f"{name}@{set_name}" if name in specification.definitions else name
                return syntax.Call(of_set, tuple(visit(a) for a in arguments), at)
            case syntax.Literal_() | syntax.Name():
                return expression
            case syntax.Prefix() | syntax.Quantified():
                return replace(expression, body=visit(expression.body))
            case syntax.Binary():
                return replace(expression, left=visit(expression.left), right=visit(expression.right))
            case syntax.Chain():
                return replace(expression, parts=tuple(visit(p) for p in expression.parts))
            case syntax.Temporal():
                left = None if expression.left is None else visit(expression.left)
                return replace(expression, left=left, right=visit(expression.right))

    claim = parse_claim(formula)
    return text(Claim(claim.given, visit(claim.body)))
