"""Signs and words of other languages are answered with what to write here."""

import pytest

from roadproof.errors import TextError
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.parse import parse_claim, parse_library

PAST = "Formulas speak of now and later: say what holds first, and what follows with F, G or U."


@pytest.mark.parametrize(
    ("text", "line", "column", "sign", "instead"),
    [
        ("p(SV) && q(SV)", 1, 7, "&&", "Write and."),
        ("p(SV) & q(SV)", 1, 7, "&", "Write and."),
        ("p(SV) || q(SV)", 1, 7, "||", "Write or."),
        ("p(SV) | q(SV)", 1, 7, "|", "Write or."),
        ("!p(SV)", 1, 1, "!", "Write not."),
        ("true and\n ~p(SV)", 2, 2, "~", "Write not."),
        ("p(SV) => q(SV)", 1, 7, "=>", "Write -> for what follows, >= for at least."),
        ("p(SV) <=> q(SV)", 1, 7, "<=>", "Write <->."),
        ("s(SV) == 3 m", 1, 7, "==", "Write =."),
        ("[] p(SV)", 1, 1, "[]", "Write G."),
        ("<> p(SV)", 1, 1, "<>", "Write F for at some time, != for not equal."),
        ("s(SV) <> 3 m", 1, 7, "<>", "Write F for at some time, != for not equal."),
        ("□ p(SV)", 1, 1, "□", "Write G."),
        ("v_lon(SV) ≤ 3 m/s", 1, 11, "≤", "Write <=."),
        ("∀ x in lanes: p(x)", 1, 1, "∀", "Write every x in D: p."),
        ("P p(SV)", 1, 1, "P", PAST),
        ("p(SV) S q(SV)", 1, 7, "S", PAST),
        ("once p(SV)", 1, 1, "once", PAST),
        ("p(SV) AND q(SV)", 1, 7, "AND", "Write and."),
        ("p(SV) implies q(SV)", 1, 7, "implies", "Write ->."),
        ("forall x in lanes: p(x)", 1, 1, "forall", "Write every x in D: p."),
        ("always p(SV)", 1, 1, "always", "Write G."),
        ("p(SV) W q(SV)", 1, 7, "W", "Write (p U q) or G p."),
    ],
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
    [
        ("F[] p(SV)", "']' cannot stand here"),
        ("p(SV) and and q(SV)", "'and' cannot stand here"),
        ("given S: lane: occ(SV, S) occ(SV, S)", "'occ' cannot stand here"),
        ("given S: lane: occ(SV S)", "'S' cannot stand here"),
        ("p(SV) and", "the text ends too early"),
        ("s(SV) = ", "the text ends too early"),
        ("s(SV) != = 3", "'=' cannot stand here"),
    ],
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
        ("P(danger(SV, POV))", PAST),
        ("True", "Write true."),
        ("exists(SV)", "some x in D"),
    ):
        with pytest.raises(TextError, match="there is no") as raised:
            read_claim(specification, text)
        assert instead in raised.value.hint
