"""z3 sessions that reuse replies of this process, whatever the symbols are called.

z3 gives the same reply to the same text. So a reply may be reused where everything sent before it agrees.
Symbols in bars, which differ between claims about road sectors, are numbered as they occur. The work of a
reused reply counts in full, so no answer depends on other sessions.
"""

import hashlib
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.engines.solve.smt import (
    NO_LIMITS,
    UNIT,
    Satisfiability,
    Session,
    parse_satisfiability,
    resource_count,
)
from roadproof.runtime.budget import Budget

_SYMBOL = re.compile(r"\|[^|]*\|")
_MOST_CHARACTERS = 32_000_000


class Replies:
    """The replies of z3 by a digest of all text sent before them."""

    def __init__(self) -> None:
        self._known: dict[bytes, str] = {}
        self._characters = 0

    def find(self, key: bytes) -> str | None:
        return self._known.get(key)

    def store(self, key: bytes, reply: str) -> None:
        """Store a reply; when too much is stored, all others are dropped."""
        self._characters += len(reply)
        if self._characters > _MOST_CHARACTERS:
            self._known.clear()
            self._characters = len(reply)
        self._known[key] = reply


REPLIES = Replies()


class RecallingSession(Session):
    """A session that reuses stored replies of z3."""

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

    def _numbered(self, match: re.Match[str]) -> str:
        return self._names.setdefault(match[0], f"|{len(self._names)}|")

    def _reply(self, question: str, limits: str = "", most: int | None = None) -> str:
        self._count(limits + question)
        self._note(question)
        key = self._digest.digest()
        reply = REPLIES.find(key) if self._recalls else None
        if reply is not None and (most is None or resource_count(reply) - self._counted <= most):
            self._is_behind = True
            return reply
        if self._is_behind:
            self._run(NO_LIMITS + "\n".join(self._waiting[:-1]))
            del self._waiting[:-1]
        reply = self._run(limits + "\n".join(self._waiting))
        self._waiting.clear()
        self._is_behind = False
        self._recalls = self._recalls and not (limits and parse_satisfiability(reply) == "unknown")
        if self._recalls:
            REPLIES.store(key, reply)
        return reply


def check_sat(script: str, meter: Budget) -> Satisfiability:
    """Return z3's answer to a whole script that ends in ``check-sat``. Raises ``BudgetExceeded``."""
    return RecallingSession().answer(script, meter)


def find_model(script: str, symbols: Sequence[str], meter: Budget) -> Mapping[str, Fraction | bool] | None:
    """Return values of ``symbols`` in a model of a whole script; None where z3 finds no model.

    Irrational values are left out. Raises ``BudgetExceeded``.
    """
    session = RecallingSession()
    if session.answer(script, meter) != "sat":
        return None
    read = session.values(symbols)
    return {s: v for s, v in zip(symbols, read, strict=True) if v is not None}
