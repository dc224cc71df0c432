"""Problems as SMT-LIB 2 files, exact, with a name for each assertion."""

from collections.abc import Iterator, Sequence

from roadproof.engines.encode.problem import All
from roadproof.engines.solve.exact import column_condition, node_definitions, row_conditions
from roadproof.extensions.encoding.naming import Naming, QuestionPart, named, numbered
from roadproof.runtime.records import dataclass

HEAD = """\
(set-option :produce-models true)
(set-option :produce-unsat-cores true)
(set-logic QF_NRA)
"""


@dataclass(frozen=True)
class SmtFile:
    """An SMT-LIB script, and the part of the question that each named assertion encodes."""

    text: str
    assertions: tuple[tuple[str, QuestionPart], ...]


def smt_file(naming: Naming) -> SmtFile:
    """Return the problem as a script that asks for satisfiability; an unsat core lists what conflicts."""
    problem = naming.posed.problem
    columns = naming.unknowns
    parts, conditions = zip(*_assertions(naming, columns), strict=True)
    names = numbered(named(x) for x in parts)
    lines = [f"; {naming.posed.query.text}".replace("\n", " "), HEAD.rstrip()]
    for name, column in zip(columns, problem.columns, strict=True):
        lines.append(f"(declare-const {name} Real)")
        lines.append(f"(assert (! {column_condition(name, column)} :named bounds.{name}))")
    lines += [definition for *_, definition in node_definitions(problem.circuit, columns)]
    lines += [f"(assert (! {x} :named {name}))" for name, x in zip(names, conditions, strict=True)]
    return SmtFile("\n".join([*lines, "(check-sat)\n"]), tuple(zip(names, parts, strict=True)))


def _assertions(naming: Naming, columns: Sequence[str]) -> Iterator[tuple[QuestionPart, str]]:
    """Yield the part and the condition of each row, and of each conjunct of the circuit."""
    problem = naming.posed.problem
    for row in problem.rows:
        part = QuestionPart((), 0) if row.origin is None else naming.part(row.origin)
        yield from ((part, condition) for condition in row_conditions(row, columns))
    circuit = problem.circuit
    names = {id(node): name for node, name, _ in node_definitions(circuit, columns)}
    parts = naming.parts(circuit)
    for conjunct in circuit.parts if isinstance(circuit, All) else (circuit,):
        yield parts[id(conjunct)], names[id(conjunct)]
