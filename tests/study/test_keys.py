"""No answer is taken from a store where one thing of its question is another.

Each question is asked, one thing is changed, and it is asked again with and without what is known: the two
answers are equal. Then it is asked as at first, and is known. Shipped and kept answers count here.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import pytest

import roadproof as rp
from api.doors import without_seconds
from roadproof.analysis.study import known
from roadproof.analysis.study.known import SWITCH
from roadproof.frontends.api.studied import StudyAnswers
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library
from roadproof.logic.rewrite import parameters_of
from roadproof.questions.settle import look_up

# `both` meets `bar` under two spec sets; `near` has a quantified variable that is called as a parameter is.
SPEC = """
param gap = 2 s where gap > 0 "a gap"
param low = 20 m/s where low > 0 "a speed"
param spare = 1 s "no definition uses it"
option pace = slow | quick "how fast"
option idle = no | yes "no definition depends on it"
def leaf(a: vehicle) "a leaf" := v_lon(a) > 8 m/s
def bar(a: vehicle) "a bar" := leaf(a)
def foo(a: vehicle) "a foo" := bar(a)
def both(a: vehicle) "two readings" := foo@mine(a) and foo(a)
def near(a: vehicle) "near" := (some gap in lanes: atLane(a, gap)) and v_lon(a) > gap*5 m/s^2
def paced(a: vehicle) "paced" := v_lon(a) > 25 m/s
when pace = quick { def paced(a: vehicle) "quick" := v_lon(a) > 29 m/s }
def apart(a: vehicle) "no definition uses it" := v_lon(a) > 1 m/s
set mine extends base "of my own" {
  def bar(a: vehicle) "a bar" := v_lon(a) > 5 m/s
}
def roadSector_90(SV, POV: vehicle) := true
def disturb_90(SV, POV: vehicle, L: lane) := v_lon(SV) > low and foo(SV)
def scenario_90(SV, POV: vehicle, L: lane) "fast"
  := initSafe(SV, POV) and roadSector_90(SV, POV) and disturb_90(SV, POV, L)
def roadSector_91(SV, POV: vehicle) := true
def disturb_91(SV, POV: vehicle, L: lane) := v_lon(SV) < 40 m/s and paced(POV) and near(SV)
def scenario_91(SV, POV: vehicle, L: lane) "slow"
  := initSafe(SV, POV) and roadSector_91(SV, POV) and disturb_91(SV, POV, L)
