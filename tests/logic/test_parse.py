"""The grammar: precedence, numbers, what is refused and where."""

from fractions import Fraction

import pytest

from roadproof.errors import TextError
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.parse import DEEPEST_NESTING, parse_claim, parse_library
from roadproof.logic.syntax import (
    Binary,
    Bounds,
    Call,
    Chain,
    Definition,
    EachBlock,
    Expression,
    Group,
    Literal_,
    Name,
    OptionDeclaration,
    ParameterDeclaration,
    Prefix,
    Quantified,
    SetBlock,
    Temporal,
    WhenBlock,
)
from tables import read_table

A, B, C, D = (Name(name) for name in "abcd")


def number(value: int | str, unit: str = "") -> Literal_:
    return Literal_(Fraction(value), unit)


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("a and b or c and d", Chain("or", (Chain("and", (A, B)), Chain("and", (C, D))))),
        ("a or b -> c", Binary("->", Chain("or", (A, B)), C)),
        ("a -> b -> c", Binary("->", A, Binary("->", B, C))),
        ("a <-> b <-> c", Binary("<->", Binary("<->", A, B), C)),
        ("a -> b <-> c", Binary("<->", Binary("->", A, B), C)),
        ("a U b U c", Temporal("U", None, A, Temporal("U", None, B, C))),
        ("a and b U c", Chain("and", (A, Temporal("U", None, B, C)))),
        ("not a U b", Temporal("U", None, Prefix("not", A), B)),
        ("not a and b", Chain("and", (Prefix("not", A), B))),
        ("F a and b", Chain("and", (Temporal("F", None, None, A), B))),
        ("G F a", Temporal("G", None, None, Temporal("F", None, None, A))),
        ("F a < b", Temporal("F", None, None, Binary("<", A, B))),
        ("some x in b: a and c", Quantified("some", "x", B, Chain("and", (A, C)))),
        ("(some x in b: a) and c", Chain("and", (Quantified("some", "x", B, A), C))),
        ("every x in {a, b}: c", Quantified("every", "x", Group((A, B)), C)),
        ("every x in zone(a): c", Quantified("every", "x", Call("zone", (A,)), C)),
        ("a - b - c", Binary("-", Binary("-", A, B), C)),
        ("a - b * c", Binary("-", A, Binary("*", B, C))),
        ("a / b * c", Binary("*", Binary("/", A, B), C)),
        ("-a^2", Prefix("-", Binary("^", A, number(2)))),
        ("-a * b", Binary("*", Prefix("-", A), B)),
        ("a * -b", Binary("*", A, Prefix("-", B))),
        ("a + b < c", Binary("<", Binary("+", A, B), C)),
        ("F[0, 600 ms] a", Temporal("F", Bounds(number(0), number(600, "ms")), None, A)),
        ("G[1.5 s, inf] a", Temporal("G", Bounds(number("1.5", "s"), None), None, A)),
        ("a U[0, c] b", Temporal("U", Bounds(number(0), C), A, B)),
        ("2.5e1 km/h < 3 m/s", Binary("<", number(25, "km/h"), number(3, "m/s"))),
        ("0.1 = 1 # a comment", Binary("=", number("1/10"), number(1))),
        ("f() = f(a, true)", Binary("=", Call("f", ()), Call("f", (A, Literal_(True))))),
        ("scenario_4@ext(a)", Call("scenario_4@ext", (A,))),
        ("Fast(a)", Call("Fast", (A,))),
    ],
)
def test_trees(text: str, tree: Expression) -> None:
    assert parse_claim(text).body == tree


def test_given() -> None:
    claim = parse_claim("given A, B: vehicle; v: m/s; K: lane: f(A, B, K)")
    assert [(b.name, b.sort) for b in claim.given] == [
        ("A", "vehicle"),
        ("B", "vehicle"),
        ("v", "m/s"),
        ("K", "lane"),
    ]


def test_statements_of_a_library() -> None:
    text = """
      param tau = -1.5 m/s^2 where tau >= 0 "a doc"
      option way = left | right
      def p(a, b: vehicle, L: lane) "what it means" := true
      each i in 1..3, 7 { def q_{i}(a: vehicle) := q_{i-1}(a) }
      set mine extends base "a set" { def p(a, b: vehicle, L: lane) := false }
      when way = right { def p(a, b: vehicle, L: lane) := false }
    """
    parameter, option, definition, each, chosen, when = parse_library(text, "mine.spec")
    assert parameter == ParameterDeclaration("tau", Fraction(-3, 2), "m/s^2", ">=", "a doc")
    assert option == OptionDeclaration("way", ("left", "right"), "")
    assert isinstance(definition, Definition)
    assert definition.doc == "what it means"
    assert [(b.name, b.sort) for b in definition.parameters] == [
        ("a", "vehicle"),
        ("b", "vehicle"),
        ("L", "lane"),
    ]
    assert isinstance(each, EachBlock)
    assert each.indices == (1, 2, 3, 7)
    assert isinstance(chosen, SetBlock)
    assert (chosen.name, chosen.parent, chosen.doc) == ("mine", "base", "a set")
    assert isinstance(when, WhenBlock)
    assert (when.option, when.value) == ("way", "right")


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("a and", 1, 6, "the text ends too early"),
        ("a and\n  ) b", 2, 3, "')' cannot stand here"),
        ("a $ b", 1, 3, "the character '$' cannot stand here"),
        ("F[0 1] a", 1, 5, "cannot stand here"),
        ("a < b < c", 1, 7, "'<' cannot stand here"),
        ("a^b", 1, 3, "'b' cannot stand here"),
        ("a^2.5", 1, 3, "whole number from 0 to 8"),
        ("a^99", 1, 3, "whole number from 0 to 8"),
        ("1e99 < a", 1, 1, "out of range"),
        ("1e-31 < a", 1, 1, "out of range"),
        ("9" * 201 + " < a", 1, 1, "out of range"),
        ("", 1, 1, "the text ends too early"),
    ],
)
def test_mistakes_have_a_place(text: str, line: int, column: int, message: str) -> None:
    with pytest.raises(TextError) as raised:
        parse_claim(text)
    assert message in str(raised.value)
    assert raised.value.position is not None
    assert (raised.value.position.line, raised.value.position.column) == (line, column)
    assert raised.value.exit_code == 3


