"""Printing is parsing's inverse."""

from collections.abc import Mapping
from fractions import Fraction

import pytest
from hypothesis import given, settings

from examples import some
from logic import strategies
from planting import plant
from roadproof.evidence.answers.tree import claim_node
from roadproof.evidence.codec import write
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import latex as latex_module
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.latex import align, latex, symbol
from roadproof.logic.parse import parse_claim, parse_library
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.rewrite import map_terms
from roadproof.logic.show import decimal, text
from tables import read_table

LIBRARY = bundled_library()


@given(strategies.expressions())
@settings(max_examples=some(250), deadline=None, derandomize=True)
def test_text_of_a_tree_parses_to_the_tree(tree: syntax.Expression) -> None:
    for width in (None, 40):
        assert parse_claim(text(tree, width)).body == tree


@given(strategies.formulas())
@settings(max_examples=80, deadline=None, derandomize=True)
def test_text_of_a_formula_elaborates_to_the_formula(formula: Formula) -> None:
    specification = LIBRARY.select("ext")
    collapsed = read_claim(specification, text(as_syntax(formula))).formula
    assert canonical(collapsed, keep_names=True) == canonical(formula, keep_names=True)
    expanded = read_claim(specification, text(as_syntax(formula, expand=True), 80)).formula
    assert canonical(expanded) == canonical(formula)
    assert not any(isinstance(part, f.Application) for part in f.subformulas(expanded))


@pytest.mark.parametrize("set_name", ["base", "extA", "ext"])
def test_scenarios_read_back(set_name: str) -> None:
    specification = LIBRARY.select(set_name)
    for number in range(1, 25):
        formula = apply_definition(specification, f"scenario_{number}").formula
        assert read_claim(specification, text(as_syntax(formula))).formula == formula
        assert isinstance(formula, f.Application)
        assert read_claim(specification, text(as_syntax(formula.body))).formula == formula.body
        expanded = read_claim(specification, text(as_syntax(formula, expand=True), 100)).formula
        assert canonical(expanded) == canonical(formula)


@pytest.mark.parametrize("options", [{}, {"lateral_rss": "signed", "rss_form": "robust", "speed": "total"}])
@pytest.mark.parametrize("set_name", ["base", "extA", "ext"])
def test_definitions_read_back(set_name: str, options: Mapping[str, str]) -> None:
    for definition in LIBRARY.select(set_name, options).definitions.values():
        for width in (None, 60):
            assert parse_library(text(definition, width), "shown") == (definition,)


@pytest.mark.parametrize(
    ("written", "shown"),
    read_table(__file__, "parentheses_are_minimal"),
)
def test_parentheses_are_minimal(written: str, shown: str) -> None:
    assert text(parse_claim(written)) == shown


def test_long_text_is_broken_at_its_outermost_operators() -> None:
    claim = parse_claim("given A: vehicle: alpha(A) and (beta(A) or gamma(A)) and F[0, 3 s] delta(A)")
    assert text(claim, 40) == "\n".join(
        ["given A: vehicle:", "  alpha(A)", "  and (beta(A) or gamma(A))", "  and F[0, 3 s] delta(A)"]
    )


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (Fraction(0), "0"),
        (Fraction(3, 5), "0.6"),
        (Fraction(1, 8), "0.125"),
        (Fraction(1001, 100), "10.01"),
        (Fraction(1, 3), None),
        (Fraction(1, 6), None),
        (Fraction(10**30), "1" + "0" * 30),
    ],
)
def test_decimals(value: Fraction, shown: str | None) -> None:
    assert decimal(value) == shown


def test_the_longest_numbers_read_back() -> None:
    for written in ("9" * 196 + "e30", "0." + "7" * 194 + "e-30", "1e-30", "123.456e7"):
        literal = parse_claim(written).body
        assert parse_claim(text(literal)).body == literal


