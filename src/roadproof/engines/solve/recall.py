"""Sessions that ask z3 only what this process has not asked it before, whatever symbols are called.

z3 answers alike to the same words, so an answer after all that a session has been told may be taken from one
that was told the same. Symbols in bars, of which claims about several road sectors have other ones, are
numbered as they are met. An answer depends on no other session: it is what z3 would say, and its work counts.
"""

import hashlib
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.engines.solve.smt import NO_LIMITS, UNIT, Satisfiability, Session, answer_in, counted_in
from roadproof.runtime.budget import Budget

_SYMBOL = re.compile(r"\|[^|]*\|")
_MOST_CHARACTERS = 32_000_000


class Replies:
    """What z3 has printed, by a digest of all that it was told until then."""

    def __init__(self) -> None:
        self._known: dict[bytes, str] = {}
        self._characters = 0

    def find(self, key: bytes) -> str | None:
        return self._known.get(key)

    def keep(self, key: bytes, said: str) -> None:
        """Keep a reply; where there are too many, all others are forgotten."""
        self._characters += len(said)
        if self._characters > _MOST_CHARACTERS:
            self._known.clear()
            self._characters = len(said)
        self._known[key] = said


REPLIES = Replies()


class RecallingSession(Session):
    """A session whose replies are recalled where z3 has given them before."""

    def __init__(self, unit: int = UNIT) -> None:
        self._names: dict[str, str] = {}
        self._waiting: list[str] = []  # what z3 has not been told
        self._digest = hashlib.blake2b(digest_size=16)
        self._is_behind = False  # whether some of that are questions
        self._recalls = True
        super().__init__(unit)

    def tell(self, commands: str) -> None:
        self._count(commands)
        self._note(commands)

    def _note(self, commands: str) -> None:
        short = _SYMBOL.sub(self._numbered, commands)
        self._digest.update(short.encode())
        self._digest.update(b"\n")
        self._waiting.append(short)

    def _numbered(self, found: re.Match[str]) -> str:
        return self._names.setdefault(found[0], f"|{len(self._names)}|")

    def _reply(self, question: str, limits: str = "", most: int | None = None) -> str:
        self._count(limits + question)
        self._note(question)
        key = self._digest.digest()
        said = REPLIES.find(key) if self._recalls else None
        if said is not None and (most is None or counted_in(said) - self._counted <= most):
            self._is_behind = True
            return said
        if self._is_behind:
            self._run(NO_LIMITS + "\n".join(self._waiting[:-1]))
            del self._waiting[:-1]
        said = self._run(limits + "\n".join(self._waiting))
        self._waiting.clear()
        self._is_behind = False
        self._recalls = self._recalls and not (limits and answer_in(said) == "unknown")
        if self._recalls:
            REPLIES.keep(key, said)
        return said


def ask(script: str, meter: Budget) -> Satisfiability:
    """The answer of z3 to a whole script that ends in ``check-sat``. Raises ``BudgetExceeded``."""
    return RecallingSession().answer(script, meter)


def solve(script: str, symbols: Sequence[str], meter: Budget) -> Mapping[str, Fraction | bool] | None:
    """Values of ``symbols`` in a model that z3 finds for a whole script, or None where it finds none.

    Numbers that are not rational are left out. Raises ``BudgetExceeded``.
    """
    session = RecallingSession()
    if session.answer(script, meter) != "sat":
        return None
    read = session.values(symbols)
    return {s: v for s, v in zip(symbols, read, strict=True) if v is not None}
