"""Small faults in Python: each one edit of the text of a file, with the operator that made it.

An edit keeps the rest of the text as it is, so a report can show the line before and after.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256

from mutants.places import functions_of


@dataclass(frozen=True)
class Edit:
    """``text[start:end]`` becomes ``after``. ``lines``: of the statement, first and last.

    ``context`` names the function (or definition) and the text of the statement around the edit.
    """

    file: str
    operator: str
    start: int
    end: int
    before: str
    after: str
    lines: tuple[int, int]
    context: str
    nth: int = 0

    @property
    def key(self) -> str:
        """The same for the same edit of the same statement, wherever in the file that has moved."""
        content = [self.file, self.context, self.operator, self.before, self.after, str(self.nth)]
        return sha256("\0".join(content).encode()).hexdigest()[:12]

    def apply(self, text: str) -> str:
        assert text[self.start : self.end] == self.before
        return text[: self.start] + self.after + text[self.end :]


_STRICTNESS = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
_DIRECTION = {ast.Lt: ast.Gt, ast.LtE: ast.GtE, ast.Gt: ast.Lt, ast.GtE: ast.LtE}
_OPPOSITE = {
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}
_ARITHMETIC = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
_NAMES = {"min": "max", "max": "min", "any": "all", "all": "any", "minimum": "maximum", "maximum": "minimum"}
_VERDICTS = {
    "PROVED": "UNKNOWN",
    "PROVED_BOUNDED": "UNKNOWN",
    "UNKNOWN": "PROVED_BOUNDED",
    "REFUTED": "UNKNOWN",
    "VACUOUS": "PROVED",
    "WITNESSED": "UNKNOWN",
    "IMPOSSIBLE": "NONE_WITHIN",
    "NONE_WITHIN": "IMPOSSIBLE",
    "CROSSCHECK_FAILED": "UNKNOWN",
}
_WORDS = {
    "unsat": "unknown",
    "unknown": "unsat",
    "sat": "unsat",
    "infeasible": "unknown",
    "found": "infeasible",
    "inner": "outer",
    "outer": "inner",
    "strong": "weak",
    "weak": "strong",
    "true": "false",
    "false": "true",
}
_EMPTY = {"int": "0", "float": "0.0", "str": "''", "tuple": "()", "list": "[]", "dict": "{}"}


def edits_of(file: str, text: str) -> list[Edit]:
    """Every fault that the operators make of a Python file, in the order of its text."""
    tree = ast.parse(text)
    owners: dict[int, tuple[str, ast.FunctionDef]] = {}
    for name, function in functions_of(tree):
        owners |= {id(node): (name, function) for node in ast.walk(function)}
    starts = _line_starts(text)
    made: list[Edit] = []
    seen: dict[tuple[str, str, str, str], int] = {}
    for statement, node, operator, after in _faults(tree, owners):
        start, end = _span(node, text, starts)
        before = text[start:end]
        if isinstance(node, ast.expr) and not isinstance(node, ast.Name | ast.Attribute | ast.Constant):
            after = f"({after})"
        first, last = statement.lineno, _last_line(statement)
        shown = " ".join(text[starts[first - 1] : starts[last]].split())
        name = owners[id(statement)][0] if id(statement) in owners else ""
        context = f"{name}|{shown}"
        nth = seen[key] = seen.get(key := (context, operator, before, after), -1) + 1
        made.append(Edit(file, operator, start, end, before, after, (first, last), context, nth))
    return made


def is_fault(edit: Edit, text: str) -> bool:
    """Whether the changed text still is a program, and another one."""
    if not edit.file.endswith(".py"):
        return True
    try:
        return ast.dump(ast.parse(edit.apply(text))) != _dumped(text)
    except SyntaxError:
        return False


@lru_cache(maxsize=1)
def _dumped(text: str) -> str:
    return ast.dump(ast.parse(text))


def _faults(
    tree: ast.Module, owners: dict[int, tuple[str, ast.FunctionDef]]
) -> Iterator[tuple[ast.stmt, ast.AST, str, str]]:
    """(statement, node to replace, operator, new text)."""
    for statement in _statements(tree):
        owner = owners.get(id(statement))
        if isinstance(statement, ast.Return) and statement.value and owner and owner[1].returns:
            for constant in _constants(owner[1].returns):
                yield statement, statement.value, "return constant", constant
        yield from ((statement, *fault) for fault in _of_statement(statement))
        for node in _expressions(statement):
            yield from ((statement, *fault) for fault in _of_expression(node))


def _statements(node: ast.AST) -> Iterator[ast.stmt]:
    """Statements that do something a test could see: no docstrings, no imports, no words of an error."""
    for child in ast.iter_child_nodes(node):
        skipped = ast.Raise | ast.Assert | ast.Import | ast.ImportFrom | ast.Global | ast.Nonlocal
        doc = isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant)
        if isinstance(child, ast.stmt) and not isinstance(child, skipped) and not doc:
            yield child
        if not isinstance(child, ast.expr):
            yield from _statements(child)


def _expressions(statement: ast.stmt) -> Iterator[ast.expr]:
    """Expressions of a statement's own line(s), without annotations, decorators, patterns, texts."""
    match statement:
        case ast.FunctionDef(args=arguments):
            roots: list[ast.expr] = [*arguments.defaults, *(x for x in arguments.kw_defaults if x)]
        case ast.ClassDef():
            roots = []
        case ast.AnnAssign(value=value):
            roots = [value] if value else []
        case ast.Assign(value=value, targets=[ast.Name(id=name)]) if _is_alias(name, value):
            roots = []
        case _:
            roots = [x for x in ast.iter_child_nodes(statement) if isinstance(x, ast.expr)]
            roots += [item.context_expr for item in getattr(statement, "items", [])]
            roots += [case.guard for case in getattr(statement, "cases", []) if case.guard]
    for root in roots:
        yield from _below(root)