def test_numbers_keep_their_units() -> None:
    shown = {
        text(term_as_syntax(t.number(Fraction(3, 2), dimension)))
        for dimension in [(0, 0), (0, 1), (1, 0), (1, -1), (1, -2)]
    }
    assert shown == {"1.5", "1.5 s", "1.5 m", "1.5 m/s", "1.5 m/s^2"}
    assert text(term_as_syntax(t.number(-3, (1, 0)))) == "-3 m"
    assert text(term_as_syntax(t.number(Fraction(1, 3), (0, 1)))) == "1/3*1 s"
    assert text(term_as_syntax(t.number(5, (2, -2)))) == "5*((1 m)^2/(1 s)^2)"


def test_arguments_without_names_are_written_out() -> None:
    body = f.Compare(t.Signal("v_lon", "SV"), ">", t.number(0))
    assert text(as_syntax(f.Application("fast", ("SV",), body))) == "fast(SV)"
    assert text(as_syntax(f.Application("faster", ("SV", "…"), body))) == "v_lon(SV) > 0"
    assert text(as_syntax(f.Application("atLane", ("SV", "main-1"), body))) == "v_lon(SV) > 0"


# --- equality up to what printing may change ------------------------------------------------------


def with_folded_numbers(formula: Formula) -> Formula:
    """``1/3 * 1 s`` as 1/3 s: products and quotients of nothing but numbers become numbers."""
    return map_terms(formula, _fold)


def _fold(term: t.Term) -> t.Term:
    match term:
        case t.Product(factors):
            folded = tuple(_fold(x) for x in factors)
            numbers = [x for x in folded if isinstance(x, t.Number)]
            if len(numbers) < len(folded):
                return t.Product(folded)
            value, dimension = Fraction(1), (0, 0)
            for x in numbers:
                value *= x.value
                dimension = (dimension[0] + x.dimension[0], dimension[1] + x.dimension[1])
            return t.Number(value, dimension)
        case t.Quotient(upper, lower):
            top, bottom = _fold(upper), _fold(lower)
            if isinstance(top, t.Number) and isinstance(bottom, t.Number):
                assert bottom.dimension == (0, 0)
                return t.Number(top.value / bottom.value, top.dimension)
            return t.Quotient(top, bottom)
        case t.Sum(terms):
            return t.Sum(tuple(_fold(x) for x in terms))
        case t.Maximum(terms):
            return t.Maximum(tuple(_fold(x) for x in terms))
        case t.Minimum(terms):
            return t.Minimum(tuple(_fold(x) for x in terms))
        case t.Power(inner, exponent):
            return t.Power(_fold(inner), exponent)
        case t.Inverse(inner):
            return t.Inverse(_fold(inner))
        case _:
            return term


def canonical(formula: Formula, keep_names: bool = False) -> Formula:
    """Bound variables numbered, no constants inside, numbers folded, and no names of definitions."""
    return with_folded_numbers(_renamed(formula, {}, keep_names))


def _renamed(formula: Formula, scope: Mapping[str, str], keep_names: bool) -> Formula:
    match formula:
        case f.Application(name, arguments, body):
            inner = _renamed(body, scope, keep_names)
            return (
                f.Application(name, tuple(scope.get(a, a) for a in arguments), inner) if keep_names else inner
            )
        case f.Occupies(vehicle, lanelet):
            return f.Occupies(vehicle, scope.get(lanelet, lanelet))
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            deep = int(scope.get("", "0"))
            number = f"bound{deep}"
            where = f.Domain(domain.kind, scope.get(domain.of, domain.of))
            inner = _renamed(body, {**scope, variable: number}, keep_names)
            return (
                f.Some(number, where, inner) if isinstance(formula, f.Some) else f.Every(number, where, inner)
            )
        case f.And(parts):
            return f.conjunction(*(_renamed(part, scope, keep_names) for part in parts))
        case f.Or(parts):
            return f.disjunction(*(_renamed(part, scope, keep_names) for part in parts))
        case _:
            parts = tuple(_renamed(child, scope, keep_names) for child in f.children(formula))
            return f.with_children(formula, parts)


