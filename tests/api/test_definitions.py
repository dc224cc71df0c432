"""Definitions: sets, readings, values, files of one's own; and mistakes in them."""

import copy
import pickle
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from api.both_interfaces import tell
from roadproof.errors import InputError, Position
from roadproof.extensions.pages.studio.drafting import Draft, Mistake, mistakes, place_in, sources_of
from roadproof.logic.formula import Application

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
    with pytest.raises(rp.InputError, match="there is no scenario 99"):
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


# --- Definitions while they are written: what a draft stands for, and everything that is wrong with it

LOOSE = """\
# what replaces, what is new, and what is no definition
def danger(a, b: vehicle) "loose" := G[0, minDanger] far(a, b)
param far_away = 30 m
def far(a, b: vehicle) := s(b) - s(a) <= far_away
"""


def test_a_draft_is_a_set_on_top_of_another_and_means_what_its_file_means() -> None:
    home = Draft("ext", LOOSE).definitions()
    assert home.specification.set_name == "edit"
    assert isinstance(home.read("danger(SV,POV)").formula, Application)
    assert "far_away" in home.library.parameters
    file = Draft("ext", LOOSE).file()
    again = rp.load("edit", specs=[file])
    for name in ("danger(SV,POV)", "scenario_1(SV,POV,L)", "scenario_8(SV,POV,L)"):
        assert again.read(name).formula == home.read(name).formula
    below = rp.load("ext", specs=[file]).read("danger(SV,POV)").formula
    assert below == rp.load("ext").read("danger(SV,POV)").formula


def test_an_empty_draft_is_the_set_below() -> None:
    home = Draft("extA", "  # nothing\n").definitions()
    assert home.read("4").formula == rp.load("extA").read("4").formula


def test_what_was_before_is_a_set_of_its_own() -> None:
    """What is new is told apart by set too."""
    before = "def far(a: vehicle) := s(a) > 1 m\ndef danger(a, b: vehicle) := far(a)\n"
    after = "def far(a: vehicle) := s(a) > 2 m\ndef danger(a, b: vehicle) := far(a)\n"
    home = Draft("base", after, before).definitions("before", "edit")
    was = home.read("danger(SV,POV)").formula
    now = Draft("base", after, before).definitions().read("danger(SV,POV)").formula
    alone = Draft("base", before).definitions().read("danger(SV,POV)").formula
    assert was == alone != now


def test_every_mistake_is_told_with_its_place() -> None:
    text = (
        "def danger(a, b: vehicle) := G[0, minDanger (far(a, b)\n"
        "def near(a, b: vehicle) := s(b) - q(a) <= 100 m\n"
        "def fine(a: vehicle) := true\n"
        "def sums(a: vehicle) := s(a) + v_lon(a) > 3 m\n"
    )
    found = mistakes(Draft("base", text), {"formula": "near(SV, POV) and (", "watch 1": "fine(SV, POV)"})
    places = [(x.where, x.position) for x in found]
    assert places == [
        ("definitions", Position(1, 55)),
        ("definitions", Position(2, 35)),
        ("definitions", Position(4, 25)),
        ("formula", Position(1, 20)),
        ("watch 1", Position(1, 1)),
    ]
    assert "'q'" in found[1].message
    assert "cannot be added" in found[2].message


@pytest.mark.parametrize(
    ("draft", "where", "words"),
    [
        (Draft("nothing"), "definitions", "there is no spec set 'nothing'"),
        (Draft("base", "def danger(a: vehicle) := true\n" * 2), "definitions", "given twice"),
        (Draft("base", "bla bla"), "definitions", "cannot stand here"),
        (Draft("base", options={"speed": "mad"}), "definitions", "speed=mad"),
        (Draft("base", params={"rho": "-1"}), "parameters", "rho"),
        (Draft("base", "def a(b: vehicle) := c(b)\ndef c(b: vehicle) := a(b)"), "definitions", "by itself"),
    ],
)
def test_mistakes_of_other_kinds(draft: Draft, where: str, words: str) -> None:
    found = mistakes(draft, {})
    assert found
    assert all(x.where == where for x in found)
    assert any(words in x.message for x in found)


def test_a_draft_without_mistakes_has_none() -> None:
    assert mistakes(Draft("base", LOOSE), {"formula": "scenario_1(SV,POV,L)", "watch 1": " 7 "}) == []
    [told] = mistakes(Draft("base"), {"formula": "77"})
    assert "there is no scenario 77" in told.message


def test_what_is_below_an_earlier_draft_is_not_what_is_below_a_later_one() -> None:
    """The proofreader keeps what definitions mean from one text to the next."""
    first, later = "def far(a: vehicle) := s(a) > 1 m\n", "def far(a, b: vehicle) := s(a) > s(b)\n"
    for text, formula, wrong in ((first, "far(SV)", 0), (later, "far(SV)", 1), (first, "far(SV)", 0)):
        for base in ("base", "ext"):
            assert len(mistakes(Draft(base, text), {"formula": formula})) == wrong


