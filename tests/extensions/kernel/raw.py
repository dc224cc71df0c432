"""Formulas as constructors of Meaning.v alone, written apart from the printer; and random formulas."""

import random
from fractions import Fraction

from roadproof.logic import formula as f
from roadproof.logic import terms as t

SIGNALS = {
    "s": "Place_lon",
    "d": "Place_lat",
    "v_lon": "Speed_lon",
    "v_lat": "Speed_lat",
    "a_lon": "Acceleration_lon",
    "a_lat": "Acceleration_lat",
    "j_lon": "Jerk_lon",
}
SIZES = {"length": "Length", "width": "Width", "kind": "Kind"}
COMPARISONS = {"<": "LT", "<=": "LE", ">": "GT", ">=": "GE"}


def text(name):
    return f'"{name}"%string'


def rational(value):
    return f"(Qmake ({value.numerator}) {value.denominator})"


def fold_left(word, parts):
    found, *others = parts
    for x in others:
        found = f"({word} {found} {x})"
    return found


def fold_right(word, parts):
    *others, found = parts
    for x in reversed(others):
        found = f"({word} {x} {found})"
    return found


def term(x):
    match x:
        case t.Number(value, _):
            return f"(Num {rational(value)})"
        case t.Parameter(name, _):
            return f"(Par {text(name)})"
        case t.Variable(name, _):
            return f"(Var {text(name)})"
        case t.Signal(name, vehicle):
            return f"(Sig {SIGNALS[name]} {text(vehicle)})"
        case t.CustomSignal(name, vehicle):
            return f"(Sig (Own {text(name)}) {text(vehicle)})"
        case t.Size(name, vehicle):
            return f"(Siz {SIZES[name]} {text(vehicle)})"
        case t.Sum(parts):
            return fold_left("Add", map(term, parts))
        case t.Product(parts):
            return fold_left("Mul", map(term, parts))
        case t.Maximum(parts):
            return fold_left("Max", map(term, parts))
        case t.Minimum(parts):
            return fold_left("Min", map(term, parts))
        case t.Power(base, exponent):
            return f"(Pow {term(base)} {exponent}%nat)"
        case t.Quotient(above, below):
            return f"(Div {term(above)} {term(below)})"
    raise AssertionError(x)


def side(x):
    return f"(Inv {term(x.term)})" if isinstance(x, t.Inverse) else f"(Fin {term(x)})"


def height(x):
    inside = max((height(y) for y in f.children(x)), default=0)
    return max(inside, height(x.body) + 1) if isinstance(x, f.Some | f.Every) else inside


def road(name, bound):
    return f"(Bound {bound[name]}%nat)" if name in bound else f"(Free {text(name)})"


def domain(x, bound):
    match x.kind:
        case "lanes":
            return "Lanes"
        case "zone":
            return f"(Zone {x.of})"
        case _:
            return f"({'Adjacent' if x.kind == 'adjacent' else 'Lanelets'} {road(x.of, bound)})"


def interval(x):
    return f"{term(x.low)} {'None' if x.high is None else f'(Some {term(x.high)})'}"


def formula(x, bound=None):
    bound = bound or {}
    match x:
        case f.Truth(value):
            return f"(Truth {str(value).lower()})"
        case f.Compare(left, op, right):
            return f"(Compare {side(left)} {COMPARISONS[op]} {side(right)})"
        case f.Occupies(vehicle, lanelet):
            return f"(Occupies {text(vehicle)} {road(lanelet, bound)})"
        case f.Some(variable, where, body) | f.Every(variable, where, body):
            number = height(body)
            inside = formula(body, {**bound, variable: number})
            word = "Some_" if isinstance(x, f.Some) else "Every"
            return f"({word} {number}%nat {domain(where, bound)} {inside})"
        case f.Not(body):
            return f"(Not {formula(body, bound)})"
        case f.And(parts):
            return fold_right("And", [formula(y, bound) for y in parts])
        case f.Or(parts):
            return fold_right("Or", [formula(y, bound) for y in parts])
        case f.Until(left, within, right):
            return f"(Until {formula(left, bound)} {interval(within)} {formula(right, bound)})"
        case f.Eventually(within, body):
            return f"(Eventually {interval(within)} {formula(body, bound)})"
        case f.Always(within, body):
            return f"(Always {interval(within)} {formula(body, bound)})"
        case f.Application(_, _, body):
            return formula(body, bound)
    raise AssertionError(x)


