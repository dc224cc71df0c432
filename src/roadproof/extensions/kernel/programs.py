"""Programs with refutation trees, printed for Coq and for the extracted program.

There, columns, rows and nodes count from 1, since they are looked up by positive numbers.
"""

from collections.abc import Iterator, Sequence
from typing import assert_never

from roadproof.evidence.program import (
    CaseSplit,
    ColumnSplit,
    Conjunction,
    Disjunction,
    DisjunctiveProgram,
    Fact,
    Linear,
    Node,
    Tree,
    WeightedSum,
)
from roadproof.extensions.kernel.accept import CoqModule
from roadproof.extensions.kernel.names import comment
from roadproof.extensions.kernel.source import Module, comment_lines, wrapped


def prepare(name: str, titles: Sequence[str], pairs: Sequence[tuple[DisjunctiveProgram, Tree]]) -> CoqModule:
    """Return programs with their trees as a Coq module; ``titles``: their descriptions, for a comment."""
    lines = [f"Module {name}.", "Import Roadproof.Programs Roadproof.Refuted.", "Open Scope positive_scope."]
    lines += comment_lines(titles)
    for k, (program, _) in enumerate(pairs, 1):
        fields = "; ".join(f"{field} := {x}" for field, x in _fields(program).items())
        lines += wrapped(f"Definition question_{k} : program := {{| {fields} |}}.")
    lines += ["(* From here on it is proof: what is proved is said in the theorem at the end. *)"]
    theorem = len(lines) + 1
    for k, (program, tree) in enumerate(pairs, 1):
        lines += wrapped(f"Definition tree_{k} : tree := {_tree(tree, len(program.box))}.")
    goal = " /\\ ".join(f"(forall x, ~ solves x question_{k})" for k in range(1, len(pairs) + 1))
    lines += [*wrapped(f"Theorem proved : {goal}."), "Proof."]
    for k in range(1, len(pairs) + 1):
        lines += ["  split."] if k < len(pairs) else []
        lines += [f"  {{ apply (no_solution question_{k} tree_{k}). vm_cast_no_check (eq_refl true). }}"]
    lines += ["Qed.", f"End {name}."]
    return CoqModule(Module(name, "\n".join(lines) + "\n", (), theorem))


def form(name: str, titles: Sequence[str], pairs: Sequence[tuple[DisjunctiveProgram, Tree]]) -> CoqModule:
    """Return programs with their trees as a form of ``proofs/kernel/ocaml/reader.ml``."""
    fields = ((*_fields(program).values(), f"({_tree(tree, len(program.box))})") for program, tree in pairs)
    programs = _list("\n  ".join(x) for x in fields)
    text = f'(none_within {name} "{comment(" ".join(titles))}"\n {programs})\n'
    return CoqModule(Module(name, text, (), 0))


def _fields(program: DisjunctiveProgram) -> dict[str, str]:
    """Return the fields of ``program`` in Programs.v by name, in order."""
    columns = len(program.box)
    return {
        "scale": str(program.scale),
        "columns": _list(f"a_column {k} {_z(a)} {_z(b)}" for k, (a, b) in enumerate(program.box, 1)),
        "products": _list(
            f"a_product {k} {i + 1} {j + 1}" for k, (i, j) in enumerate(program.products, columns + 1)
        ),
        "equal": _list(f"a_row {n} {_linear(x)}" for n, x in enumerate(program.equal, 1)),
        "above": _list(f"a_row {n} {_linear(x)}" for n, x in enumerate(program.above, 1)),
        "nodes": _list(_node(n, x) for n, x in enumerate(program.nodes, 1)),
        "condition": str(len(program.nodes)),
    }


def _node(number: int, node: Node) -> str:
    match node:
        case Linear():
            return f"a_leaf {number} {str(node.strict).lower()} {_linear(node)}"
        case Conjunction(parts):
            return f"a_conjunction {number} {_numbers(parts)}"
        case Disjunction(parts):
            return f"a_disjunction {number} {_numbers(parts)}"
        case _:
            assert_never(node)


def _linear(linear: Linear) -> str:
    """Return a linear term sorted by column, since the checker adds up sums in this order."""
    terms = _list(f"a_term {column + 1} {_z(factor)}" for column, factor in sorted(linear.terms))
    return f"{terms} {_z(linear.constant)}"


def _tree(tree: Tree, columns: int) -> str:
    """Return a tree, printed from the leaves up without recursion, since it may be deep."""
    printed: list[str] = []
    waiting: list[tuple[Tree, bool]] = [(tree, False)]
    while waiting:
        branch, ready = waiting.pop()
        match branch:
            case WeightedSum(weights):
                printed.append(
                    f"Sum {_list(f'a_multiple ({_fact(x, columns)}) {_z(w)}' for x, w in weights)}"
                )
            case CaseSplit(number, trees):
                if ready:
                    each = "Done"
                    for part in reversed(_last(printed, len(trees))):
                        each = f"(More ({part}) {each})"
                    printed.append(f"Cases {number + 1} {each}")
                else:
                    waiting += [(branch, True), *((x, False) for x in reversed(trees))]
            case ColumnSplit(column, at, low, high):
                if ready:
                    one, other = _last(printed, 2)
                    printed.append(f"Cut {column + 1} {_z(at)} ({one}) ({other})")
                else:
                    waiting += [(branch, True), (high, False), (low, False)]
            case _:
                assert_never(branch)
    [whole] = printed
    return whole


def _last(printed: list[str], count: int) -> list[str]:
    """Remove and return the last items."""
    last = printed[len(printed) - count :]
    del printed[len(printed) - count :]
    return last


def _fact(fact: Fact, columns: int) -> str:
    match fact.kind:
        case "equal":
            return f"Equal {fact.number + 1}"
        case "above":
            return f"Above {fact.number + 1}"
        case "node":
            return f"Known {fact.number + 1}"
        case "corner":
            ends = " ".join("true" if end else "false" for end in fact.ends)
            return f"Corner {columns + fact.number + 1} {ends}"
        case "tangent":
            return f"Tangent {columns + fact.number + 1} {_z(fact.ends[0])}"
        case _:
            assert_never(fact.kind)


def _numbers(parts: Sequence[int]) -> str:
    return _list(str(part + 1) for part in parts)


def _list(items: Iterator[str]) -> str:
    return f"[{'; '.join(items)}]"


def _z(value: int) -> str:
    return str(value) if value >= 0 else f"({value})"
