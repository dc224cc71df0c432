"""Programs and trees that refute them, printed for Coq and for the extracted program.

Columns, rows and nodes count from 1 there, where they are looked up by positive numbers.
"""

from collections.abc import Iterator, Sequence
from typing import assert_never

from roadproof.evidence.program import Cases, Cut, Either, Every, Fact, Linear, Node, Program, Sum, Tree
from roadproof.extensions.kernel.accept import CoqModule
from roadproof.extensions.kernel.names import comment
from roadproof.extensions.kernel.source import Module, comment_lines, wrapped


def prepare(name: str, said: Sequence[str], pairs: Sequence[tuple[Program, Tree]]) -> CoqModule:
    """Programs with their trees as a module; ``said``: what they are programs of, for a reader."""
    out = [f"Module {name}.", "Import Roadproof.Programs Roadproof.Refuted.", "Open Scope positive_scope."]
    out += comment_lines(said)
    for k, (program, _) in enumerate(pairs, 1):
        fields = "; ".join(f"{field} := {x}" for field, x in _fields(program).items())
        out += wrapped(f"Definition question_{k} : program := {{| {fields} |}}.")
    out += ["(* From here on it is proof: what is proved is said in the theorem at the end. *)"]
    theorem = len(out) + 1
    for k, (program, tree) in enumerate(pairs, 1):
        out += wrapped(f"Definition tree_{k} : tree := {_tree(tree, len(program.box))}.")
    goal = " /\\ ".join(f"(forall x, ~ solves x question_{k})" for k in range(1, len(pairs) + 1))
    out += [*wrapped(f"Theorem proved : {goal}."), "Proof."]
    for k in range(1, len(pairs) + 1):
        out += ["  split."] if k < len(pairs) else []
        out += [f"  {{ apply (no_solution question_{k} tree_{k}). vm_cast_no_check (eq_refl true). }}"]
    out += ["Qed.", f"End {name}."]
    return CoqModule(Module(name, "\n".join(out) + "\n", (), theorem))


def form(name: str, said: Sequence[str], pairs: Sequence[tuple[Program, Tree]]) -> CoqModule:
    """The same as a form of ``proofs/kernel/ocaml/reader.ml``."""
    fields = ((*_fields(program).values(), f"({_tree(tree, len(program.box))})") for program, tree in pairs)
    programs = _list("\n  ".join(x) for x in fields)
    text = f'(none_within {name} "{comment(" ".join(said))}"\n {programs})\n'
    return CoqModule(Module(name, text, (), 0))


def _fields(program: Program) -> dict[str, str]:
    """Those of ``program`` in Programs.v, by their names and in their order."""
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
        case Every(parts):
            return f"a_conjunction {number} {_numbers(parts)}"
        case Either(parts):
            return f"a_disjunction {number} {_numbers(parts)}"
        case _:
            assert_never(node)


def _linear(linear: Linear) -> str:
    """Terms by column: the checker adds up sums in this order."""
    terms = _list(f"a_term {column + 1} {_z(factor)}" for column, factor in sorted(linear.terms))
    return f"{terms} {_z(linear.constant)}"


def _tree(tree: Tree, columns: int) -> str:
    """Trees are shallow; written from the leaves up, without recursion, they may be deep."""
    done: list[str] = []
    waiting: list[tuple[Tree, bool]] = [(tree, False)]
    while waiting:
        found, ready = waiting.pop()
        match found:
            case Sum(weights):
                done.append(f"Sum {_list(f'a_multiple ({_fact(x, columns)}) {_z(w)}' for x, w in weights)}")
            case Cases(number, trees):
                if ready:
                    each = "Done"
                    for part in reversed(_last(done, len(trees))):
                        each = f"(More ({part}) {each})"
                    done.append(f"Cases {number + 1} {each}")
                else:
                    waiting += [(found, True), *((x, False) for x in reversed(trees))]
            case Cut(column, at, low, high):
                if ready:
                    one, other = _last(done, 2)
                    done.append(f"Cut {column + 1} {_z(at)} ({one}) ({other})")
                else:
                    waiting += [(found, True), (high, False), (low, False)]
            case _:
                assert_never(found)
    [whole] = done
    return whole


def _last(done: list[str], count: int) -> list[str]:
    """Takes the last so many away."""
    taken = done[len(done) - count :]
    del done[len(done) - count :]
    return taken


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
