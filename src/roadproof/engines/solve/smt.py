"""The only access to z3 and cvc5: sessions that exchange SMT-LIB 2 text.

Every query is text, so it can be written to a file and given to another solver.
"""

import math
import re
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, TypeAlias

from roadproof.errors import MissingSolverError
from roadproof.runtime.budget import Budget

if TYPE_CHECKING:
    import z3

# What is counted in about a second; by z3 up to 4 million on linear queries, 0.3 on polynomial ones.
UNIT = 1_000_000
# Units of work for what z3 does not count: a context made and removed, a command read, a character of it.
CONTEXT, COMMAND, CHARACTER = 4.5e-3, 1e-4, 2e-7
UNIT_CVC5 = 200_000
_MOST = 4_000_000_000  # both count in 32 bits
NO_LIMITS = "(set-option :rlimit 0)(set-option :timeout 4294967295)\n"
_TOKEN = re.compile(r"[()]|(?:\|[^|]*(?:\||$)|[^()\s|])+")  # what stands between bars is one word

Satisfiability: TypeAlias = Literal["sat", "unsat", "unknown"]
SExpression: TypeAlias = "str | list[SExpression]"


class SolverError(RuntimeError):
    """The solver rejected our text, which is a fault of ours."""


class Session:
    """A z3 context that keeps declarations and assertions between calls."""

    def __init__(self, unit: int = UNIT) -> None:
        """``unit``: how much of what z3 counts is a unit of work."""
        self._unit = unit
        self._counted = 0
        self._unspent = CONTEXT
        self._context: z3.Context | None = None
        self.tell("(set-option :produce-models true)(set-option :produce-unsat-cores true)")

    def tell(self, commands: str) -> None:
        """Run SMT-LIB commands that print nothing. Raises ``SolverError``, perhaps with a later question.

        Their cost counts with the next answer.
        """
        self._count(commands)
        self._run(commands)

    def _reply(self, question: str, limits: str = "", most: int | None = None) -> str:
        """Return the text that z3 prints for commands that end in a question, within ``limits``.

        ``most``: the resource count that ``limits`` allow. Raises ``SolverError``.
        """
        self._count(limits + question)
        return self._run(limits + question)

    def _count(self, commands: str) -> None:
        self._unspent += COMMAND + CHARACTER * len(commands)

    def _run(self, commands: str) -> str:
        """Run commands and return the text that z3 prints. Raises ``SolverError``."""
        import z3  # here, because many answers need no solver

        if self._context is None:
            z3.Context.owner = False  # of one that Ctrl-C meets while it is made, which its end asks for
            self._context = z3.Context()
        try:
            answer: str = z3.Z3_eval_smtlib2_string(self._context.ref(), commands)
        except z3.Z3Exception as error:
            raise SolverError(f"z3 refused: {error}") from None
        if "(error" in answer:
            raise SolverError(f"z3 refused: {answer.strip()}")
        return answer

    def close(self) -> None:
        """Release the z3 context, where this object itself lives longer. No commands may follow."""
        self._context = None

    def check(self, assuming: Sequence[str] = (), meter: Budget | None = None) -> Satisfiability:
        """Run ``check-sat`` under Boolean constants or their negations, within what ``meter`` has left."""
        query = f"(check-sat-assuming ({' '.join(assuming)}))" if assuming else "(check-sat)"
        return self.answer(query, meter)

    def check_plainly(self, meter: Budget, seed: int = 0) -> Satisfiability:
        """Run ``check-sat`` with z3's SMT core alone, without the strategies that z3 tries before it.

        On polynomial arithmetic with many disjunctions, those spend most of a minute in vain.
        """
        return self.answer(f"(check-sat-using (using-params smt :random_seed {seed}))", meter)

    def answer(self, commands: str, meter: Budget | None) -> Satisfiability:
        """Return the answer to commands that end in a check, within what ``meter`` has left.

        ``unknown`` where the work is used up, or z3 gives up. Raises ``BudgetExceeded``.
        """
        if meter is None:
            return parse_satisfiability(self._reply(commands, NO_LIMITS))
        if meter.is_exhausted():
            return "unknown"
        work, milliseconds = _limits(meter, self._unit)
        limits = f"(set-option :rlimit {work})(set-option :timeout {milliseconds})\n"
        reply = self._reply(f"{commands}\n(get-info :rlimit)", limits, work)
        counted = resource_count(reply)
        meter.spend((counted - self._counted) / self._unit + self._unspent)
        self._counted, self._unspent = counted, 0.0
        answer = parse_satisfiability(reply)
        if answer == "unknown":
            meter.seconds_left()
        return answer

    def core(self) -> list[str]:
        """Return the assumptions that the last ``unsat`` used."""
        read = parse_sexpression(self._reply("(get-unsat-core)"))
        return [x for x in read if isinstance(x, str)]

    def values(self, expressions: Sequence[str]) -> list[Fraction | bool | None]:
        """Return values in the last model, in order; None for an irrational number."""
        if not expressions:
            return []
        return [*_parse_values(self._reply(f"(get-value ({' '.join(expressions)}))"))]