def test_a_mistake_in_a_draft_is_raised_where_it_is_asked() -> None:
    with pytest.raises(InputError, match="no spec set"):
        Draft("nothing").definitions()


def test_places_in_the_set_count_as_they_stand_in_the_draft() -> None:
    sources = {x.name: x.text for x in sources_of("base", LOOSE, None)}
    written = LOOSE.splitlines()
    for name, text in sources.items():
        for row, line in enumerate(text.splitlines(), 1):
            column = line.find("def ")
            place = place_in(name, (row, column + 1))
            if column >= 0 and place is not None:
                assert written[place[1][0] - 1][place[1][1] - 1 :].startswith("def ")
    assert place_in("iso34502.spec", (3, 1)) is None
    assert isinstance(mistakes(Draft("base", "def"), {})[0], Mistake)


EACH = "each i in 1..3 { def roadSector_{i}(SV: vehicle, POV: vehicles) := true }\n"


def test_an_each_block_is_of_the_edit_alone() -> None:
    """It replaces in ``edit``, and what is below stays what it is; one of before is of before."""
    home = Draft("ext", EACH).definitions()
    alone = Draft("ext", "def roadSector_2(SV: vehicle, POV: vehicles) := true\n").definitions()
    assert mistakes(Draft("ext", EACH), {"formula": "2"}) == []
    assert home.read("2").formula == alone.read("2").formula != rp.load("ext").read("2").formula
    file = Draft("ext", EACH).file()
    assert rp.load("ext", specs=[file]).read("2").formula == rp.load("ext").read("2").formula
    assert rp.load("edit", specs=[file]).read("2").formula == home.read("2").formula
    both = Draft("ext", "def laneKeep(a: vehicle, L: lane) := true\n", EACH)
    assert both.definitions("before").read("2").formula == home.read("2").formula
    assert both.definitions("edit").read("roadSector_2(SV,POV)") != both.definitions("before").read(
        "roadSector_2(SV,POV)"
    )
    new = "each k in 1..2 { def late_{k}(a: vehicle) := F[0, 1] v_lon(a) > 1 m/s }\n"
    assert Draft("base", new).definitions().read("late_2(SV)").vehicles == ("SV",)
    [told] = mistakes(Draft("base", EACH.replace("true", "fals(SV)")), {})
    assert told.where == "definitions"
    assert told.position == Position(1, 68)


@pytest.mark.parametrize(
    ("text", "words", "line"),
    [
        ("option lateral_sign = literal | rss\n", "option lateral_sign is the library's", 1),
        (
            "option my = a | b\n\nwhen my = b {\n  def danger(a, b: vehicle) := true\n}\n",
            "in all sets: danger",
            3,
        ),
        ("option my = a | b\nwhen my = b { " + EACH.strip() + " }\n", "in all sets: roadSector_1", 2),
        ("set base { def danger(a, b: vehicle) := true }\n", "there is a set base already", 1),
        (
            "# x\neach i in 24..25 { def roadSector_{i}(SV: vehicle, POV: vehicles) := true }",
            "Write two blocks",
            2,
        ),
    ],
)
def test_what_would_change_other_sets_is_refused_at_its_place(text: str, words: str, line: int) -> None:
    found = mistakes(Draft("base", text), {})
    assert any(words in f"{x.message} {x.hint}" and x.position and x.position.line == line for x in found)
    with pytest.raises(InputError, match="line"):
        Draft("base", text).definitions()


def test_options_signals_and_parameters_of_a_draft_and_of_the_one_before() -> None:
    text = (
        "signal jerk(a: vehicle): m/s^3 in [-10, 10]\n"
        "def laneKeep(a: vehicle, L: lane) := calm(a)\n"
        "option calmness = strict | lax\n"
        "def calm(a: vehicle) := jerk(a) < soft\n"
        "param soft = 2 m/s^3\n"
        "when calmness = lax { def calm(a: vehicle) := true }\n"
    )
    assert mistakes(Draft("base", text), {"formula": "laneKeep(SV,L)"}) == []
    lax = Draft("base", text, options={"calmness": "lax"}).definitions()
    assert lax.read("calm(SV)").formula != Draft("base", text).definitions().read("calm(SV)").formula
    later = Draft("base", "def laneKeep(a: vehicle, L: lane) := true\n", text)
    assert "soft" in later.definitions("before").library.parameters
    changed = Draft("base", text.replace("soft = 2", "soft = 3"), text)
    assert changed.definitions().read("calm(SV)")
    with pytest.raises(rp.RoadproofError, match="param soft: is declared for all sets, and not alike"):
        changed.definitions("before", "edit")