def _is_alias(name: str, value: ast.expr) -> bool:
    return name[0].isupper() and isinstance(value, ast.BinOp) and isinstance(value.op, ast.BitOr)


def _below(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.JoinedStr):
        return  # words for people, at places that ast does not tell
    yield node
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.keyword):
            yield from _below(child.value) if child.arg != "strict" else ()
        elif isinstance(child, ast.comprehension):
            for part in (child.iter, *child.ifs):
                yield from _below(part)
        elif isinstance(child, ast.expr):
            yield from _below(child)


def _of_statement(statement: ast.stmt) -> Iterator[tuple[ast.AST, str, str]]:
    match statement:
        case ast.Continue():
            yield statement, "continue to break", "break"
        case ast.Break():
            yield statement, "break to continue", "continue"
        case ast.If(test=test):
            yield test, "condition constant", "True"
            yield test, "condition constant", "False"
        case ast.While(test=test) if not isinstance(test, ast.Constant):
            yield test, "condition constant", "False"
        case ast.Expr(value=ast.Call()):
            yield statement, "call left out", "pass"
        case _:
            pass


def _constants(returns: ast.expr) -> tuple[str, ...]:
    match returns:
        case ast.Name(id="bool"):
            return ("True", "False")
        case ast.Name(id=name) | ast.Subscript(value=ast.Name(id=name)) if name in _EMPTY:
            return (_EMPTY[name],)
        case ast.BinOp(op=ast.BitOr(), right=ast.Constant(value=None)):
            return ("None",)
        case _:
            return ()