"""
Answers = StudyAnswers[Any, Any, Any]


@dataclass(frozen=True)
class Asking:
    """How a question is asked: a specification text, choices, and options of the command."""

    text: str = SPEC
    specs: tuple[str, ...] = ()
    sets: tuple[str, ...] = ("base",)
    params: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, str] = field(default_factory=dict)
    more: Mapping[str, Any] = field(default_factory=dict)

    @property
    def using(self) -> rp.Definitions:
        texts = [*self.specs, self.text]
        return rp.load(*self.sets, specs=texts, params=self.params, options=self.options)

    def edited(self, before: str, after: str) -> "Asking":
        assert self.text.count(before) == 1, before
        return replace(self, text=self.text.replace(before, after))

    def with_more(self, **more: Any) -> "Asking":
        return replace(self, more={**self.more, **more})


Ask = Callable[[Asking, bool], Answers]
Change = Callable[[Asking], Asking]

CLAIMS = (
    "both(SV) -> v_lon(SV) > 7 m/s",
    "near(SV) -> v_lon(SV) > 9 m/s",
    "paced(SV) -> v_lon(SV) > 27 m/s",
    "v_lon(SV) > low -> v_lon(SV) > 19 m/s",
)


def prove(asking: Asking, fresh: bool) -> Answers:
    return rp.prove(*CLAIMS, using=asking.using, jobs=1, fresh=fresh, **asking.more)


def witness(asking: Asking, fresh: bool) -> Answers:
    what = "both(SV) and near(SV) and paced(SV) and v_lon(SV) > low"
    return rp.witness(what, using=asking.using, jobs=1, fresh=fresh, **asking.more)


def witness_scenarios(asking: Asking, fresh: bool) -> Answers:
    return rp.witness(90, 91, using=asking.using, jobs=1, fresh=fresh, **asking.more)


def overlap(asking: Asking, fresh: bool) -> Answers:
    return rp.overlap("90,91", asking.using, jobs=1, fresh=fresh, **asking.more)


def order(asking: Asking, fresh: bool) -> Answers:
    return rp.order("90,91", asking.using, jobs=1, fresh=fresh, **asking.more)


def redundancy(asking: Asking, fresh: bool) -> Answers:
    more = {"effort": 1, **asking.more}
    return rp.redundancy("90,91", asking.using, jobs=1, fresh=fresh, **more)


def classify(asking: Asking, fresh: bool) -> Answers:
    return rp.classify("90,91", asking.using, shares=False, jobs=1, fresh=fresh, **asking.more)


def coverage(asking: Asking, fresh: bool) -> Answers:
    return rp.coverage(asking.using, jobs=1, fresh=fresh, **asking.more)


def explore(asking: Asking, fresh: bool) -> Answers:
    more = {
        "vary": {"low": (15, 25)},
        "steps": 2,
        "precision": 5,
        "greatest": "v_lon(SV) - low",
        **asking.more,
    }
    return rp.explore("near(SV) and v_lon(SV) < low", using=asking.using, jobs=1, fresh=fresh, **more)


def preventable(asking: Asking, fresh: bool) -> Answers:
    given = replace(asking, specs=("driver",))
    more = {"at": {"Vy": "1 m/s", "Ve0": "100 km/h"}, "lines": 2, "lemmas": False, **asking.more}
    return rp.preventable("cut-in", ["careful"], given.using, jobs=1, fresh=fresh, **more)


EVERY: Mapping[str, Ask] = {
    x.__name__: x
    for x in (
        *(prove, witness, witness_scenarios, overlap, explore, preventable),
        *(order, redundancy, classify, coverage),
    )
}

TEXTS: Mapping[str, tuple[str, str]] = {
    "leaf, which two sets share": ("v_lon(a) > 8 m/s", "v_lon(a) > 0 m/s"),
    "bar of a set": ("v_lon(a) > 5 m/s", "v_lon(a) > 6 m/s"),
    "the parent of a set": ("extends base", "extends ext"),
    "near, whose variable is called as a parameter": ("gap*5 m/s^2", "gap*6 m/s^2"),
    "paced, which an option replaces": ("v_lon(a) > 25 m/s", "v_lon(a) > 28 m/s"),
    "quick, which is not chosen": ("v_lon(a) > 29 m/s", "v_lon(a) > 20 m/s"),
    "apart, which nothing uses": ("v_lon(a) > 1 m/s", "v_lon(a) > 2 m/s"),
    "a value that is declared": ("gap = 2 s", "gap = 1 s"),
    "another value that is declared": ("low = 20 m/s", "low = 18 m/s"),
    "a bound": ("where low > 0", "where low >= 0"),
    "a spare value": ("spare = 1 s", "spare = 2 s"),
    "a disturbance": ("v_lon(SV) < 40 m/s", "v_lon(SV) < 21 m/s"),
    "a description": ('"fast"', '"very fast"'),
    "a definition of the library": (
        "param gap",
        "def fasterThan(a, b: vehicle) := v_lon(a) >= v_lon(b)\nparam gap",
    ),
    "danger": ("param gap", "def danger(a, b: vehicle) := s(a) < s(b)\nparam gap"),
}
PARAMS = {"gap": 1, "low": 18, "spare": 3, "minSafe": 1, "minDanger": 1, "rho": "0.4 s"}
OPTIONS = {"pace": "quick", "idle": "yes", "speed": "total", "rss_form": "robust"}
CHOICES: Mapping[str, Change] = {
    **{f"text: {name}": lambda x, e=edit: x.edited(*e) for name, edit in TEXTS.items()},
    **{
        f"param {name}": lambda x, n=name, v=value: replace(x, params={n: v})
        for name, value in {
            "gap": 1,
            "low": 18,
            "spare": 3,
            "minSafe": 1,
            "minDanger": 1,
            "rho": "0.4 s",
        }.items()
    },
    **{
        f"option {name}": lambda x, n=name, v=value: replace(x, options={n: v})
        for name, value in OPTIONS.items()
    },
    "set mine": lambda x: replace(x, sets=("mine",)),
}
_SEARCH = {"horizon": 5, "effort": 50, "objective": "mild", "vehicles": {"": "truck"}}
MORE: Mapping[str, Mapping[str, Any]] = {
    "prove": {"effort": 50, "drive": False},
    "witness": {**_SEARCH, "road": "main-3", "reach": 60, "dt": "3/10", "collisions": True, "count": 2},
    "witness_scenarios": {"horizon": 5, "objective": "any"},
    "overlap": {"horizon": 5, "effort": 50, "lanes": "any", "roles": "any", "start": "any"},
    "explore": {"horizon": 5, "effort": 50, "steps": 3, "precision": 4, "when": "v_lon(SV) < 18 m/s"},
    "preventable": {"lines": 3, "at": {"Vy": "1 m/s", "Ve0": "90 km/h"}, "along": (0, 60), "lemmas": True},
    "order": {"effort": 50},
    "redundancy": {"effort": 2, "whole": True},
    "classify": {"effort": 50},
    "coverage": {"effort": 50, "needed": True},
}
DRIVER = {
    "cc_braking": 4,
    "cc_delay": "0.5 s",
    "cc_wander": "0.3 m",
    "cc_evaluation": "0.5 s",
    "cc_ramp": "0.5 s",
    "cc_drift": "0.3 m",
    "r157_delay": "0.5 s",
    "a_max": 3,
}


def changes_of(name: str) -> dict[str, Change]:
    found = dict(CHOICES)
    found |= {f"--{x}": lambda y, x=x, v=v: y.with_more(**{x: v}) for x, v in MORE[name].items()}
    if name == "preventable":
        found |= {f"driver {x}": lambda y, x=x, v=v: replace(y, params={x: v}) for x, v in DRIVER.items()}
    if name == "explore":
        del found["param low"]  # it is varied, and a value for it is refused
    return found


PAIRS = [(name, change) for name in EVERY for change in changes_of(name)]
LEAF, NEAR = "text: leaf, which two sets share", "text: near, whose variable is called as a parameter"
SHORT: Mapping[str, tuple[str, ...]] = {
    "prove": tuple(x for x in changes_of("prove") if not x.startswith("text: danger")),
    "witness": (
        "text: leaf, which two sets share",
        "param low",
        "option pace",
        "--horizon",
        "--road",
        "--count",
    ),
    "witness_scenarios": ("text: a disturbance", "param minDanger"),
    "overlap": (LEAF, "param gap", "option pace", "--lanes"),
    "explore": (NEAR, "param gap", "--when"),
    "preventable": (
        "text: a disturbance",
        *(x for x in changes_of("preventable") if x.startswith("driver ")),
    ),
}
"""The changes that are made in each run, by question; all others are made in long ones."""


@pytest.fixture(scope="module", autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A cache of our own, and all that is shipped."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(SWITCH, "on")
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield
    known._read.cache_clear()


def told(answers: Answers) -> Any:
    """An answer as data; of drives only the parameters that their formula mentions, and no traces.

    A computed drive also lists what the user has changed and no formula mentions. Of the traces that refute
    a claim for all values, a solver that has answered other questions before may find another one.
    """
    home = answers.study.question.library if hasattr(answers, "study") else answers.library
    return without_seconds(with_mentioned(answers.as_data(), home))


def with_mentioned(data: Any, library: Library) -> Any:
    match data:
        case {"schema": str(schema), "formula": str(formula), "parameters": dict(said)} if (
            "/drive/" in schema
        ):
            options = {name: said[name] for name in library.options if name in said}
            read = read_claim(library.select(data["set"], options), formula).formula
            wanted = {*parameters_of(read), *options}
            return {**data, "parameters": {name: x for name, x in said.items() if name in wanted}}
        case {"kind": "trace"}:
            return {"kind": "trace"}
        case dict():
            return {name: with_mentioned(x, library) for name, x in data.items()}
        case list():
            return [with_mentioned(x, library) for x in data]
        case _:
            return data


@pytest.fixture(scope="module")
def first() -> dict[str, Any]:
    """The answers to questions as they are asked at first, by name."""
    return {}


def differences(one: Any, other: Any, place: str = "") -> list[str]:
    """The places at which two answers differ, with both values."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return [x for key in one for x in differences(one[key], other[key], f"{place}.{key}")]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [x for k, y in enumerate(one) for x in differences(y, other[k], f"{place}[{k}]")]
    return [] if one == other else [f"{place}: {str(one)[:200]} != {str(other)[:200]}"]


