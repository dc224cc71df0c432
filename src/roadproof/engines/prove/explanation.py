"""Why a formula is true or false in a state: few of its atoms, which are enough for that.

A claim about one instant is false wherever these are as they are there, whatever else is true. A solver that
is asked for such a state is not asked for more.
"""

from collections.abc import Mapping
from typing import TypeAlias

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula

Reason: TypeAlias = dict[str, bool]


def is_plain(formula: Formula) -> bool:
    """Whether an abstracted formula combines atoms and nothing else, at one instant."""
    match formula:
        case f.Truth() | f.Application():
            return True
        case f.Not() | f.And() | f.Or():
            return all(map(is_plain, f.children(formula)))
        case _:
            return False


def reason(formula: Formula, value: bool, truths: Mapping[str, bool]) -> Reason | None:
    """Atoms with their ``truths`` that make a plain ``formula`` have this ``value``; None where it has not.

    Of parts of which one is enough, that with the fewest atoms, the first of these.
    """
    match formula:
        case f.Truth(known):
            return {} if known == value else None
        case f.Application(name, _, _):
            return {name: value} if truths.get(name) == value else None
        case f.Not(body):
            return reason(body, not value, truths)
        case f.And(parts) | f.Or(parts):
            found = [reason(part, value, truths) for part in parts]
            enough = [x for x in found if x is not None]
            if isinstance(formula, f.And) != value:
                return min(enough, key=len, default=None)
            return {k: v for x in enough for k, v in x.items()} if len(enough) == len(found) else None
        case _:
            raise ValueError(f"not plain: {type(formula).__name__}")
