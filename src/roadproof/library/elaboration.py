"""The elaborator, which turns syntax trees into formulas; use it through ``library.elaborate``.

A call of a definition becomes its body, wrapped in ``Application``. Vehicles and lanes are names from the
start, so the result mentions SV, POV and L and nothing else.
"""

import re
from collections.abc import Iterator
from dataclasses import field
from fractions import Fraction
from typing import TypeVar, assert_never

from roadproof.errors import Position, TextError
from roadproof.library import arithmetic, mistakes, scopes
from roadproof.library.notes import ElaborationCache, FormulaNote, UnreadableNameError, UsedDefinitions
from roadproof.library.quantity import Quantity, Sizes
from roadproof.library.scopes import SORTS, Free, Ref, Scope, Value, Vehicles
from roadproof.library.specification import BUILT_IN, Specification, source_of, unknown_name
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Bounds, Definition, Expression, SignalDeclaration
from roadproof.runtime.records import dataclass
from roadproof.world.signals import KINDS
from roadproof.world.units import UNITS

MOST_ERRORS = 200
_ANY_NUMBER = Quantity(t.number(1), None)  # fits in place of any wrong number

A = TypeVar("A")


@dataclass
class Elaborator:
    """An elaborator of one claim; inside of ``name@set(…)``, ``outer`` is the one that met it.

    With ``errors``, mistakes are added to it and elaboration goes on. ``lost``: patterns of names whose
    declarations could not be read, which cause no errors. ``notes``: if it is a list, the formula of each
    expression is added. ``at_start``: whether what is read is about time 0. ``used_definitions``: every
    definition applied so far, also from the cache ``known``.
    """

    specification: Specification
    outer: "Elaborator | None" = None
    free: Free = field(default_factory=lambda: {"vehicle": set(), "lane": set()})
    stack: list[str] = field(default_factory=list)
    depth: int = 0
    deepest: int = 0
    known: ElaborationCache = field(default_factory=dict)
    sizes: Sizes = field(default_factory=Sizes)
    errors: list[TextError] | None = None
    lost: tuple[re.Pattern[str], ...] = ()
    notes: list[FormulaNote] | None = None
    at_start: bool = True
    used_definitions: UsedDefinitions = field(default_factory=dict)

    def for_next_claim(self) -> "Elaborator":
        """Return an elaborator for another claim in the same specification, with the same cache."""
        return Elaborator(self.specification, known=self.known, sizes=Sizes(self.sizes.known))

    # --- mistakes --------------------------------------------------------------------------------

    def _record(self, error: TextError, instead: A) -> A:
        """Record the error and return ``instead``; raise it if errors are not recorded."""
        if self.errors is None or len(self.errors) >= MOST_ERRORS:
            raise error
        if not isinstance(error, UnreadableNameError):
            definition = self.specification.definitions[self.stack[-1]] if self.stack else None
            if definition is not None:
                source = source_of(self.specification.library, definition)
                error.locate(source.name, source.text)
            self.errors.append(error)
        return instead

    def _refuse_lost(self, name: str, at: Position) -> None:
        if any(pattern.fullmatch(name) for pattern in self.lost):
            raise UnreadableNameError(f"'{name}' could not be read", at)

    # --- names ---------------------------------------------------------------------------------

    @property
    def _free_names(self) -> Free | None:
        """The names that need no declaration: those of a claim; None in the body of a definition."""
        return None if self.stack else self.free

    def claim_scope(self, claim: syntax.Claim) -> Scope:
        """Return the scope of the declarations in front of a claim."""
        library = self.specification.library
        for binding in claim.given:
            scopes.refuse_signal(binding.name, library.signals, binding.at)
        return scopes.claim_scope(claim.given, library.parameters, self.free)

    def reference(self, expression: Expression | Ref, sort: str, scope: Scope) -> Ref:
        return scopes.reference(expression, sort, scope, self._free_names)

    # --- calls ---------------------------------------------------------------------------------

    def call(self, call: syntax.Call, scope: Scope) -> Formula | Quantity:
        """Elaborate a call of a definition, a signal or a built-in function. Raises ``TextError``."""
        name, _, qualifier = call.name.partition("@")
        if qualifier and qualifier != self.specification.set_name:
            return self._in_other_set(call, name, qualifier, scope)
        self._refuse_lost(name, call.at)
        if name in BUILT_IN:
            return self._built_in(call, name, scope)
        definition = self.specification.definitions.get(name)
        if definition is None and name in self.specification.library.signals:
            return self._signal(self.specification.library.signals[name], call, scope)
        if definition is None:
            raise mistakes.unknown_call(name, self.specification, call.at)
        bound = self._bind(definition, call, scope)
        return self.apply(definition, bound, call.at)

    def _signal(self, signal: SignalDeclaration, call: syntax.Call, scope: Scope) -> Formula | Quantity:
        arity = 1 if signal.vehicle else 0
        declaration = f"{signal.name}{f'({signal.vehicle}: vehicle)' if arity else ''}: {signal.sort}"
        mistakes.refuse_arity(signal.name, arity, call, f"It is {declaration}.")
        vehicle = self.reference(call.arguments[0], "vehicle", scope).name if arity else ""
        return arithmetic.custom_signal_value(signal, vehicle)

    def _in_other_set(self, call: syntax.Call, name: str, qualifier: str, scope: Scope) -> Formula | Quantity:
        if qualifier not in self.specification.library.sets:
            raise TextError(unknown_name("spec set", qualifier, self.specification.library.sets), call.at)
        inner = Elaborator(
            self.specification.in_set(qualifier),
            self,
            self.free,
            depth=self.depth,
            sizes=self.sizes,
            errors=self.errors,
            lost=self.lost,
            notes=self.notes,
        )
        result = inner.call(syntax.Call(name, call.arguments, call.at), scope)
        self.deepest = max(self.deepest, inner.deepest)
        self.used_definitions = self.used_definitions | inner.used_definitions
        return result

    def apply(self, definition: Definition, bound: Scope, at: Position) -> Formula | Quantity:
        """Return a definition applied to values, and record the definitions that it uses."""
        used_before = self.used_definitions
        body, height, used_inside = self._known_body(definition, bound, at)
        self.deepest = max(self.deepest, self.depth + height)
        self.used_definitions = used_before | used_inside
        if isinstance(body, Quantity):
            return body
        if self.outer is not None:
            outer_used = list(self._outer_elaborators())
            ours = self.outer.apply(self.outer.specification.definitions[definition.name], bound, at)
            if isinstance(ours, f.Application) and ours.body == body:
                self.used_definitions = used_before
                return ours
            for walk, used_definitions in outer_used:  # undo: the outer body was only compared
                walk.used_definitions = used_definitions
            return f.Application(
                f"{definition.name}@{self.specification.set_name}", scopes.names_in(bound), body
            )
        return f.Application(definition.name, scopes.names_in(bound), body)

    def _known_body(
        self, definition: Definition, bound: Scope, at: Position
    ) -> tuple[Formula | Quantity, int, UsedDefinitions]:
        """Return a definition applied to values, its nesting depth, and the definitions that it uses."""
        key = (definition.name, self.specification.set_name, tuple(bound.values()))
        if key not in self.known:
            if definition.name in self.stack:
                cycle = " -> ".join([*self.stack[self.stack.index(definition.name) :], definition.name])
                raise TextError(f"'{definition.name}' is defined by itself: {cycle}", at)
            before, used_before = self.deepest, self.used_definitions
            self.deepest = self.depth
            self.used_definitions = {(self.specification.set_name, definition.name): definition}
            try:
                body = self.body_of(definition.name, bound)
                self.known[key] = body, self.deepest - self.depth, self.used_definitions
            finally:
                self.used_definitions = used_before
            self.deepest = max(before, self.deepest)
        return self.known[key]

    def _outer_elaborators(self) -> Iterator[tuple["Elaborator", UsedDefinitions]]:
        """Yield the outer elaborators, each with the definitions that it has applied so far."""
        walk = self.outer
        while walk is not None:
            yield walk, walk.used_definitions
            walk = walk.outer

    def body_of(self, name: str, scope: Scope) -> Formula | Quantity:
        """Return the body of a definition, with errors located in its own text."""
        definition = self.specification.definitions[name]
        self.stack.append(name)
        try:
            for binding in definition.parameters:
                scopes.check_sort(binding)
            body = self.expression(definition.body, scope)
            if name in self.specification.library.signals:
                arithmetic.check_derived(self.specification.library.signals[name], body, definition.body.at)
            return body
        except TextError as error:
            source = source_of(self.specification.library, definition)
            raise error.locate(source.name, source.text) from None
        finally:
            self.stack.pop()

    def _bind(self, definition: Definition, call: syntax.Call, scope: Scope) -> dict[str, Value]:
        """Return the value of each parameter of a definition in a call."""
        bound: dict[str, Value] = {}
        for binding, arguments in scopes.assign_arguments(definition, call, scope):
            if binding.sort == "vehicles":
                refs = [self.reference(argument, "vehicle", scope) for argument in arguments]
                bound[binding.name] = Vehicles(tuple(ref.name for ref in refs))
            elif binding.sort in SORTS:
                bound[binding.name] = self.reference(arguments[0], binding.sort, scope)
            elif isinstance(arguments[0], Ref):
                raise TextError(f"'{arguments[0].name}' is a vehicle; a number is expected here", call.at)
            else:
                scopes.check_sort(binding)
                number = self.term(arguments[0], scope)
                bound[binding.name] = arithmetic.argument(
                    number, binding, definition, self.specification.library.parameters, arguments[0].at
                )
        return bound

    # --- expressions ---------------------------------------------------------------------------

    def formula(self, expression: Expression, scope: Scope) -> Formula:
        """Elaborate an expression that must be a formula."""
        try:
            result = self.expression(expression, scope)
            if not isinstance(result, Quantity):
                return result
            raise TextError(
                "a formula is expected here, but this is a number",
                expression.at,
                "Compare it with something.",
            )
        except TextError as error:
            return self._record(error, f.TRUE)

    def term(self, expression: Expression, scope: Scope) -> Quantity:
        """Elaborate an expression that must be a number."""
        try:
            result = self.expression(expression, scope)
            if isinstance(result, Quantity):
                return result
            raise TextError("a number is expected here, but this is a formula", expression.at)
        except TextError as error:
            return self._record(error, _ANY_NUMBER)

    def expression(self, expression: Expression, scope: Scope) -> Formula | Quantity:
        """Elaborate an expression; depth and size are limited."""
        self.depth += 1
        try:
            self.deepest = max(self.deepest, self.depth)
            mistakes.refuse_deeper(self.depth, expression.at)
            self.sizes.count_reading(expression.at)
            result = self._expression(expression, scope)
            self.sizes.check(result.term if isinstance(result, Quantity) else result, expression.at)
            if self.notes is not None and not isinstance(result, Quantity):
                definition = self.specification.definitions[self.stack[-1]] if self.stack else None
                self.notes.append(FormulaNote(definition, expression.at, result))
            return result
        finally:
            self.depth -= 1

    def _expression(self, expression: Expression, scope: Scope) -> Formula | Quantity:
        is_at_start = self.at_start
        match expression:
            case syntax.Literal_(bool(), _, _):
                return f.Truth(bool(expression.value))
            case syntax.Literal_(value, unit, _):
                return arithmetic.literal(Fraction(value), unit)
            case syntax.Name(name, at):
                return self._name(name, at, scope)
            case syntax.Call():
                return self.call(expression, scope)
            case syntax.Prefix("not", body, _):
                return f.negation(self.formula(body, scope))
            case syntax.Prefix(_, body, at):
                return arithmetic.negative(self.term(body, scope), at)
            case syntax.Chain(op, parts, _):
                formulas = [self.formula(p, scope) for p in parts]
                return f.conjunction(*formulas) if op == "and" else f.disjunction(*formulas)
            case syntax.Binary():
                return self._binary(expression, scope)
            case syntax.Temporal(op, bounds, left, right, _):
                interval = self.interval(bounds, scope)
                self.at_start = False
                goal = self.formula(right, scope)
                first = f.TRUE if left is None else self.formula(left, scope)
                self.at_start = is_at_start
                return arithmetic.temporal(op, first, interval, goal)
            case syntax.Quantified():
                return self._quantified(expression, scope)

    def _name(self, name: str, at: Position, scope: Scope) -> Formula | Quantity:
        value = scope.get(name)
        if isinstance(value, Quantity):
            return value
        if value is not None:
            sort: str | None = scopes.sort_of(value)
        else:
            sort = scopes.sort_of_free(name) if self._free_names else None
        if sort is not None:
            raise TextError(f"'{name}' is a {sort}; a formula or number is expected here", at)
        declared = self.specification.library.parameters.get(name)
        if declared is not None:
            dimension = UNITS[declared.unit][1]
            return Quantity(t.Parameter(name, dimension), dimension)
        signal = self.specification.library.signals.get(name)
        if signal is not None and not signal.vehicle:
            return self.call(syntax.Call(name, (), at), scope)
        self._refuse_lost(name, at)
        if signal is not None or name in self.specification.definitions:
            raise TextError(f"'{name}' needs its arguments", at, f"Write {name}(…).")
        raise mistakes.unknown_operand(name, self.specification, scope, at)

    def _binary(self, expression: syntax.Binary, scope: Scope) -> Formula | Quantity:
        op, left, right, at = expression.op, expression.left, expression.right, expression.at
        match op:
            case "->":
                return f.implication(self.formula(left, scope), self.formula(right, scope))
            case "<->":
                return f.equivalence(self.formula(left, scope), self.formula(right, scope))
            case "<" | "<=" | ">" | ">=" | "=" | "!=":
                if syntax.is_kind(left) or syntax.is_kind(right):
                    from roadproof.library import kinds  # here: few formulas compare kinds

                    return kinds.compare(expression, lambda call: self._whose_kind(call, scope))
                return arithmetic.compare(op, self.term(left, scope), self.term(right, scope), at)
            case "+" | "-" | "*" | "/" | "^":
                parameters = self.specification.library.parameters
                return arithmetic.combine(op, self.term(left, scope), self.term(right, scope), parameters, at)
            case _:
                assert_never(op)

    def _whose_kind(self, call: Expression, scope: Scope) -> str:
        if not isinstance(call, syntax.Call) or len(call.arguments) != 1:
            raise TextError("'kind' takes 1 argument, a vehicle", call.at)
        return self.reference(call.arguments[0], "vehicle", scope).name

    def interval(self, bounds: Bounds | None, scope: Scope) -> f.Interval:
        """Return the interval of a temporal operator; [0, inf] without bounds."""
        if bounds is None:
            return f.FOREVER
        before = len(self.errors or ())
        low = self._bound(bounds.low, scope)
        high = None if bounds.high is None else self._bound(bounds.high, scope)
        if len(self.errors or ()) > before:
            return f.FOREVER
        return arithmetic.interval(low, high, bounds.at)

    def _bound(self, expression: Expression, scope: Scope) -> t.Term:
        quantity = self.term(expression, scope)
        return arithmetic.bound(quantity, self.specification.library.parameters, expression.at)

    # --- quantifiers and built-in names ----------------------------------------------------------

    def _quantified(self, expression: syntax.Quantified, scope: Scope) -> Formula:
        variable = expression.variable
        if expression.at_start and (self.stack or not self.at_start):
            raise mistakes.late_let(expression.at)
        scopes.refuse_signal(variable, self.specification.library.signals, expression.at)
        vehicles = scopes.vehicles_in(expression.domain, scope, self._free_names)
        if vehicles is not None:
            formulas = [self.formula(expression.body, {**scope, variable: v}) for v in vehicles]
            return f.conjunction(*formulas) if expression.kind == "every" else f.disjunction(*formulas)
        domain = scopes.domain_of(expression.domain, scope, self._free_names)
        sort = "lane" if domain.kind in ("lanes", "adjacent") else "lanelet"
        taken = {v.name for v in scope.values() if isinstance(v, Ref)} | set().union(*self.free.values())
        unique = variable
        while unique in taken:
            unique += "_"
        body = self.formula(expression.body, {**scope, variable: Ref(sort, unique)})
        return (f.Every if expression.kind == "every" else f.Some)(unique, domain, body)

    def _built_in(self, call: syntax.Call, name: str, scope: Scope) -> Formula | Quantity:
        if name in ("lanes", "lanelets", "zone", "adjacentLanes"):
            raise TextError(f"'{name}' is a domain: write some x in {name}…", call.at)
        if name in ("max", "min"):
            if not call.arguments:
                raise TextError(f"'{name}' needs at least one argument", call.at)
            return arithmetic.extremum(name, [self.term(a, scope) for a in call.arguments], call.at)
        if name == "kind":
            raise TextError("a kind is no number", call.at, f"Compare it: kind(SV) = {KINDS[1]}.")
        if name in ("rise", "fall"):
            mistakes.refuse_arity_of_edge(name, call)
            time = self._bound(call.arguments[1], scope)
            return arithmetic.edge(name, self.formula(call.arguments[0], scope), time, call.at)
        mistakes.refuse_arity(name, 2 if name == "occ" else 1, call)
        first = call.arguments[0]
        if name == "occ":
            vehicle = self.reference(first, "vehicle", scope)
            return f.Occupies(vehicle.name, self.reference(call.arguments[1], "lanelet", scope).name)
        if name in ("abs", "inverse"):
            make = arithmetic.absolute if name == "abs" else arithmetic.inverse
            return make(self.term(first, scope), call.at)
        return arithmetic.of_vehicle(name, self.reference(first, "vehicle", scope).name)