def check(name: str, change: str, first: dict[str, Any]) -> None:
    ask = EVERY[name]
    if name not in first:
        first[name] = told(ask(Asking(), False))
    changed = changes_of(name)[change](Asking())
    known_now, computed = told(ask(changed, False)), told(ask(changed, True))
    assert differences(known_now, computed) == []


@pytest.mark.parametrize(("name", "change"), [x for x in PAIRS if x[1] in SHORT.get(x[0], ())])
def test_a_changed_question_has_the_answer_that_is_computed(
    name: str, change: str, first: dict[str, Any]
) -> None:
    check(name, change, first)


@pytest.mark.parametrize(("name", "change"), [x for x in PAIRS if x[1] not in SHORT.get(x[0], ())])
def test_every_other_change_has_the_answer_that_is_computed(
    name: str, change: str, first: dict[str, Any]
) -> None:
    check(name, change, first)


@pytest.mark.parametrize("name", SHORT)
def test_the_question_asked_at_first_is_known_and_its_answer_the_same(
    name: str, first: dict[str, Any]
) -> None:
    if name not in first:
        first[name] = told(EVERY[name](Asking(), False))
    again = EVERY[name](Asking(), False)
    assert again.found.known if hasattr(again, "study") else again.found.origins
    assert told(again) == first[name]


@pytest.mark.parametrize(("name", "change"), [("prove", "text: a spare value"), ("overlap", "param spare")])
def test_a_change_that_no_claim_sees_leaves_answers_known(name: str, change: str) -> None:
    EVERY[name](Asking(), False)
    changed = changes_of(name)[change](Asking())
    recalled, computed = EVERY[name](changed, False), EVERY[name](changed, True)
    assert told(recalled) == told(computed)
    assert recalled.found.known


@pytest.mark.parametrize("name", DRIVER)
def test_no_shipped_plate_answers_for_another_driver(name: str) -> None:
    using = rp.load(specs=["driver"], params={name: DRIVER[name]})
    asked: list[Any] = []

    class Asked(Exception):
        """Nothing more is to be computed."""

    def ask(study: Any, *_: object, **__: object) -> None:
        asked.append(study)
        raise Asked

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.frontends.api.questioned.settle", ask)
        for home in (using, None):
            with pytest.raises(Asked):
                rp.preventable("cut-in", ["careful"], home, lemmas=False, jobs=1)
    other, declared = asked
    assert {*look_up(declared)} >= {*declared.plates}
    assert not look_up(other)