def test_an_excerpt_points_at_the_mistake() -> None:
    with pytest.raises(TextError) as raised:
        parse_claim("danger(SV, POV) and and true", "mine.claim")
    assert str(raised.value).splitlines()[:3] == [
        "mine.claim, line 1, column 21: 'and' cannot stand here",
        "  danger(SV, POV) and and true",
        " " * 22 + "^",
    ]


@pytest.mark.parametrize("word", ["and", "or", "not", "true", "false", "some", "every", "in", "F", "G", "U"])
def test_operators_are_no_names(word: str) -> None:
    with pytest.raises(TextError, match="cannot stand here"):
        parse_claim(f"given {word}: vehicle: true")
    assert parse_claim(f"{word}x").body == Name(f"{word}x")


@pytest.mark.parametrize(
    "text",
    [
        "(" * 10_000 + "true" + ")" * 10_000,
        "(" * 10_000,
        "not " * 10_000 + "true",
        "F " * 10_000 + "true",
        "true -> " * 10_000 + "true",
        "1" + "+1" * 10_000 + " > 0",
        "f(" * 101 + "true" + ")" * 101,
    ],
)
def test_what_is_nested_too_deep_is_refused(text: str) -> None:
    with pytest.raises(TextError, match=r"too deep|too early"):
        parse_claim(text)


def test_nesting_is_allowed_up_to_the_limit() -> None:
    deep = "(" * DEEPEST_NESTING + "a" + ")" * DEEPEST_NESTING
    assert parse_claim(deep).body == A
    assert parse_claim("not " * (DEEPEST_NESTING - 1) + "a")
    with pytest.raises(TextError, match="nested too deep"):
        parse_claim("not " * DEEPEST_NESTING + "a")
    beside = " and ".join(["(a)"] * 500)
    assert parse_claim(beside).body == Chain("and", (A,) * 500)


def test_parentheses_in_strings_and_comments_do_not_nest() -> None:
    text = f'# {"(" * 500}\ndef p(a: vehicle) "{"(" * 500}" := true'
    assert len(parse_library(text, "mine.spec")) == 1


@pytest.mark.parametrize("text", ["each i in 3..1 { }", "each i in 0..2000 { }", "each i in 1.5 { }"])
def test_ranges_that_make_no_sense(text: str) -> None:
    with pytest.raises(TextError):
        parse_library(text, "mine.spec")


def test_a_bound_of_another_parameter_is_refused() -> None:
    with pytest.raises(TextError, match="speaks of another parameter"):
        parse_library("param tau = 1 s where rho > 0", "mine.spec")


def test_nothing_is_evaluated() -> None:
    for text in ("__import__('os')", "a.b", "a[0]", "lambda: 0", "f'{a}'"):
        with pytest.raises(TextError):
            parse_claim(text)


# --- Signs and words of other languages are answered with what to write here ------------------------


@pytest.mark.parametrize(
    ("text", "line", "column", "sign", "instead"),
    read_table(__file__, "a_sign_of_another_language"),
)
def test_a_sign_of_another_language(text: str, line: int, column: int, sign: str, instead: str) -> None:
    with pytest.raises(TextError) as raised:
        parse_claim(text)
    error = raised.value
    assert error.position is not None
    assert (error.position.line, error.position.column) == (line, column)
    assert error.message == f"'{sign}' is not of this language"
    assert error.hint == instead
    shown = str(error).splitlines()
    assert shown[2].index("^") == 2 + column - 1


@pytest.mark.parametrize(
    ("text", "said"),
    read_table(__file__, "other_mistakes_are_told_as_they_are"),
)
def test_other_mistakes_are_told_as_they_are(text: str, said: str) -> None:
    with pytest.raises(TextError) as raised:
        parse_claim(text)
    assert raised.value.message == said


def test_so_in_files_and_where_a_word_is_read_as_a_name() -> None:
    with pytest.raises(TextError, match="'&&' is not of this language"):
        parse_library("def p(a: vehicle) :=\n  true && true\n", "x.spec")
    specification = bundled_library().select("base")
    for text, instead in (
        ("P(danger(SV, POV))", "Write O."),
        ("True", "Write true."),
        ("exists(SV)", "some x in D"),
    ):
        with pytest.raises(TextError, match="there is no") as raised:
            read_claim(specification, text)
        assert instead in raised.value.hint
