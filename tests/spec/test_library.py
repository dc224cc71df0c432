"""Files, sets, options and overrides."""

from fractions import Fraction
from pathlib import Path

import pytest

from roadproof.errors import InputError, TextError
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library, load_library
from roadproof.library.specification import Library, Source, is_within, read_specification, unknown
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula

PLAIN = """
param limit = 130 km/h where limit > 0 "as signs say"
option mood = calm | hasty "how the driver feels"
def fast(a: vehicle) := v_lon(a) > limit
def still(a: vehicle) := v_lon(a) = 0
when mood = hasty { def fast(a: vehicle) := v_lon(a) > 2*limit }
set one "a set" {}
set two extends one { def fast(a: vehicle) := v_lon(a) >= limit }
set three extends two { def still(a: vehicle) := v_lon(a) <= 1 m/s }
"""


def library(text: str, below: Library | None = None) -> Library:
    return build_library([Source("mine.spec", text)], below)


def body(of: Library, text: str, set_name: str = "one", **options: str) -> Formula:
    formula = read_claim(of.select(set_name, options), text).formula
    assert isinstance(formula, f.Application)
    return formula.body


def comparison(of: Library, set_name: str, **options: str) -> str:
    made = body(of, "fast(SV)", set_name, **options)
    assert isinstance(made, f.Compare)
    return made.op


def test_sets_override_their_parents() -> None:
    made = library(PLAIN)
    assert [comparison(made, name) for name in ("one", "two", "three")] == [">", ">=", ">="]
    assert isinstance(body(made, "still(SV)", "two"), f.And)
    assert isinstance(body(made, "still(SV)", "three"), f.Compare)


def test_options_override_sets_and_default_to_their_first_value() -> None:
    made = library(PLAIN)
    assert body(made, "fast(SV)") == body(made, "fast(SV)", mood="calm")
    assert body(made, "fast(SV)", mood="hasty") != body(made, "fast(SV)")
    assert comparison(made, "two", mood="hasty") == ">"
    assert made.select("two", {"mood": "hasty"}).in_set("one").options == {"mood": "hasty"}


def test_users_files_go_on_top() -> None:
    base = bundled_library()
    mine = library("set mine extends ext { def aheadOf(a, b: vehicle) := rear(a) < rear(b) }", base)
    ours, theirs = mine.select("mine").definitions, base.select("ext").definitions
    assert {name for name in ours if ours[name] is not theirs[name]} == {"aheadOf"}
    again = library("def danger(a, b: vehicle) := rssViolation(a, b)", base)
    assert again.select().definitions["danger"].body != base.select().definitions["danger"].body
    assert base.select().definitions["danger"].doc == "durable danger"


def test_each_makes_one_definition_an_index() -> None:
    made = library(
        'def p_0(a: vehicle) := true each i in 1..2, 5 { def p_{i}(a: vehicle) "no {i}" := p_{i-1}(a) }'
    )
    assert list(made.definitions) == ["p_0", "p_1", "p_2", "p_5"]
    assert made.definitions["p_5"].doc == "no 5"
    with pytest.raises(TextError, match="there is no definition 'p_4'"):
        read_claim(library("set s {}", made).select("s"), "p_5(SV)")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("def p(a: vehicle) := true def p(a: vehicle) := false", "definition 'p' is given twice"),
        ("param a = 1 s param a = 2 s", "parameter 'a' is given twice"),
        ("option a = x | y option a = x | z", "option 'a' is given twice"),
        ("set a {} set a {}", "set 'a' is given twice"),
        ("def occ(a: vehicle) := true", "'occ' is built in"),
        ("set a extends b {}", "there is no spec set 'b'"),
        ("set a { def p(a: vehicle) := true }", "an override needs something to replace"),
        ("def pale(a: vehicle) := true set a { def pal(a: vehicle) := true }", "did you mean 'pale'"),
        ("when a = b { }", "there is no option 'a'"),
        ("option a = x | y when a = z { }", "there is no value of option a 'z'"),
        ("each i in 1..2 { def p_{j}(a: vehicle) := true }", "'{j}' is no index"),
        ("each i in 1..2 { def p_{i*2}(a: vehicle) := true }", "'{i\\*2}' is no index"),
        ("set a { def p(a: vehicle) := true def p(a: vehicle) := true }", "given twice|needs something"),
    ],
)
def test_mistakes_in_files(text: str, message: str) -> None:
    with pytest.raises(TextError, match=message) as raised:
        library(text)
    assert str(raised.value).startswith("mine.spec, line 1")


@pytest.mark.parametrize(
    ("set_name", "options", "message"),
    [
        ("bse", {}, "there is no spec set 'bse'; did you mean 'base'"),
        ("base", {"lateral": "rss"}, "there is no option 'lateral'"),
        ("base", {"lateral_sign": "left"}, "the value must be rss or literal"),
    ],
)
def test_choices_that_do_not_exist(set_name: str, options: dict[str, str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        bundled_library().select(set_name, options)


def test_mistakes_in_definitions_are_located_in_their_own_file() -> None:
    made = library("set s {}\ndef p(a: vehicle) := v_lon(a) > 3")
    with pytest.raises(TextError) as raised:
        read_claim(made.select("s"), "p(SV)")
    assert str(raised.value).startswith("mine.spec, line 2, column 22: m/s and no unit cannot be compared")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    latin, large, good = tmp_path / "latin.spec", tmp_path / "large.spec", tmp_path / "good.spec"
    latin.write_bytes('def p(a: vehicle) "größer" := true'.encode("latin-1"))
    large.write_bytes(b"#" * 2_000_000)
    good.write_text("def mine(a: vehicle) := true", "utf-8")
    for path, message in [
        (latin, "is not UTF-8 text: byte 21 is 0xf6"),
        (large, "is larger than"),
        (tmp_path / "missing.spec", "cannot read .*missing.spec"),
        (tmp_path, "cannot read"),
    ]:
        with pytest.raises(InputError, match=message):
            read_specification(path)
    assert "mine" in load_library([good]).definitions
    assert load_library() is bundled_library()


def test_unknown_names_the_nearest() -> None:
    assert unknown("set", "bas", ["base", "ext"]) == "there is no set 'bas'; did you mean 'base'?"
    assert unknown("set", "x", ["base", "ext"]) == "there is no set 'x'; there are base, ext"
    assert unknown("set", "x", []) == "there is no set 'x'"


@pytest.mark.parametrize(
    ("bound", "value", "kept"),
    [
        (">", "1", True),
        (">", "0", False),
        (">", "-1", False),
        (">=", "0", True),
        (">=", "-1", False),
        ("", "-1", True),
    ],
)
def test_a_declared_value_is_within_its_bound(bound: str, value: str, kept: bool) -> None:
    assert is_within(bound, Fraction(value)) is kept
    text = f'# mine\nparam rho = {value} s{f" where rho {bound} 0" if bound else ""} "mine"'
    if kept:
        assert library(text).parameters["rho"].value == Fraction(value)
        return
    with pytest.raises(TextError) as caught:
        library(text)
    assert f"mine.spec, line 2, column 1: rho={value} s: it is declared with rho {bound} 0" in str(
        caught.value
    )
