"""No is explained: a proof that no trace satisfies a formula, and the parts of it that clash."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from roadproof.effort import Effort
from roadproof.evidence.certificate import to_json
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.prove.prover import prove
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Specification
from roadproof.verdict import Verdict

SHORTER = 1.5  # units of work for a proof with one part less


@dataclass(frozen=True)
class Impossibility:
    """``certificate`` proves ``not formula`` for all time; ``core`` are parts that already clash.

    ``minimal``: no part of the core can be left out and the rest still be proved to clash.
    """

    core: tuple[str, ...]
    minimal: bool
    certificate: Mapping[str, Any]


def show_impossible(specification: Specification, formula: str, effort: Effort) -> Impossibility | None:
    """A proof in dense, unbounded time that ``formula`` never holds at 0, or None. Raises ``Late``."""
    given, body = split_given(formula)
    whole = prove(specification, f"{given}not ({body})", effort)
    if whole.verdict not in (Verdict.PROVED, Verdict.VACUOUS) or whole.certificate is None:
        return None
    core, minimal = _core(specification, formula, effort.of(effort.units - whole.work))
    return Impossibility(core, minimal, json.loads(to_json(whole.certificate)))


def split_given(claim: str) -> tuple[str, str]:
    """What a claim declares in front, as text to be put in front of others, and the formula behind it."""
    parsed = parse_claim(claim)
    if not parsed.given:
        return "", claim
    return text(syntax.Claim(parsed.given, syntax.Literal_(True))).removesuffix("true"), text(parsed.body)


def _core(specification: Specification, formula: str, effort: Effort) -> tuple[tuple[str, ...], bool]:
    """Leave out one part after the other where the rest still clashes."""
    kept = [text(as_syntax(part, expand=False)) for part in parts(read_claim(specification, formula).formula)]
    kept = list(dict.fromkeys(kept))
    given, _ = split_given(formula)
    for part in tuple(kept):
        rest = [p for p in kept if p != part]
        if effort.units <= 0:
            return tuple(kept), False
        if not rest:
            continue
        claim = f"{given}not ({' and '.join(f'({p})' for p in rest)})"
        found = prove(specification, claim, effort.of(min(effort.units, SHORTER)))
        effort = effort.of(effort.units - found.work)
        if found.verdict in (Verdict.PROVED, Verdict.VACUOUS):
            kept = rest
    return tuple(kept), True


def parts(formula: Formula) -> Iterator[Formula]:
    """The parts of a conjunction, through the names of definitions, down to temporal operators."""
    match formula:
        case f.And(every):
            for part in every:
                yield from parts(part)
        case f.Named(_, _, body) if isinstance(body, f.And | f.Named) and not f.is_state(body):
            yield from parts(body)
        case _:
            yield formula
