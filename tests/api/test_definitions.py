"""Definitions: sets, readings, values, files of one's own; and mistakes in them."""

import copy
import pickle
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp

SPEC = 'def fast(a: vehicle) "it is fast" := v_lon(a) > 30 m/s\n'


def test_what_is_loaded() -> None:
    home = rp.load()
    assert home.sets == ("base",)
    assert home.values == {}
    assert home.all_values()["minDanger"] == Fraction(3, 5)
    both = rp.load("ext", "base", options={"lateral_sign": "literal"})
    assert both.specification.set_name == "ext"
    assert both.specification.options["lateral_sign"] == "literal"
    assert repr(both) == "<definitions ext, base lateral_sign=literal>"
    assert repr(rp.load(params={"rho": 0.3})) == "<definitions base rho=3/10>"


@pytest.mark.parametrize("value", [0.3, "0.3", "3/10", "300 ms", "0.3 s", Fraction(3, 10)])
def test_values_are_exact(value: float | str | Fraction) -> None:
    assert rp.load(params={"rho": value}).all_values()["rho"] == Fraction(3, 10)


def test_specifications_as_path_and_as_text(tmp_path: Path) -> None:
    file = tmp_path / "mine.spec"
    file.write_text(SPEC)
    for spec in (file, str(file), SPEC, SPEC.strip()):
        home = rp.load(specs=[spec])
        assert home.read("fast(SV)").formula.name == "fast"
        assert str(home.fast(rp.SV)) == "fast(SV)"
        assert home.fast.__doc__ == "it is fast"
        assert "fast" in dir(home)
    two = rp.load(specs=[SPEC, "def faster(a: vehicle) := fast(a) and v_lon(a) > 40 m/s"])
    assert str(two.read(two.faster(rp.SV)).text) == "faster(SV)"


def test_scenarios_by_number() -> None:
    home = rp.load()
    assert home.among(None) is None
    assert home.among("1-3,8") == home.among((8, 1, 2, 3)) == (1, 2, 3, 8)
    assert home.among(4) == (4,)
    assert home.numbered(4) == home.numbered("4") == home.numbered("scenario_4")
    assert home.numbered(4)[0] == 4
    query = home.read("danger(SV,POV)")
    assert home.read(query) is query


def test_it_can_be_copied_and_sent() -> None:
    home = rp.load("ext", params={"rho": 0.3})
    for other in (copy.copy(home), copy.deepcopy(home), pickle.loads(pickle.dumps(home))):
        assert repr(other) == repr(home)
        assert str(other.danger(rp.SV, rp.POV)) == "danger(SV, POV)"


@pytest.mark.parametrize(
    ("given", "error", "told"),
    [
        ({"sets": ("bse",)}, rp.InputError, "there is no spec set 'bse'; did you mean 'base'?"),
        ({"sets": ("base", "base")}, rp.UsageError, "name different spec sets"),
        ({"options": {"speed": "x"}}, rp.InputError, "option speed=x: "),
        ({"options": {"x": "y"}}, rp.InputError, "there is no option 'x'; there are lateral_rss"),
        ({"params": {"foo": 1}}, rp.InputError, "foo=1: there is no parameter 'foo'"),
        ({"params": {"rho": "3 m"}}, rp.InputError, "rho=3 m: rho is in s, which m does not measure"),
        ({"params": {"rho": -1}}, rp.InputError, "the library demands rho >= 0"),
        ({"params": {"rho": float("nan")}}, rp.InputError, "rho=nan: the number must be finite"),
        ({"params": {"rho": True}}, rp.InputError, "rho=True: this is no number"),
        ({"specs": ["none.spec"]}, rp.InputError, "cannot read none.spec"),
        ({"specs": ["def x( := 3"]}, rp.TextError, "mine-1.spec, line 1, column 8: ':=' cannot stand here"),
    ],
)
def test_mistakes_are_told_by_name(given: dict[str, object], error: type[Exception], told: str) -> None:
    rest = dict(given)
    with pytest.raises(error) as raised:
        rp.load(*rest.pop("sets", ()), **rest)  # type: ignore[misc, arg-type]
    assert told in str(raised.value)


def test_names_that_are_not_there() -> None:
    with pytest.raises(AttributeError, match="there is no definition 'dangr'; did you mean 'danger'"):
        rp.load().dangr  # noqa: B018
    with pytest.raises(rp.InputError, match="there is no scenario '99'"):
        rp.load().among("99")
    for what in (True, None, 1.5, ["danger(SV,POV)"]):
        with pytest.raises(
            rp.UsageError, match="is not a formula: give a number, a text, or a formula built"
        ):
            rp.load().read(what)  # type: ignore[arg-type]


def test_one_set_where_one_is_asked_about() -> None:
    two = rp.load("base", "ext")
    for ask in (
        lambda: rp.prove("danger(SV,POV)", using=two),
        lambda: rp.prove("P4", using=two),
        lambda: rp.redundancy(4, two),
        lambda: rp.classify("1-8", two),
        lambda: rp.coverage(two),
    ):
        with pytest.raises(rp.UsageError, match="base, ext: this question takes one spec set; name one"):
            ask()


def test_values_that_would_be_passed_over_are_refused() -> None:
    mine = rp.load(params={"minDanger": 1})
    with pytest.raises(rp.UsageError, match="minDanger is given a value and varied: leave one out"):
        rp.explore(4, vary={"minDanger": (0, 3)}, using=mine)
    with pytest.raises(rp.UsageError, match="evaluate takes several values of it; use min_danger"):
        rp.evaluate("none", using=mine)
