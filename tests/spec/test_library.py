"""Files, sets, options and overrides."""

import re
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

from roadproof.errors import InputError, TextError
from roadproof.evidence.specifications import load_specs_beside
from roadproof.evidence.strict import Fields
from roadproof.frontends import cli
from roadproof.frontends.cli.main import main
from roadproof.library.diagnose import checked_library
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library, load_library
from roadproof.library.specification import (
    Library,
    Source,
    Specification,
    read_specification,
    satisfies_bound,
    unknown_name,
)
from roadproof.library.words import Words, legend, spans, words_by_number, words_in_sets, words_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from tables import read_table

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


def test_a_file_is_read_once_until_it_changes(tmp_path: Path) -> None:
    file = tmp_path / "my.spec"
    file.write_text("def mine(a: vehicle) := v_lon(a) > 1 m/s\n", "utf-8")
    first = load_library([file])
    assert load_library([file]) is checked_library([file]) is first
    file.write_text(file.read_text("utf-8").replace("1 m", "2 m"), "utf-8")
    assert load_library([file]).definitions["mine"] != first.definitions["mine"]
    file.write_text("def mine(a: vehicle) := other(a)\n", "utf-8")
    for _ in range(2):
        with pytest.raises(TextError, match="other"):
            checked_library([file])


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
    read_table(__file__, "mistakes_in_files"),
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
    assert unknown_name("set", "bas", ["base", "ext"]) == "there is no set 'bas'; did you mean 'base'?"
    assert unknown_name("set", "x", ["base", "ext"]) == "there is no set 'x'; there are base, ext"
    assert unknown_name("set", "x", []) == "there is no set 'x'"


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
    assert satisfies_bound(bound, Fraction(value)) is kept
    text = f'# mine\nparam rho = {value} s{f" where rho {bound} 0" if bound else ""} "mine"'
    if kept:
        assert library(text).parameters["rho"].value == Fraction(value)
        return
    with pytest.raises(TextError) as caught:
        library(text)
    assert f"mine.spec, line 2, column 1: rho={value} s: it is declared with rho {bound} 0" in str(
        caught.value
    )


# --- What scenarios are called: the library's titles, users' own words, and what is said without any

BASE = bundled_library().select("base")
OWN = """
def roadSector_30(SV: vehicle, POV: vehicles) "bus lane" := mainRoad(SV, POV)
def scenario_30(SV, POV: vehicle, L: lane) "a bus cuts in" := cutIn(POV, SV, L)
def scenario_31(SV, POV: vehicle, L: lane) := cutIn(POV, SV, L)
def scenario_32(SV, POV: vehicle, L: lane) "[behaviourSV_4], [cutIn]" := cutIn(POV, SV, L)
def behaviourSV_32(SV, POV: vehicle, L: lane) "SV stops" := laneKeep(SV, L)
"""


def own(text: str, set_name: str = "base") -> Specification:
    return load_library([Source("mine.spec", text)]).select(set_name)


def test_the_24_are_called_by_behaviour_of_pov_and_sv_and_by_sector() -> None:
    words = words_by_number(BASE)
    assert list(words) == list(range(1, 25))
    kinds = ("cut-in", "cut-out", "acceleration behind", "deceleration ahead")
    rows = [(pov, "lane keep") for pov in kinds]
    leaves, enters = "lane change (SV leaves its lane)", "lane change (SV enters that of POV)"
    rows += [(pov, enters if pov == "acceleration behind" else leaves) for pov in kinds]
    sectors = ("main road", "merge zone", "departure zone")
    expected = [f"{pov}, {sv}, {sector}" for sector in sectors for pov, sv in rows]
    assert [x.name for x in words.values()] == expected
    assert len({x.sentence for x in words.values()}) == 24


def test_words_of_one() -> None:
    assert words_of(BASE, 12) == Words(
        12,
        "deceleration ahead, lane keep",
        "merge zone",
        "SV keeps its lane",
        "POV ahead is slower",
        "Merge zone: you (SV) keep your lane, and a vehicle ahead of you in it (POV) is dangerously slow.",
    )


@pytest.mark.parametrize("number", range(1, 25))
def test_titles_agree_with_what_the_behaviours_say(number: int) -> None:
    """A title is written beside the formulas: that SV keeps or changes lanes must be the same in both."""
    words = words_of(BASE, number)
    assert (
        ("lane keep" in words.title) == ("keeps its lane" in words.sv) == ("keep your lane" in words.sentence)
    )
    pov = {"cut-in": "cuts in", "cut-out": "cuts out", "acceleration": "faster", "deceleration": "slower"}
    kind = re.split("[ ,]", words.title)[0]
    assert pov[kind] in words.pov
    assert ("behind" in words.title) == ("behind" in words.pov)


@pytest.mark.parametrize("set_name", ["extA", "ext", "complete"])
def test_wider_sets_have_the_same_names(set_name: str) -> None:
    assert words_by_number(bundled_library().select(set_name)) == words_by_number(BASE)