def _of_expression(node: ast.expr) -> Iterator[tuple[ast.AST, str, str]]:
    match node:
        case ast.Compare(left=left, ops=ops, comparators=sides):
            for i, op in enumerate(ops):
                tables = (("strictness", _STRICTNESS), ("direction", _DIRECTION), ("opposite", _OPPOSITE))
                for name, table in tables:
                    if type(op) in table:
                        other = [*ops[:i], table[type(op)](), *ops[i + 1 :]]
                        yield node, name, ast.unparse(ast.Compare(left, other, sides))
        case ast.BoolOp(op=op, values=values):
            other = ast.And() if isinstance(op, ast.Or) else ast.Or()
            yield node, "and, or", ast.unparse(ast.BoolOp(other, values))
            for i in range(len(values)):
                kept = [*values[:i], *values[i + 1 :]]
                yield (
                    node,
                    "operand left out",
                    ast.unparse(ast.BoolOp(op, kept) if len(kept) > 1 else kept[0]),
                )
        case ast.UnaryOp(op=ast.Not() | ast.USub() | ast.Invert(), operand=operand):
            yield node, "not dropped", ast.unparse(operand)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _ARITHMETIC:
            yield node, "arithmetic", ast.unparse(ast.BinOp(left, _ARITHMETIC[type(op)](), right))
        case ast.IfExp(test=test):
            yield test, "condition constant", "True"
            yield test, "condition constant", "False"
        case ast.Constant(value=value):
            yield from ((node, "constant", other) for other in _other_constants(value))
        case ast.Attribute(value=ast.Name(id="Verdict"), attr=name) if name in _VERDICTS:
            yield node, "verdict", f"Verdict.{_VERDICTS[name]}"
        case ast.Subscript(value=value, slice=ast.Slice(lower=lower, upper=upper, step=step)):
            yield from ((node, "slice end", x) for x in _other_slices(value, lower, upper, step))
        case ast.Call(func=function, args=arguments):
            yield from _of_call(node, function, arguments)
        case _:
            pass


def _other_constants(value: object) -> tuple[str, ...]:
    match value:
        case bool():
            return (str(not value),)
        case int() | float():
            return (repr(value + 1), repr(value - 1)) if value else ("1",)
        case str() if value in _WORDS:
            return (repr(_WORDS[value]),)
        case _:
            return ()


def _other_slices(value: ast.expr, *ends: ast.expr | None) -> Iterator[str]:
    for i, end in enumerate(ends):
        if end is not None:
            yield ast.unparse(ast.Subscript(value, ast.Slice(*ends[:i], None, *ends[i + 1 :])))
            if i < 2:
                moved = ast.BinOp(end, ast.Add(), ast.Constant(1))
                yield ast.unparse(ast.Subscript(value, ast.Slice(*ends[:i], moved, *ends[i + 1 :])))


def _of_call(
    node: ast.Call, function: ast.expr, arguments: list[ast.expr]
) -> Iterator[tuple[ast.AST, str, str]]:
    name = function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")
    if name in _NAMES:
        other = ast.Name(_NAMES[name])
        if isinstance(function, ast.Attribute):
            other = ast.Attribute(function.value, _NAMES[name])  # type: ignore[assignment]
        yield function, "min, max, any, all", ast.unparse(other)
    if len(arguments) == 2 and name in {"min", "max"}:
        yield node, "operand left out", ast.unparse(arguments[0])
        yield node, "operand left out", ast.unparse(arguments[1])
        return
    for i in range(len(arguments) - 1):
        pair = arguments[i : i + 2]
        if not any(isinstance(x, ast.Starred) for x in pair) and name != "isinstance":
            swapped = [*arguments[:i], pair[1], pair[0], *arguments[i + 2 :]]
            yield node, "arguments swapped", ast.unparse(ast.Call(function, swapped, node.keywords))


def _line_starts(text: str) -> list[int]:
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    return starts


def _span(node: ast.AST, text: str, starts: list[int]) -> tuple[int, int]:
    """Where a node is in the text, in characters (ast counts bytes)."""

    def at(line: int, column: int) -> int:
        begin = starts[line - 1]
        return begin + len(text[begin : starts[line]].encode()[:column].decode())

    assert isinstance(node, ast.expr | ast.stmt)
    assert node.end_lineno is not None
    assert node.end_col_offset is not None
    return at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)


def _last_line(statement: ast.stmt) -> int:
    """The last line of a statement; of one with a body, of what stands in front of that."""
    body = getattr(statement, "body", None) or getattr(statement, "cases", None)
    if not body:
        return statement.end_lineno or statement.lineno
    inside = body[0].pattern.lineno if isinstance(body[0], ast.match_case) else body[0].lineno
    return max(statement.lineno, inside - 1)
