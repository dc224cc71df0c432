"""One walk over one claim, from syntax to formula; ``library.elaborate`` has the doors to it.

Applying a definition puts its body in place of the call, wrapped in ``Application``; vehicles and lanes
are names from the start, so what comes out speaks of SV, POV and L and nothing else.
"""

import re
from collections.abc import Iterator
from dataclasses import field
from fractions import Fraction
from typing import TypeVar, assert_never

from roadproof.errors import Position, TextError
from roadproof.library import arithmetic, kinds, scopes
from roadproof.library.notes import Entered, Known, LostError, Note
from roadproof.library.quantity import Quantity, Sizes
from roadproof.library.scopes import SORTS, Free, Ref, Scope, Value, Vehicles
from roadproof.library.specification import BUILT_IN, Specification, source_of, unknown
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.foreign_syntax import instead_of
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Bounds, Definition, Expression, SignalDeclaration
from roadproof.runtime.records import dataclass
from roadproof.world.signals import KINDS
from roadproof.world.units import UNITS

DEEPEST_FORMULA = 100
MOST_ERRORS = 200
_ANY_NUMBER = Quantity(t.number(1), None)  # fits wherever a number is wrong

A = TypeVar("A")


@dataclass
class Elaborator:
    """One walk over one claim; ``home`` is set inside ``name@set(…)``, and is the walk that met it.

    With ``errors`` mistakes are noted there and the walk goes on; nothing is said of names that are ``lost``,
    because what declares them could not be read. ``notes``: where it is a list, what each expression became
    is added to it. ``entered``: every definition that has been applied so far, also from what is ``known``.
    """

    specification: Specification
    home: "Elaborator | None" = None
    free: Free = field(default_factory=lambda: {"vehicle": set(), "lane": set()})
    stack: list[str] = field(default_factory=list)
    depth: int = 0
    deepest: int = 0
    known: Known = field(default_factory=dict)
    sizes: Sizes = field(default_factory=Sizes)
    errors: list[TextError] | None = None
    lost: tuple[re.Pattern[str], ...] = ()
    notes: list[Note] | None = None
    entered: Entered = field(default_factory=dict)

    def again(self) -> "Elaborator":
        """A walk over another claim in the same specification, which knows what this one has made."""
        return Elaborator(self.specification, known=self.known, sizes=Sizes(self.sizes.known))

    # --- mistakes --------------------------------------------------------------------------------

    def _noted(self, error: TextError, instead: A) -> A:
        """``instead`` of what is wrong, where mistakes are noted; else the mistake is raised."""
        if self.errors is None or len(self.errors) >= MOST_ERRORS:
            raise error
        if not isinstance(error, LostError):
            definition = self.specification.definitions[self.stack[-1]] if self.stack else None
            if definition is not None:
                source = source_of(self.specification.library, definition)
                error.locate(source.name, source.text)
            self.errors.append(error)
        return instead

    def _refuse_lost(self, name: str, at: Position) -> None:
        if any(pattern.fullmatch(name) for pattern in self.lost):
            raise LostError(f"'{name}' could not be read", at)

    # --- names ---------------------------------------------------------------------------------

    @property
    def _open(self) -> Free | None:
        """Names that need no declaration: those of a claim, none in the body of a definition."""
        return None if self.stack else self.free

    def given(self, claim: syntax.Claim) -> Scope:
        library = self.specification.library
        for binding in claim.given:
            scopes.refuse_signal(binding.name, library.signals, binding.at)
        return scopes.scope_of(claim.given, library.parameters, self.free)

    def reference(self, expression: Expression | Ref, sort: str, scope: Scope) -> Ref:
        return scopes.reference(expression, sort, scope, self._open)

    # --- calls ---------------------------------------------------------------------------------

    def call(self, call: syntax.Call, scope: Scope) -> Formula | Quantity:
        name, _, qualifier = call.name.partition("@")
        if qualifier and qualifier != self.specification.set_name:
            return self._in_other_set(call, name, qualifier, scope)
        self._refuse_lost(name, call.at)
        if name in BUILT_IN:
            return self._built_in(call, name, scope)
        definition = self.specification.definitions.get(name)
        if definition is None and name in self.specification.library.signals:
            return self._own(self.specification.library.signals[name], call, scope)
        if definition is None:
            everything = [*self.specification.definitions, *self.specification.library.signals, *BUILT_IN]
            raise TextError(unknown("definition", name, everything), call.at, instead_of(name))
        bound = self._bind(definition, call, scope)
        return self.apply(definition, bound, call.at)

    def _own(self, signal: SignalDeclaration, call: syntax.Call, scope: Scope) -> Formula | Quantity:
        wanted = 1 if signal.vehicle else 0
        if len(call.arguments) != wanted:
            raise TextError(
                f"'{signal.name}' takes {wanted} argument{'' if wanted == 1 else 's'} "
                f"but got {len(call.arguments)}",
                call.at,
                f"It is {signal.name}{f'({signal.vehicle}: vehicle)' if wanted else ''}: {signal.sort}.",
            )
        vehicle = self.reference(call.arguments[0], "vehicle", scope).name if wanted else ""
        return arithmetic.own(signal, vehicle)

    def _in_other_set(self, call: syntax.Call, name: str, qualifier: str, scope: Scope) -> Formula | Quantity:
        if qualifier not in self.specification.library.sets:
            raise TextError(unknown("spec set", qualifier, self.specification.library.sets), call.at)
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
        made = inner.call(syntax.Call(name, call.arguments, call.at), scope)
        self.deepest = max(self.deepest, inner.deepest)
        self.entered = self.entered | inner.entered
        return made

    def apply(self, definition: Definition, bound: Scope, at: Position) -> Formula | Quantity:
        around = self.entered
        made, height, inside = self._known_body(definition, bound, at)
        self.deepest = max(self.deepest, self.depth + height)
        self.entered = around | inside
        if isinstance(made, Quantity):
            return made
        if self.home is not None:
            before = list(self._around())
            here = self.home.apply(self.home.specification.definitions[definition.name], bound, at)
            if isinstance(here, f.Application) and here.body == made:
                self.entered = around
                return here
            for walk, entered in before:  # it was only compared
                walk.entered = entered
            return f.Application(
                f"{definition.name}@{self.specification.set_name}", scopes.names_in(bound), made
            )
        return f.Application(definition.name, scopes.names_in(bound), made)

    def _known_body(
        self, definition: Definition, bound: Scope, at: Position
    ) -> tuple[Formula | Quantity, int, Entered]:
        """The body of a definition applied to values, how deep it is nested, and what it has entered."""
        key = (definition.name, self.specification.set_name, tuple(bound.values()))
        if key not in self.known:
            if definition.name in self.stack:
                cycle = " -> ".join([*self.stack[self.stack.index(definition.name) :], definition.name])
                raise TextError(f"'{definition.name}' is defined by itself: {cycle}", at)
            before, around = self.deepest, self.entered
            self.deepest = self.depth
            self.entered = {(self.specification.set_name, definition.name): definition}
            try:
                body = self.body_of(definition.name, bound)
                self.known[key] = body, self.deepest - self.depth, self.entered
            finally:
                self.entered = around
            self.deepest = max(before, self.deepest)
        return self.known[key]

    def _around(self) -> Iterator[tuple["Elaborator", Entered]]:
        """The walks that met this one, each with what it has entered so far."""
        walk = self.home
        while walk is not None:
            yield walk, walk.entered
            walk = walk.home

    def body_of(self, name: str, scope: Scope) -> Formula | Quantity:
        """The body of a definition, with mistakes in it located in its own text."""
        definition = self.specification.definitions[name]
        self.stack.append(name)
        try:
            for binding in definition.parameters:
                scopes.check_sort(binding)
            made = self.expression(definition.body, scope)
            if name in self.specification.library.signals:
                arithmetic.check_derived(self.specification.library.signals[name], made, definition.body.at)
            return made
        except TextError as error:
            source = source_of(self.specification.library, definition)
            raise error.locate(source.name, source.text) from None
        finally:
            self.stack.pop()

    def _bind(self, definition: Definition, call: syntax.Call, scope: Scope) -> dict[str, Value]:
        """What each parameter of a definition stands for in a call."""
        bound: dict[str, Value] = {}
        for binding, given in scopes.deal_out(definition, call, scope):
            if binding.sort == "vehicles":
                refs = [self.reference(argument, "vehicle", scope) for argument in given]
                bound[binding.name] = Vehicles(tuple(ref.name for ref in refs))
            elif binding.sort in SORTS:
                bound[binding.name] = self.reference(given[0], binding.sort, scope)
            elif isinstance(given[0], Ref):
                raise TextError(f"'{given[0].name}' is a vehicle; a number is expected here", call.at)
            else:
                scopes.check_sort(binding)
                number = self.term(given[0], scope)
                bound[binding.name] = arithmetic.argument(number, binding, definition, given[0].at)
        return bound

    # --- expressions ---------------------------------------------------------------------------

    def formula(self, expression: Expression, scope: Scope) -> Formula:
        try:
            made = self.expression(expression, scope)
            if not isinstance(made, Quantity):
                return made
            raise TextError(
                "a formula is expected here, but this is a number",
                expression.at,
                "Compare it with something.",
            )
        except TextError as error:
            return self._noted(error, f.TRUE)

    def term(self, expression: Expression, scope: Scope) -> Quantity:
        try:
            made = self.expression(expression, scope)
            if isinstance(made, Quantity):
                return made
            raise TextError("a number is expected here, but this is a formula", expression.at)
        except TextError as error:
            return self._noted(error, _ANY_NUMBER)

    def expression(self, expression: Expression, scope: Scope) -> Formula | Quantity:
        self.depth += 1
        try:
            self.deepest = max(self.deepest, self.depth)
            self.refuse_deeper(self.depth, expression.at)
            self.sizes.count_reading(expression.at)
            made = self._expression(expression, scope)
            self.sizes.check(made.term if isinstance(made, Quantity) else made, expression.at)
            if self.notes is not None and not isinstance(made, Quantity):
                inside = self.specification.definitions[self.stack[-1]] if self.stack else None
                self.notes.append(Note(inside, expression.at, made))
            return made
        finally:
            self.depth -= 1

    def refuse_deeper(self, depth: int, at: Position) -> None:
        """Raises ``TextError`` where expressions are nested deeper than allowed."""
        if depth > DEEPEST_FORMULA:
            raise TextError(
                f"definitions and formula together are nested deeper than {DEEPEST_FORMULA}",
                at,
                "Look for a chain of definitions that only call each other.",
            )

    def _expression(self, expression: Expression, scope: Scope) -> Formula | Quantity:
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
                made = [self.formula(p, scope) for p in parts]
                return f.conjunction(*made) if op == "and" else f.disjunction(*made)
            case syntax.Binary():
                return self._binary(expression, scope)
            case syntax.Temporal(op, bounds, left, right, _):
                interval = self.interval(bounds, scope)
                goal = self.formula(right, scope)
                match op:
                    case "U":
                        assert left is not None  # the grammar
                        return f.Until(self.formula(left, scope), interval, goal)
                    case "F":
                        return f.Eventually(interval, goal)
                    case "G":
                        return f.Always(interval, goal)
                    case _:
                        assert_never(op)
            case syntax.Quantified():
                return self._quantified(expression, scope)

    def _name(self, name: str, at: Position, scope: Scope) -> Formula | Quantity:
        value = scope.get(name)
        if isinstance(value, Quantity):
            return value
        sort = (
            scopes.sort_of(value) if value is not None else scopes.sort_of_free(name) if self._open else None
        )
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
        numbers = [n for n, v in scope.items() if isinstance(v, Quantity)]
        library = self.specification.library
        known = [*library.parameters, *library.signals, *self.specification.definitions, *numbers]
        raise TextError(unknown("parameter or definition", name, known), at, instead_of(name))

    def _binary(self, expression: syntax.Binary, scope: Scope) -> Formula | Quantity:
        op, at = expression.op, expression.at
        if op == "->" or op == "<->":
            join = f.implication if op == "->" else f.equivalence
            return join(self.formula(expression.left, scope), self.formula(expression.right, scope))
        if op in arithmetic.COMPARISONS and (
            syntax.is_kind(expression.left) or syntax.is_kind(expression.right)
        ):
            return kinds.compare(expression, lambda call: self._whose_kind(call, scope))
        left, right = self.term(expression.left, scope), self.term(expression.right, scope)
        if op in arithmetic.COMPARISONS:
            return arithmetic.compare(op, left, right, at)
        return arithmetic.combine(op, left, right, self.specification.library.parameters, at)

    def _whose_kind(self, call: Expression, scope: Scope) -> str:
        if not isinstance(call, syntax.Call) or len(call.arguments) != 1:
            raise TextError("'kind' takes 1 argument, a vehicle", call.at)
        return self.reference(call.arguments[0], "vehicle", scope).name

    def interval(self, bounds: Bounds | None, scope: Scope) -> f.Interval:
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
        scopes.refuse_signal(variable, self.specification.library.signals, expression.at)
        vehicles = scopes.vehicles_in(expression.domain, scope, self._open)
        if vehicles is not None:
            made = [self.formula(expression.body, {**scope, variable: v}) for v in vehicles]
            return f.conjunction(*made) if expression.kind == "every" else f.disjunction(*made)
        domain = scopes.domain_of(expression.domain, scope, self._open)
        sort = "lane" if domain.kind in ("lanes", "adjacent") else "lanelet"
        taken = {v.name for v in scope.values() if isinstance(v, Ref)} | set().union(*self.free.values())
        unique = variable
        while unique in taken:
            unique += "_"
        body = self.formula(expression.body, {**scope, variable: Ref(sort, unique)})
        return (f.Every if expression.kind == "every" else f.Some)(unique, domain, body)

    def _built_in(self, call: syntax.Call, name: str, scope: Scope) -> Formula | Quantity:
        count = len(call.arguments)
        if name in ("lanes", "lanelets", "zone", "adjacentLanes"):
            raise TextError(f"'{name}' is a domain: write some x in {name}…", call.at)
        if name in ("max", "min"):
            if not call.arguments:
                raise TextError(f"'{name}' needs at least one argument", call.at)
            return arithmetic.extremum(name, [self.term(a, scope) for a in call.arguments], call.at)
        if name == "kind":
            raise TextError("a kind is no number", call.at, f"Compare it: kind(SV) = {KINDS[1]}.")
        wanted = 2 if name == "occ" else 1
        if count != wanted:
            raise TextError(
                f"'{name}' takes {wanted} argument{'s' if wanted > 1 else ''} but got {count}", call.at
            )
        first = call.arguments[0]
        if name == "occ":
            vehicle = self.reference(first, "vehicle", scope)
            return f.Occupies(vehicle.name, self.reference(call.arguments[1], "lanelet", scope).name)
        if name in ("abs", "inverse"):
            make = arithmetic.absolute if name == "abs" else arithmetic.inverse
            return make(self.term(first, scope), call.at)
        return arithmetic.of_vehicle(name, self.reference(first, "vehicle", scope).name)