def _limits(meter: Budget, unit: int) -> tuple[int, int]:
    """Return the remaining resource count and milliseconds, rounded up. Raises ``BudgetExceeded``."""
    milliseconds = math.ceil(meter.seconds_left() * 1000)
    return max(1, min(_MOST, math.ceil(min(meter.left(), _MOST) * unit))), min(_MOST, milliseconds)


def resource_count(reply: str) -> int:
    """Return the resource count at the end of a reply of z3."""
    return int(reply[reply.rindex(":rlimit") + 7 :].strip(" )\n"))


def parse_satisfiability(text: str) -> Satisfiability:
    """Return the answer to a check from the text of a solver."""
    words = text.split()
    if "unsat" in words:
        return "unsat"
    return "sat" if "sat" in words else "unknown"


def check_sat(script: str, solver: str = "z3", meter: Budget | None = None) -> Satisfiability:
    """Return the answer of ``solver`` (z3 or cvc5) to an SMT-LIB script that ends in ``check-sat``.

    Raises ``MissingSolverError`` where cvc5 is not installed, and ``BudgetExceeded``.
    """
    return Session().answer(script, meter) if solver == "z3" else _ask_cvc5(script, meter)


def _ask_cvc5(script: str, meter: Budget | None) -> Satisfiability:
    try:
        import cvc5
    except ImportError:
        raise MissingSolverError("solver=cvc5 is not installed: pip install cvc5, or ask z3") from None
    solver = cvc5.Solver()
    # Without it, cvc5 finds no end to one of the cases of the RSS guarantee, and with it it takes 0.03 s.
    solver.setOption("decision", "justification")
    if meter is not None:
        if meter.is_exhausted():
            return "unknown"
        work, milliseconds = _limits(meter, UNIT_CVC5)
        solver.setOption("rlimit-per", str(work))
        solver.setOption("tlimit-per", str(milliseconds))
    symbols = cvc5.SymbolManager(solver)
    parser = cvc5.InputParser(solver, symbols)
    parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, script, "query")
    printed: list[str] = []
    while not (command := parser.nextCommand()).isNull():
        printed.append(str(command.invoke(solver, symbols)))
    if meter is not None:
        used = solver.getStatistics().get("resource::resourceUnitsUsed").get("value", 0)
        meter.spend(used / UNIT_CVC5)
    answer = parse_satisfiability(" ".join(printed))
    if answer == "unknown" and meter is not None:
        meter.seconds_left()
    return answer


def parse_sexpression(text: str) -> list[SExpression]:
    """Return the first parenthesised expression of ``text``."""
    stack: list[list[SExpression]] = [[]]
    for token in _TOKEN.findall(text):
        if token == "(":
            stack.append([])
        elif token == ")":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(token)
    first = stack[0][0] if stack[0] else []
    return first if isinstance(first, list) else [first]


@lru_cache(maxsize=4096)
def _parse_values(reply: str) -> tuple[Fraction | bool | None, ...]:
    """Return the values that a solver prints, each after its expression."""
    return tuple(read_value(pair[1]) for pair in parse_sexpression(reply))


def read_value(value: SExpression) -> Fraction | bool | None:
    """Return a solver's value as a rational or truth value; None for an irrational number."""
    match value:
        case "true" | "false":
            return value == "true"
        case str():
            whole = value.removesuffix(".0")
            return Fraction(int(whole) if whole.isdecimal() else value)
        case ["-", inner]:
            read = read_value(inner)
            return None if read is None else -Fraction(read)
        case ["/", upper, lower]:
            top, bottom = read_value(upper), read_value(lower)
            return None if top is None or bottom is None else Fraction(top) / Fraction(bottom)
        case _:  # open: expressions of a solver
            return None