# --- Mistakes are told in Python as on the command line, by the same errors and exit codes ----------

BOTH: dict[str, tuple[Callable[[], object], list[str], type[rp.RoadproofError]]] = {
    "text": (lambda: rp.prove("danger(SV,POV"), ["prove", "danger(SV,POV"], rp.TextError),
    "name": (lambda: rp.witness("dangr(SV,POV)"), ["witness", "dangr(SV,POV)"], rp.TextError),
    "unit": (lambda: rp.compare("s(SV) > 3 s", "4"), ["compare", "s(SV) > 3 s", "4"], rp.TextError),
    "property": (lambda: rp.prove("P99"), ["prove", "P99"], rp.UsageError),
    "mixed": (lambda: rp.prove("P1", "danger(SV,POV)"), ["prove", "P1", "danger(SV,POV)"], rp.UsageError),
    "unstated": (
        lambda: rp.prove("P4", using=rp.load("complete")),
        ["prove", "P4", "--set", "complete"],
        rp.UsageError,
    ),
    "scenario": (lambda: rp.prove(99), ["prove", "99"], rp.InputError),
    "set": (lambda: rp.witness(4, using=rp.load("bse")), ["witness", "4", "--set", "bse"], rp.InputError),
    "road": (lambda: rp.witness(4, road="moon"), ["witness", "4", "--road", "moon"], rp.InputError),
    "vehicle": (lambda: rp.witness(4, vehicles="tram"), ["witness", "4", "--vehicle", "tram"], rp.InputError),
    "lane": (lambda: rp.witness(4, lanes={"L": "x"}), ["witness", "4", "--lane", "x"], rp.UsageError),
    "solver": (lambda: rp.witness(4, solver="x"), ["witness", "4", "--solver", "x"], rp.UsageError),
    "dt": (
        lambda: rp.witness(4, horizon=1, dt=1),
        ["witness", "4", "--horizon", "1", "--dt", "1"],
        rp.UsageError,
    ),
    "one scenario": (lambda: rp.overlap("4"), ["overlap", "--among", "4"], rp.UsageError),
    "no range": (lambda: rp.order("x"), ["order", "--among", "x"], rp.UsageError),
    "no scenario": (lambda: rp.redundancy("99"), ["redundancy", "--among", "99"], rp.InputError),
    "no class": (lambda: rp.classify("99"), ["classify", "--among", "99"], rp.InputError),
    "wider": (
        lambda: rp.coverage(rp.load("ext"), wider="base"),
        ["coverage", "--set", "ext", "--wider", "base"],
        rp.UsageError,
    ),
    "nothing to explore": (lambda: rp.explore(4), ["explore", "4"], rp.UsageError),
    "knob": (
        lambda: rp.explore(4, vary={"x": (0, 1)}),
        ["explore", "4", "--vary", "x=0:1"],
        rp.RoadproofError,
    ),
    "term": (lambda: rp.explore(4, least="v("), ["explore", "4", "--least", "v("], rp.TextError),
    "no trace": (lambda: rp.monitor(4, "x.txt"), ["monitor", "4", "x.txt"], rp.InputError),
    "no file": (lambda: rp.monitor(4, "x.csv"), ["monitor", "4", "x.csv"], rp.InputError),
    "no drive": (lambda: rp.monitor(4, "x.json"), ["monitor", "4", "x.json"], rp.InputError),
    "no recordings": (lambda: rp.evaluate("x"), ["evaluate", "x", "--out", "out"], rp.InputError),
    "no evidence": (lambda: rp.check("x"), ["check", "x"], rp.InputError),
}


@pytest.mark.parametrize("name", BOTH)
def test_the_same_words_through_both_doors(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ask, line, kind = BOTH[name]
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kind) as raised:
        ask()
    code, printed, complaints = tell(line)
    assert f"roadproof: {raised.value}\n" == complaints
    assert (code, printed) == (raised.value.exit_code, "")


@pytest.mark.parametrize(("claim", "sort"), [("SV", "vehicle"), ("F POV2", "vehicle"), ("L or true", "lane")])
def test_a_vehicle_or_lane_is_no_formula(claim: str, sort: str) -> None:
    with pytest.raises(rp.TextError, match=f"is a {sort}; a formula or number is expected here"):
        rp.prove(claim)