# --- LaTeX that reads like the paper's --------------------------------------------------------------

DEFINITIONS = bundled_library().select("ext").definitions


@pytest.mark.parametrize(
    ("name", "shown"),
    read_table(__file__, "symbols"),
)
def test_symbols(name: str, shown: str) -> None:
    assert symbol(name) == shown


@pytest.mark.parametrize(
    ("name", "shown"),
    read_table(__file__, "definitions_read_like_the_paper"),
)
def test_definitions_read_like_the_paper(name: str, shown: str) -> None:
    assert latex(DEFINITIONS[name]) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    read_table(__file__, "formulas"),
)
def test_formulas(text: str, shown: str) -> None:
    assert latex(parse_claim(text)) == shown


PARENTHESES = [
    (r"{_bounds(bounds)} {_show(right, show.UNARY)}", r"{_bounds(bounds)} {_show(right, show.UNTIL)}"),
    (r"\neg {_show(body, show.UNARY)}", r"\neg {_show(body, show.UNTIL)}"),
    ("{_show(left, show.UNARY)} {between}", "{_show(left, show.UNTIL)} {between}"),
    ("{_show(right, show.UNTIL)}", "{_show(right, show.AND)}"),
    (
        "{_range(symbol(variable), domain)}}} {_show(body, show.UNARY)}",
        "{_range(symbol(variable), domain)}}} {_show(body, show.OR)}",
    ),
]


@pytest.mark.parametrize(("right", "wrong"), PARENTHESES)
def test_parentheses_that_are_lost_are_noticed(
    right: str, wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    texts = ["F (a U b)", "not (a U b)", "(a U b) U c", "a U (b and c)", "every x in {SV}: (a U b)"]
    shown = [latex(parse_claim(text)) for text in texts]
    plant(monkeypatch, latex_module, "_operator", right, wrong)
    assert [latex(parse_claim(text)) for text in texts] != shown


def test_align_puts_definitions_below_each_other() -> None:
    shown = align([DEFINITIONS["front"], DEFINITIONS["accelerates"]])
    assert shown.splitlines() == [
        r"\begin{align*}",
        r"\mathit{front}(a) &\;:=\; s_{a} \\",
        r"\mathit{accelerates}(a) &\;:=\; a_{\mathit{lon},a} > 0",
        r"\end{align*}",
    ]


def test_braces_balance_in_every_definition() -> None:
    for definition in DEFINITIONS.values():
        shown = latex(definition).replace(r"\{", "").replace(r"\}", "")
        assert shown.count("{") == shown.count("}")
        assert shown.count(r"\left(") == shown.count(r"\right)")


def test_tree_is_plain_data() -> None:
    claim = parse_claim("given v: m/s: some x in {SV}: G[0, 0.5 s] (not p(x) U v > 1 m/s)")
    assert write(claim_node(claim)) == {
        "node": "claim",
        "given": [{"name": "v", "sort": "m/s"}],
        "body": {
            "node": "some",
            "variable": "x",
            "domain": {"node": "group", "members": ["SV"]},
            "body": {
                "node": "G",
                "low": {"node": "number", "value": "0", "unit": ""},
                "high": {"node": "number", "value": "1/2", "unit": "s"},
                "body": {
                    "node": "U",
                    "low": {"node": "number", "value": "0", "unit": ""},
                    "high": None,
                    "left": {"node": "not", "body": {"node": "call", "name": "p", "arguments": [
                        {"node": "name", "name": "x"}
                    ]}},
                    "right": {
                        "node": ">",
                        "left": {"node": "name", "name": "v"},
                        "right": {"node": "number", "value": "1", "unit": "m/s"},
                    },
                },
            },
        },
    }  # fmt: skip