# --- random formulas -----------------------------------------------------------------------------

# Names that are words of Coq, of the notations, or of what is printed beside them.
NAMES = ["SV", "POV", "F", "and", "Qed", "claim", "s", "L", "l", "max", "forall", "x_1", "danger", "q"]


def random_formula(seed):
    """Any formula that the printer may meet, with definitions inside definitions and names of all kinds."""
    r = random.Random(seed)

    def a_term(deep):
        shape = (
            r.choice(["leaf"] * 2 + ["sum", "product", "power", "over", "max", "min", "minus"])
            if deep
            else "leaf"
        )
        some = lambda: tuple(a_term(deep - 1) for _ in range(r.randint(1, 3)))  # noqa: E731
        match shape:
            case "sum":
                return t.Sum(some())
            case "product":
                return t.Product(some())
            case "max":
                return t.Maximum(some())
            case "min":
                return t.Minimum(some())
            case "minus":
                return t.Sum((a_term(deep - 1), t.negate(a_term(deep - 1))))
            case "power":
                return t.Power(a_term(deep - 1), r.randint(0, 3))
            case "over":
                return t.Quotient(a_term(deep - 1), a_term(deep - 1))
        match r.randint(0, 5):
            case 0:
                return t.Number(Fraction(r.randint(-9, 9), r.choice([1, 1, 5])))
            case 1:
                return t.Parameter(r.choice(NAMES))
            case 2:
                return t.Variable(r.choice(NAMES))
            case 3:
                return t.Size(r.choice([*SIZES]), r.choice(NAMES))
            case 4:
                return t.CustomSignal(r.choice(NAMES), r.choice(["", *NAMES]), truth=r.random() < 0.5)
        return t.Signal(r.choice([*SIGNALS]), r.choice(NAMES))

    def a_side(deep):
        return t.Inverse(a_term(deep)) if r.random() < 0.15 else a_term(deep)

    def an_interval():
        high = None if r.random() < 0.4 else a_term(1)
        return f.Interval(f.ZERO if r.random() < 0.5 else a_term(1), high)

    def a_domain(roads):
        kind = r.choice(["lanes", "adjacent", "lanelets", "zone"])
        of = {"lanes": "", "zone": r.choice(["main", "merge", "depart"])}.get(kind)
        return f.Domain(kind, r.choice(roads) if of is None else of)

    def a_formula(deep, roads):
        kinds = ["not", "and", "or", "F", "G", "U", "some", "every", "named", "if"]
        match r.choice(kinds) if deep else "leaf":
            case "not":
                return f.Not(a_formula(deep - 1, roads))
            case "and":
                return f.And(tuple(a_formula(deep - 1, roads) for _ in range(r.randint(1, 3))))
            case "or":
                return f.Or(tuple(a_formula(deep - 1, roads) for _ in range(r.randint(1, 3))))
            case "if":
                return f.Or((f.Not(a_formula(deep - 1, roads)), a_formula(deep - 1, roads)))
            case "F":
                return f.Eventually(an_interval(), a_formula(deep - 1, roads))
            case "G":
                return f.Always(an_interval(), a_formula(deep - 1, roads))
            case "U":
                return f.Until(a_formula(deep - 1, roads), an_interval(), a_formula(deep - 1, roads))
            case "some" | "every" as word:
                name = r.choice(NAMES)
                inside = a_formula(deep - 1, [*roads, name, name])
                return (f.Some if word == "some" else f.Every)(name, a_domain(roads), inside)
            case "named":
                arguments = tuple(r.choice(NAMES) for _ in range(r.randint(0, 3)))
                return f.Application(
                    r.choice([*NAMES, "scenario_4@ext"]), arguments, a_formula(deep - 1, roads)
                )
        match r.randint(0, 3):
            case 0:
                return f.Truth(r.random() < 0.5)
            case 1:
                return f.Occupies(r.choice(NAMES), r.choice(roads))
        return f.Compare(a_side(2), r.choice([*COMPARISONS]), a_side(2))

    return a_formula(r.randint(1, 5), NAMES[:4])