def test_numbers_of_numpy_are_those_of_python() -> None:
    """A float is the decimal that is printed, whatever bits it has."""
    for number in (np.float64(3.1), np.float32(3.1)):
        assert rp.load(params={"rho": number}).values["rho"] == Fraction(31, 10)
        assert str(rp.SV.v_lon < number) == str(rp.SV.v_lon < 3.1)
    assert rp.motion(np.int64(2**40), 2, 30).s * 2**30 == 2**70
    home = rp.load()
    assert home.among(np.int64(3)) == (3,)
    assert home.numbered(np.int64(4)) == home.numbered(4)
    with pytest.raises(rp.InputError, match="the number must be finite"):
        rp.load(params={"rho": np.float64("nan")})


def test_a_caret_shows_where() -> None:
    with pytest.raises(rp.TextError) as raised:
        rp.witness("F danger(SV, POV) and dangr(SV, POV)")
    assert str(raised.value).splitlines()[1:] == [
        "  F danger(SV, POV) and dangr(SV, POV)",
        "                        ^",
    ]
    assert "did you mean 'danger'" in str(raised.value)
    position = raised.value.position
    assert position is not None
    assert (position.line, position.column) == (1, 23)


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: rp.prove(4, engine="x"), "engine='x': write 'dense' or 'smt' or 'milp'"),
        (lambda: rp.prove(4, expect="x"), "expect='x': write 'PROVED' or 'REFUTED'"),
        (lambda: rp.prove("P4", engine="smt"), "engine='smt' requires claims of your own"),
        (lambda: rp.prove(4, effort=0), "effort=0: write a number greater than 0"),
        (lambda: rp.prove("P4", jobs=0), "jobs=0: write a whole number greater than 0"),
        (lambda: rp.witness(4, engine="x"), "engine='x': write 'milp' or 'smt'"),
        (lambda: rp.witness(4, objective="x"), "objective='x': write 'any' or 'smooth'"),
        (lambda: rp.witness(4, count=0), "count=0: write a whole number greater than 0"),
        (lambda: rp.witness(4, count="2"), "count='2': write a whole number greater than 0"),
        (lambda: rp.witness(4, count=1.5), "count=1.5: write a whole number greater than 0"),
        (lambda: rp.witness(4, jobs="2"), "jobs='2': write a whole number greater than 0"),
        (lambda: rp.witness(4, using="ext"), "using='ext': write what rp.load returns"),
        (lambda: rp.load(specs="driver"), "specs='driver': write a list, such as specs=['driver']"),
        (lambda: rp.F(rp.SV.v_lon > 3, within="3 s"), "within='3 s': write two bounds, such as (0, '4 s')"),
        (lambda: rp.F(rp.SV.v_lon > 3, within=(3,)), "within=(3,): write two bounds"),
        (lambda: rp.evaluate("x", classes="Car"), "classes='Car': write a list, such as classes=['Car']"),
        (lambda: rp.evaluate("x", min_danger=0.6), "min_danger=0.6: write a list, such as min_danger=[0.6]"),
        (lambda: rp.check("x", specs="mine.spec"), "specs='mine.spec': write a list"),
        (lambda: rp.drive(4, {"SV": 3, "POV": 4}), "vehicles['SV']=3: write what rp.motion returns"),
        (lambda: rp.check(), "check() needs at least one file or folder of evidence"),
        (lambda: rp.witness(4, horizon=-1), "horizon=-1: write a number greater than 0"),
        (lambda: rp.compare(3, 4, timeout=-1), "timeout=-1: write a number greater than 0"),
        (lambda: rp.compare(3, 4, rp.load("base", "extA", "ext")), "two formulas have at most two"),
        (lambda: rp.overlap("3,4", lanes="x"), "lanes='x': write 'same' or 'any'"),
        (
            lambda: rp.overlap("3,4", rp.load("base", "extA", "ext")),
            "name one spec set, or two different",
        ),
        (
            lambda: rp.explore(4, vary={"minDanger": (0, 1)}, steps=1),
            "--steps 1: write a number from 2 to 201",
        ),
        (lambda: rp.monitor(4, "x.csv", view="x"), "view='x': write 'dense' or 'recorded'"),
        (lambda: rp.monitor(4, "x.csv", view="dense"), "others have samples only"),
        (lambda: rp.monitor(4, "x.csv", end="x"), "end='x': write 'truncated' or 'clip'"),
        (lambda: rp.evaluate("x", end="x"), "end='x': write 'truncated' or 'clip'"),
        (lambda: rp.simulate("x", recordings=0), "recordings=0: write 1 to 999"),
        (lambda: rp.simulate("x", seed=-1), "seed=-1: a seed is 0 or more"),
        (lambda: rp.simulate("x", lanes=9), "simulate: lanes=9 must lie between 2 and 4"),
        (lambda: rp.check("x", solver="x"), "solver='x': write 'z3' or 'cvc5'"),
    ],
)
def test_choices_that_are_none(ask: Callable[[], object], told: str) -> None:
    with pytest.raises(rp.UsageError) as raised:
        ask()
    assert told in str(raised.value)
