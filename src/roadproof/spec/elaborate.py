"""Who meets whom: syntax trees to formulas. Names, sorts, arities, units and cycles are checked here.

Applying a definition puts its body in place of the call, wrapped in ``Named``; vehicles and lanes
are names from the start, so what comes out speaks of SV, POV and L and nothing else.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias

from roadproof.errors import Position, TextError
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import vehicles_of
from roadproof.logic.syntax import Binding, Bounds, Definition, Expression
from roadproof.logic.terms import Dimension
from roadproof.spec.library import BUILT_IN, Specification, source_of, unknown
from roadproof.spec.quantity import SECONDS, UNITS, Quantity, product_dimension, same_dimension, unit_name
from roadproof.spec.query import Query
from roadproof.spec.size import Sizes

DEEPEST_FORMULA = 100
SORTS = ("vehicle", "vehicles", "lane", "lanelet")
_VEHICLE = re.compile(r"SV|POV[0-9]?")
_LANE = re.compile(r"L[0-9]?")


@dataclass(frozen=True)
class Ref:
    """A vehicle, lane or lanelet that a name stands for."""

    sort: str
    name: str


@dataclass(frozen=True)
class Vehicles:
    names: tuple[str, ...]


Value: TypeAlias = Ref | Vehicles | Quantity
Scope: TypeAlias = Mapping[str, Value]


def read_claim(specification: Specification, text: str, source: str = "claim") -> Query:
    """Parse and elaborate a claim such as ``scenario_8(SV,POV,L) -> F danger(SV,POV)``.

    SV, POV, POV1…POV9 are vehicles and L, L1…L9 lanes without being declared; others are declared
    in front: ``given A, B: vehicle; v: m/s: …``. ``scenario_4@ext(…)`` names a definition of another
    set. Raises ``TextError``.
    """
    claim = parse_claim(text, source)
    try:
        return replace(elaborate(specification, claim), written=text.strip())
    except TextError as error:
        raise error.locate(source, text) from None


def elaborate(specification: Specification, claim: syntax.Claim) -> Query:
    """What a claim means in a specification. Raises ``TextError``, located where the claim has positions."""
    elaborator = _Elaborator(specification)
    made = elaborator.formula(claim.body, elaborator.scope_of(claim.given))
    declared = [b.name for b in claim.given if b.sort == "vehicle"]
    vehicles = tuple(dict.fromkeys([*declared, *sorted(elaborator.free["vehicle"])]))
    return Query(claim, made, vehicles or vehicles_of(made), tuple(sorted(elaborator.free["lane"])))


def read_term(specification: Specification, text: str, source: str = "term") -> tuple[t.Term, Dimension]:
    """Parse and elaborate a term such as ``v_lon(SV) - v_lon(POV)``, with its dimension.

    Names are free as in ``read_claim``. Raises ``TextError``, for a formula too.
    """
    claim = parse_claim(text, source)
    elaborator = _Elaborator(specification)
    try:
        made = elaborator.term(claim.body, elaborator.scope_of(claim.given))
    except TextError as error:
        raise error.locate(source, text) from None
    return made.term, made.dimension or UNITS["unitless"][1]


def apply_definition(specification: Specification, name: str, arguments: tuple[str, ...] = ()) -> Query:
    """The formula of a definition applied to names; to its own parameters where none are given.

    >>> apply_definition(bundled_library().select(), "scenario_2").vehicles
    ('POV1', 'POV2', 'SV')
    """
    roles = arguments or signature(specification, name.partition("@")[0])
    return elaborate(specification, syntax.Claim((), syntax.Call(name, tuple(map(syntax.Name, roles)))))


def signature(specification: Specification, name: str) -> tuple[str, ...]:
    """Names of the arguments of a definition, a group of vehicles written out as POV or POV1, POV2.

    The size of a group is the smallest that the definitions below accept.
    """
    if name not in specification.definitions:
        raise TextError(unknown("definition", name, specification.definitions))
    parameters = specification.definitions[name].parameters
    failure: TextError | None = None
    for size in (1, 2, 3):
        roles: list[str] = []
        scope: dict[str, Value] = {}
        for binding in parameters:
            if binding.sort != "vehicles":
                roles.append(binding.name)
                scope[binding.name] = _parameter_value(binding)
                continue
            names = (binding.name,) if size == 1 else tuple(f"{binding.name}{k + 1}" for k in range(size))
            roles += names
            scope[binding.name] = Vehicles(names)
        try:
            elaborator = _Elaborator(specification)
            elaborator.body_of(name, scope)
            return tuple(roles)
        except TextError as error:
            failure = failure or error
    assert failure is not None
    raise failure


def _parameter_value(binding: Binding) -> Value:
    if binding.sort in SORTS:
        return Ref(binding.sort, binding.name)
    return Quantity(t.Variable(binding.name, UNITS[binding.sort][1]), UNITS[binding.sort][1])


@dataclass
class _Elaborator:
    """One walk over one claim; ``home`` is set inside ``name@set(…)``, and is the walk that met it."""

    specification: Specification
    home: "_Elaborator | None" = None
    free: dict[str, set[str]] = field(default_factory=lambda: {"vehicle": set(), "lane": set()})
    stack: list[str] = field(default_factory=list)
    depth: int = 0
    known: dict[tuple[str, str, tuple[Value, ...]], Formula | Quantity] = field(default_factory=dict)
    sizes: Sizes = field(default_factory=Sizes)

    # --- names ---------------------------------------------------------------------------------

    def scope_of(self, given: tuple[Binding, ...]) -> Scope:
        scope: dict[str, Value] = {}
        for binding in given:
            if binding.name in scope:
                raise TextError(f"'{binding.name}' is given twice", binding.at)
            self._check_sort(binding)
            if binding.sort in UNITS and binding.name in self.specification.library.parameters:
                raise TextError(
                    f"'{binding.name}' is a parameter of the specification",
                    binding.at,
                    "Give the variable another name.",
                )
            scope[binding.name] = _parameter_value(binding)
            if binding.sort in self.free:
                self.free[binding.sort].add(binding.name)
        return scope

    def _check_sort(self, binding: Binding) -> None:
        if binding.sort not in SORTS and binding.sort not in UNITS:
            raise TextError(unknown("sort or unit", binding.sort, (*SORTS, *UNITS)), binding.at)

    def reference(self, expression: Expression | Ref, sort: str, scope: Scope) -> Ref:
        """A vehicle, lane or lanelet named where that sort is expected."""
        if isinstance(expression, Ref) and expression.sort == sort:
            return expression
        if isinstance(expression, Ref):
            raise TextError(f"'{expression.name}' is a {expression.sort}, but a {sort} is expected here")
        if not isinstance(expression, syntax.Name):
            raise TextError(f"a {sort} is expected here, not an expression", expression.at)
        value = scope.get(expression.name)
        if value is None:
            pattern = {"vehicle": _VEHICLE, "lane": _LANE}.get(sort)
            if not self.stack and pattern is not None and pattern.fullmatch(expression.name):
                self.free[sort].add(expression.name)
                return Ref(sort, expression.name)
            raise TextError(
                unknown(sort, expression.name, [n for n, v in scope.items() if _sort(v) == sort]),
                expression.at,
                f"Declare it in front of the claim: given {expression.name}: {sort}: …"
                if not self.stack and sort in self.free
                else "",
            )
        if not isinstance(value, Ref) or value.sort != sort:
            raise TextError(
                f"'{expression.name}' is a {_sort(value)}, but a {sort} is expected here", expression.at
            )
        return value

    # --- calls ---------------------------------------------------------------------------------

    def call(self, call: syntax.Call, scope: Scope) -> Formula | Quantity:
        name, _, qualifier = call.name.partition("@")
        if qualifier and qualifier != self.specification.set_name:
            return self._in_other_set(call, name, qualifier, scope)
        if name in BUILT_IN:
            return self._built_in(call, name, scope)
        definition = self.specification.definitions.get(name)
        if definition is None:
            everything = [*self.specification.definitions, *BUILT_IN]
            raise TextError(unknown("definition", name, everything), call.at)
        bound = self._bind(definition, call, scope)
        return self.apply(definition, bound, call.at)

    def _in_other_set(self, call: syntax.Call, name: str, qualifier: str, scope: Scope) -> Formula | Quantity:
        if qualifier not in self.specification.library.sets:
            raise TextError(unknown("spec set", qualifier, self.specification.library.sets), call.at)
        inner = _Elaborator(
            self.specification.in_set(qualifier), self, self.free, depth=self.depth, sizes=self.sizes
        )
        return inner.call(syntax.Call(name, call.arguments, call.at), scope)

    def apply(self, definition: Definition, bound: Scope, at: Position) -> Formula | Quantity:
        key = (definition.name, self.specification.set_name, tuple(bound.values()))
        if key not in self.known:
            if definition.name in self.stack:
                cycle = " -> ".join([*self.stack[self.stack.index(definition.name) :], definition.name])
                raise TextError(f"'{definition.name}' is defined by itself: {cycle}", at)
            self.known[key] = self.body_of(definition.name, bound)
        made = self.known[key]
        if isinstance(made, Quantity):
            return made
        if self.home is not None:
            here = self.home.apply(self.home.specification.definitions[definition.name], bound, at)
            if isinstance(here, f.Named) and here.body == made:
                return here
            return f.Named(f"{definition.name}@{self.specification.set_name}", _names(bound), made)
        return f.Named(definition.name, _names(bound), made)

    def body_of(self, name: str, scope: Scope) -> Formula | Quantity:
        """The body of a definition, with mistakes in it located in its own text."""
        definition = self.specification.definitions[name]
        self.stack.append(name)
        try:
            for binding in definition.parameters:
                self._check_sort(binding)
            return self.expression(definition.body, scope)
        except TextError as error:
            source = source_of(self.specification.library, definition)
            raise error.locate(source.name, source.text) from None
        finally:
            self.stack.pop()

    def _bind(self, definition: Definition, call: syntax.Call, scope: Scope) -> dict[str, Value]:
        """Arguments to parameters; one parameter of sort vehicles takes what the others leave."""
        parameters = definition.parameters
        arguments = self._spread(call.arguments, scope)
        groups = [b for b in parameters if b.sort == "vehicles"]
        if len(groups) > 1:
            raise TextError(f"'{definition.name}' has more than one parameter of sort vehicles", call.at)
        left_over = len(arguments) - len(parameters) + len(groups)
        if (groups and left_over < 1) or (not groups and left_over != 0):
            names = ", ".join(f"{b.name}: {b.sort}" for b in parameters)
            raise TextError(
                f"'{definition.name}' takes {'at least ' if groups else ''}{len(parameters)} "
                f"argument{'s' if len(parameters) != 1 else ''} but got {len(arguments)}",
                call.at,
                f"It is {definition.name}({names}).",
            )
        bound: dict[str, Value] = {}
        rest = list(arguments)
        for binding in parameters:
            if binding.sort == "vehicles":
                taken, rest = rest[:left_over], rest[left_over:]
                bound[binding.name] = Vehicles(tuple(self.reference(a, "vehicle", scope).name for a in taken))
            elif binding.sort in SORTS:
                bound[binding.name] = self.reference(rest.pop(0), binding.sort, scope)
            else:
                quantity = rest.pop(0)
                if isinstance(quantity, Ref):
                    raise TextError(f"'{quantity.name}' is a vehicle; a number is expected here", call.at)
                bound[binding.name] = self._argument(quantity, binding, definition, scope)
        return bound

    def _argument(
        self, expression: Expression, binding: Binding, definition: Definition, scope: Scope
    ) -> Quantity:
        self._check_sort(binding)
        quantity = self.term(expression, scope)
        wanted = UNITS[binding.sort][1]
        if quantity.dimension not in (None, wanted):
            raise TextError(
                f"argument {binding.name} of '{definition.name}' is in {binding.sort}, "
                f"but this is in {unit_name(quantity.dimension)}",
                expression.at,
            )
        return Quantity(quantity.term, wanted)

    def _spread(self, arguments: tuple[Expression, ...], scope: Scope) -> list[Expression | Ref]:
        """Arguments with each group of vehicles replaced by its members."""
        spread: list[Expression | Ref] = []
        for argument in arguments:
            value = scope.get(argument.name) if isinstance(argument, syntax.Name) else None
            if isinstance(value, Vehicles):
                spread += [Ref("vehicle", name) for name in value.names]
            else:
                spread.append(argument)
        return spread

    # --- expressions ---------------------------------------------------------------------------

    def formula(self, expression: Expression, scope: Scope) -> Formula:
        made = self.expression(expression, scope)
        if isinstance(made, Quantity):
            raise TextError(
                "a formula is expected here, but this is a number",
                expression.at,
                "Compare it with something.",
            )
        return made

    def term(self, expression: Expression, scope: Scope) -> Quantity:
        made = self.expression(expression, scope)
        if not isinstance(made, Quantity):
            raise TextError("a number is expected here, but this is a formula", expression.at)
        return made

    def expression(self, expression: Expression, scope: Scope) -> Formula | Quantity:
        self.depth += 1
        try:
            if self.depth > DEEPEST_FORMULA:
                raise TextError(
                    f"definitions and formula together are nested deeper than {DEEPEST_FORMULA}",
                    expression.at,
                    "Look for a chain of definitions that only call each other.",
                )
            self.sizes.count_reading(expression.at)
            made = self._expression(expression, scope)
            self.sizes.check(made.term if isinstance(made, Quantity) else made, expression.at)
            return made
        finally:
            self.depth -= 1

    def _expression(self, expression: Expression, scope: Scope) -> Formula | Quantity:
        match expression:
            case syntax.Literal_(bool(), _, _):
                return f.Truth(bool(expression.value))
            case syntax.Literal_(value, unit, _):
                factor, dimension = UNITS[unit] if unit else UNITS["unitless"]
                free = not unit and value == 0
                return Quantity(t.Number(Fraction(value) * factor, dimension), None if free else dimension)
            case syntax.Name(name, at):
                return self._name(name, at, scope)
            case syntax.Call():
                return self.call(expression, scope)
            case syntax.Prefix("not", body, _):
                return f.negation(self.formula(body, scope))
            case syntax.Prefix(_, body, _):
                quantity = self.term(body, scope)
                return Quantity(t.negate(quantity.term), quantity.dimension)
            case syntax.Chain(op, parts, _):
                made = [self.formula(p, scope) for p in parts]
                return f.conjunction(*made) if op == "and" else f.disjunction(*made)
            case syntax.Binary():
                return self._binary(expression, scope)
            case syntax.Temporal(op, bounds, left, right, _):
                interval = self.interval(bounds, scope)
                goal = self.formula(right, scope)
                if left is not None:
                    return f.Until(self.formula(left, scope), interval, goal)
                return f.Eventually(interval, goal) if op == "F" else f.Always(interval, goal)
            case syntax.Quantified():
                return self._quantified(expression, scope)

    def _name(self, name: str, at: Position, scope: Scope) -> Formula | Quantity:
        value = scope.get(name)
        if isinstance(value, Quantity):
            return value
        if value is not None:
            raise TextError(f"'{name}' is a {_sort(value)}; a formula or number is expected here", at)
        declared = self.specification.library.parameters.get(name)
        if declared is not None:
            dimension = UNITS[declared.unit][1]
            return Quantity(t.Parameter(name, dimension), dimension)
        if name in self.specification.definitions:
            raise TextError(f"'{name}' needs its arguments", at, f"Write {name}(…).")
        numbers = [n for n, v in scope.items() if isinstance(v, Quantity)]
        known = [*self.specification.library.parameters, *self.specification.definitions, *numbers]
        raise TextError(unknown("parameter or definition", name, known), at)

    def _binary(self, expression: syntax.Binary, scope: Scope) -> Formula | Quantity:
        op, at = expression.op, expression.at
        if op == "->" or op == "<->":
            join = f.implication if op == "->" else f.equivalence
            return join(self.formula(expression.left, scope), self.formula(expression.right, scope))
        left, right = self.term(expression.left, scope), self.term(expression.right, scope)
        if op in ("<", "<=", ">", ">=", "=", "!="):
            same_dimension(left, right, "compared", at)
            return _comparison(op, left.term, right.term)
        for side in (left, right):
            if isinstance(side.term, t.Inverse):
                raise TextError("inverse(…) may only stand alone on one side of a comparison", at)
        if op == "+" or op == "-":
            dimension = same_dimension(left, right, "added", at)
            join_terms = t.Sum((left.term, right.term)) if op == "+" else t.subtract(left.term, right.term)
            return Quantity(join_terms, dimension)
        if op == "*":
            return Quantity(t.Product((left.term, right.term)), product_dimension(left, right, 1))
        if op == "/":
            return Quantity(self._divide(left.term, right.term, at), product_dimension(left, right, -1))
        exponent = t.constant_value(right.term)
        assert exponent is not None, "the grammar admits only a number as exponent"
        power = int(exponent)
        base = left.dimension or (0, 0)
        return Quantity(t.Power(left.term, power), (base[0] * power, base[1] * power))

    def _divide(self, numerator: t.Term, denominator: t.Term, at: Position) -> t.Term:
        if not self._is_positive(denominator):
            raise TextError(
                "the divisor must be greater than zero whatever happens",
                at,
                "Use numbers and parameters declared with where … > 0; or multiply the other side of the "
                "comparison; or write inverse(…), where inverse(0) is infinite.",
            )
        return t.Quotient(numerator, denominator)

    def _is_positive(self, term: t.Term, or_zero: bool = False) -> bool:
        """Whether ``term`` is greater than zero (or not below it) by its form alone."""
        match term:
            case t.Number(value, _):
                return value > 0 or (or_zero and value == 0)
            case t.Parameter(name, _):
                bound = self.specification.library.parameters[name].bound
                return bound == ">" or (or_zero and bound == ">=")
            case t.Size():
                return True
            case t.Sum() | t.Product() | t.Power() | t.Quotient() | t.Maximum() | t.Minimum():
                return all(self._is_positive(child, or_zero) for child in t.children(term))
            case _:
                return False

    def interval(self, bounds: Bounds | None, scope: Scope) -> f.Interval:
        if bounds is None:
            return f.FOREVER
        low = self._bound(bounds.low, scope)
        high = None if bounds.high is None else self._bound(bounds.high, scope)
        low_value = t.constant_value(low)
        high_value = None if high is None else t.constant_value(high)
        if low_value is not None and low_value < 0:
            raise TextError(f"an interval may not start in the past: low={low_value}", bounds.at)
        if low_value is not None and high_value is not None and high_value < low_value:
            raise TextError(
                f"the interval is empty: low={low_value} is above high={high_value}",
                bounds.at,
                "Write the smaller bound first.",
            )
        return f.Interval(low, high)

    def _bound(self, expression: Expression, scope: Scope) -> t.Term:
        quantity = self.term(expression, scope)
        plain = t.constant_value(quantity.term) is not None and quantity.dimension in (None, (0, 0))
        if not plain and quantity.dimension != SECONDS:
            raise TextError(
                f"an interval bound is a time, but this is in {unit_name(quantity.dimension)}", expression.at
            )
        if any(isinstance(leaf, t.Signal) for leaf in t.leaves(quantity.term)):
            raise TextError("an interval bound may not depend on a vehicle's motion", expression.at)
        value = t.constant_value(quantity.term)
        if value is None and not self._is_positive(quantity.term, or_zero=True):
            raise TextError(
                "an interval bound may never be negative",
                expression.at,
                "Use numbers and parameters declared with where … >= 0, added or multiplied.",
            )
        return quantity.term if value is None else t.Number(value, SECONDS)

    # --- quantifiers and built-in names ----------------------------------------------------------

    def _quantified(self, expression: syntax.Quantified, scope: Scope) -> Formula:
        variable = expression.variable
        vehicles = self._vehicles(expression.domain, scope)
        if vehicles is not None:
            made = [self.formula(expression.body, {**scope, variable: v}) for v in vehicles]
            return f.conjunction(*made) if expression.kind == "every" else f.disjunction(*made)
        domain = self._domain(expression.domain, scope)
        sort = "lane" if domain.kind in ("lanes", "adjacent") else "lanelet"
        taken = {v.name for v in scope.values() if isinstance(v, Ref)} | set().union(*self.free.values())
        unique = variable
        while unique in taken:
            unique += "_"
        body = self.formula(expression.body, {**scope, variable: Ref(sort, unique)})
        return (f.Every if expression.kind == "every" else f.Some)(unique, domain, body)

    def _vehicles(self, domain: syntax.Name | syntax.Call | syntax.Group, scope: Scope) -> list[Ref] | None:
        if isinstance(domain, syntax.Group):
            return [self.reference(member, "vehicle", scope) for member in domain.members]
        value = scope.get(domain.name) if isinstance(domain, syntax.Name) else None
        return [Ref("vehicle", name) for name in value.names] if isinstance(value, Vehicles) else None

    def _domain(self, domain: syntax.Name | syntax.Call | syntax.Group, scope: Scope) -> f.Domain:
        if isinstance(domain, syntax.Name) and domain.name == "lanes":
            return f.Domain("lanes")
        if isinstance(domain, syntax.Call):
            argument = domain.arguments[0]
            if domain.name == "zone" and isinstance(argument, syntax.Name):
                if argument.name not in ("main", "merge", "depart"):
                    raise TextError(unknown("zone", argument.name, ("main", "merge", "depart")), argument.at)
                return f.Domain("zone", argument.name)
            if domain.name == "lanelets":
                return f.Domain("lanelets", self.reference(argument, "lane", scope).name)
            if domain.name == "adjacentLanes":
                return f.Domain("adjacent", self.reference(argument, "lane", scope).name)
        raise TextError(
            "this is no domain to quantify over",
            domain.at,
            "Use lanes, lanelets(L), zone(main), adjacentLanes(L), a group of vehicles, or {SV, POV}.",
        )

    def _built_in(self, call: syntax.Call, name: str, scope: Scope) -> Formula | Quantity:
        count = len(call.arguments)
        if name in ("lanes", "lanelets", "zone", "adjacentLanes"):
            raise TextError(f"'{name}' is a domain: write some x in {name}…", call.at)
        if name in ("max", "min"):
            return self._extremum(call, name, scope)
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
            inner = self.term(first, scope)
            if name == "abs":
                return Quantity(t.Maximum((inner.term, t.negate(inner.term))), inner.dimension)
            return Quantity(t.Inverse(inner.term), product_dimension(Quantity(inner.term, (0, 0)), inner, -1))
        vehicle_name = self.reference(first, "vehicle", scope).name
        for size, dimension in t.SIZE_DIMENSIONS.items():
            if name == size:
                return Quantity(t.Size(size, vehicle_name), dimension)
        for signal, dimension in t.SIGNAL_DIMENSIONS.items():
            if name == signal:
                return Quantity(t.Signal(signal, vehicle_name), dimension)
        raise AssertionError(name)

    def _extremum(self, call: syntax.Call, name: str, scope: Scope) -> Quantity:
        if not call.arguments:
            raise TextError(f"'{name}' needs at least one argument", call.at)
        quantities = [self.term(a, scope) for a in call.arguments]
        for other in quantities[1:]:
            same_dimension(quantities[0], other, "compared", call.at)
        if any(isinstance(q.term, t.Inverse) for q in quantities):
            raise TextError("inverse(…) may only stand alone on one side of a comparison", call.at)
        dimension = next((q.dimension for q in quantities if q.dimension is not None), None)
        make = t.Maximum if name == "max" else t.Minimum
        return Quantity(make(tuple(q.term for q in quantities)), dimension)


def _sort(value: Value) -> str:
    match value:
        case Ref(sort, _):
            return sort
        case Vehicles():
            return "group of vehicles"
        case Quantity():
            return "number"


def _names(bound: Scope) -> tuple[str, ...]:
    names: list[str] = []
    for value in bound.values():
        match value:
            case Ref(_, name):
                names.append(name)
            case Vehicles(members):
                names += members
            case Quantity():
                names.append("…")
    return tuple(names)


def _comparison(op: str, left: t.Term, right: t.Term) -> Formula:
    match op:
        case "<" | "<=" | ">" | ">=":
            return f.Compare(left, op, right)
        case "=":
            return f.And((f.Compare(left, "<=", right), f.Compare(left, ">=", right)))
        case _:
            return f.Or((f.Compare(left, "<", right), f.Compare(left, ">", right)))
