"""Definitions while they are written: what a draft stands for, and everything that is wrong with it."""

import pytest

import roadproof as rp
from roadproof.errors import InputError, Position
from roadproof.frontends.api.drafting import Draft, Mistake, mistakes, place_in, sources_of
from roadproof.logic.formula import Application

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
    assert "this is a number" in told.message


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