def test_a_scenario_without_a_title_is_called_by_its_description() -> None:
    words = words_by_number(own(OWN), (30, 31, 32, 33))
    assert words[30] == Words(30, "a bus cuts in", "bus lane", "", "", "Bus lane: a bus cuts in.")
    assert words[31] == Words(31)
    assert str(words[31]) == "scenario 31"
    assert words[32].title == "SV stops"
    assert words[33] == Words(33)
    assert list(legend(words)) == ["30: a bus cuts in", "32: SV stops", "30: bus lane"]


def test_own_titles_and_several_numbers() -> None:
    titled = 'title of 30, 31..32 "bus" "a bus"\ntitle of 4 "mine"'
    specification = own(OWN + titled)
    assert [words_of(specification, n).title for n in (30, 31, 32)] == ["bus"] * 3
    assert words_of(specification, 31).sentence == "A bus."
    # what scenario 4 does is still said in the library's file
    assert words_of(specification, 4).title == "SV keeps its lane, POV ahead is slower"


STOPS = 'def behaviourPOV_4(POV, SV: vehicle, L: lane) "POV stops" := decel(POV, SV, L)'


@pytest.mark.parametrize(
    "text",
    [
        f"set mine extends base {{ {STOPS} }}",
        f"{STOPS}\nset mine extends base {{}}",
        f"option o = a | b\nwhen o = a {{ {STOPS} }}\nset mine extends base {{}}",
    ],
)
def test_another_behaviour_loses_the_title(text: str) -> None:
    """Old words on a new scenario would say what is not so."""
    words = words_by_number(own(text, "mine"))
    assert words[4].title == "SV keeps its lane, POV stops"
    assert words[4].sentence == "Main road: SV keeps its lane, POV stops."
    assert words[12].title == words[20].title == words[4].title  # which take it over
    assert words[3].title == "acceleration behind, lane keep"


def test_sets_that_do_not_call_it_alike_leave_it_without_words() -> None:
    specification = own(f"set mine extends base {{ {STOPS} }}")
    assert words_in_sets(specification, ("base", "ext"), (4, 3)) == words_by_number(specification, (3, 4))
    words = words_in_sets(specification, ("base", "mine"), (4, 3))
    assert (words[3].title, words[4]) == ("acceleration behind, lane keep", Words(4))


def test_titles_change_no_reading() -> None:
    named = load_library([Source("mine.spec", 'title of 4 "mine"')])
    assert named.fingerprint == bundled_library().fingerprint


def test_a_title_is_given_once() -> None:
    with pytest.raises(TextError, match="title of scenario '5' is given twice"):
        own('title of 4..5 "one"\ntitle of 5 "two"')


def test_files_beside_evidence_rename_nothing(tmp_path: Path) -> None:
    def beside(text: str) -> Library:
        (tmp_path / "mine.spec").write_text(text)
        return load_specs_beside(Fields({"specs": ["mine.spec"]}, "index"), tmp_path, ())[0]

    assert 30 in beside(OWN + 'title of 30 "bus"').titles
    with pytest.raises(Exception, match="changes '4' of the library"):
        beside('title of 4 "harmless"')


@pytest.mark.parametrize("number", range(1, 25))
def test_titles_say_which_lane_change_the_formula_asks_for(number: int) -> None:
    """SV leaves L in 5, 6 and 8, and enters L in 7; the titles of their like say the same."""
    words = words_of(BASE, number)
    body = str(BASE.definitions[f"behaviourSV_{(number - 1) % 8 + 1}"].body)
    assert ("SV leaves its lane" in words.title) == ("leavingLane" in body)
    assert ("SV enters that of POV" in words.title) == ("enteringLane" in body)


def test_legends_are_in_order() -> None:
    told = [*legend(words_by_number(BASE, {12, 8, 1, 4}))]
    assert told == [
        "1:     cut-in, lane keep",
        "4, 12: deceleration ahead, lane keep",
        "8:     deceleration ahead, lane change (SV leaves its lane)",
        "1, 4, 8: main road; 12: merge zone",
    ]


def test_numbers_in_spans() -> None:
    assert spans([]) == ""
    assert spans([1, 2, 3, 5, 6, 9]) == "1-3, 5, 6, 9"


def test_show_begins_with_the_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "4"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f"# {words_of(BASE, 4).sentence}"
    assert lines[1] == "# scenario 4: deceleration ahead, lane keep, main road"
    assert main(["show", "cutIn"]) == 0
    assert capsys.readouterr().out.startswith("def cutIn")


def test_what_is_shown_can_be_read_back(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "4", "--set", "ext"]) == 0
    shown = capsys.readouterr().out
    assert "# set ext: ISO34502-STL-ext" in shown
    assert load_library([Source("again.spec", shown)]).definitions["scenario_4"]


COMMANDS = [
    x.name for x in iter_modules(cli.__path__) if hasattr(import_module(f"{cli.__name__}.{x.name}"), "run")
]


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_scenarios_in_help_texts_are_called_what_they_are(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main([*filter(None, [command]), "--help"])
    told = " ".join(capsys.readouterr().out.split())
    for number, after in re.findall(r"scenario (\d+)\b(.{0,40})", told):
        pov = words_of(BASE, int(number)).title.partition(",")[0]
        assert pov in after, f"scenario {number}{after}"
