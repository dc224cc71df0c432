"""Mistakes that the elaborator finds in a claim or a definition: their messages and remedies."""

from roadproof.errors import Position, TextError
from roadproof.library.quantity import Quantity
from roadproof.library.scopes import Scope
from roadproof.library.specification import BUILT_IN, Specification, unknown_name
from roadproof.logic import syntax

DEEPEST_FORMULA = 100


def unknown_call(name: str, specification: Specification, at: Position) -> TextError:
    """Return the error for a call of a name that is no definition, signal or built-in function."""
    from roadproof.logic.foreign_syntax import instead_of  # here: for mistakes alone

    known = [*specification.definitions, *specification.library.signals, *BUILT_IN]
    return TextError(unknown_name("definition", name, known), at, instead_of(name))


def unknown_operand(name: str, specification: Specification, scope: Scope, at: Position) -> TextError:
    """Return the error for a name without arguments that stands for nothing."""
    from roadproof.logic.foreign_syntax import instead_of  # here: for mistakes alone

    library = specification.library
    numbers = [n for n, value in scope.items() if isinstance(value, Quantity)]
    known = [*library.parameters, *library.signals, *specification.definitions, *numbers]
    return TextError(unknown_name("parameter or definition", name, known), at, instead_of(name))


def refuse_arity(name: str, arity: int, call: syntax.Call, hint: str = "") -> None:
    """Raise ``TextError`` if a call has another number of arguments."""
    if len(call.arguments) != arity:
        plural = "" if arity == 1 else "s"
        message = f"'{name}' takes {arity} argument{plural} but got {len(call.arguments)}"
        raise TextError(message, call.at, hint)


def refuse_deeper(depth: int, at: Position) -> None:
    """Raise ``TextError`` if expressions are nested deeper than allowed."""
    if depth > DEEPEST_FORMULA:
        raise TextError(
            f"definitions and formula together are nested deeper than {DEEPEST_FORMULA}",
            at,
            "Look for a chain of definitions that only call each other.",
        )


def refuse_arity_of_edge(name: str, call: syntax.Call) -> None:
    """Raise ``TextError`` unless ``rise`` or ``fall`` has a formula and a time."""
    if len(call.arguments) != 2:
        raise TextError(
            f"'{name}' takes a formula and a time, but got {len(call.arguments)} argument"
            + "s" * (len(call.arguments) != 1),
            call.at,
            f"Time is dense and has no previous instant: write {name}(p, 0.1 s); for samples, their step.",
        )


def late_let(at: Position) -> TextError:
    """Return the error of a ``let`` that is not about time 0."""
    return TextError(
        "'let' names the lane at time 0, so it stands in claims only, outside of temporal operators",
        at,
        "Write it in front: let L = lane of SV at start: F p(L).",
    )
