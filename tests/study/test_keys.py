"""No answer is taken from a store where one thing of its question is another.

Each question is asked, one thing is changed, and it is asked again with and without what is known: the two
answers are equal. Then it is asked as at first, and is known. Shipped and kept answers count here.
"""

from collections.abc import Iterator
from typing import Any

import pytest

import roadproof as rp
from api.both_interfaces import without_seconds
from examples import EVERY_CHANGE
from roadproof.errors import RoadproofError
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library
from roadproof.logic.rewrite import parameters_of
from roadproof.questions.decide import look_up
from roadproof.questions.question import walk_batch
from roadproof.runtime.archives import SWITCH
from study.changes import DRIVER, PAIRS, UNCHANGED, changes_of, unchanged_options
from study.commands import EVERY
from study.stored_question import StoredQuestion

LEAF, NEAR = "text: leaf, which two sets share", "text: near, whose variable is called as a parameter"
SHORT: dict[str, tuple[str, ...]] = {
    "prove": tuple(x for x in changes_of("prove") if not x.startswith(("text: danger", "--"))),
    "witness": (LEAF, "param low", "option pace", "--horizon", "--road", "--count"),
    "witness_scenarios": ("text: a disturbance", "param minDanger"),
    "overlap": (LEAF, "param gap", "option pace", "--lanes"),
    "explore": (NEAR, "param gap", "--when"),
    "preventable": (
        "text: a disturbance",
        *(x for x in changes_of("preventable") if x.startswith("driver ")),
    ),
    "catalogue": (
        LEAF,
        "param low",
        *(x for x in changes_of("catalogue") if x.startswith("file ") and "_zones" in x),
    ),
    "evaluate": (LEAF, "param minSafe", "--classes", "file recordings/merge_zones.toml: there"),
    "compare": (LEAF, "param low"),
}
"""The changes that are made in each run, by question."""
OTHERS = [x for x in PAIRS if x[1] not in SHORT.get(x[0], ())]
"""All others: ROADPROOF_CHANGES=all makes them, which takes hours."""
SOME = OTHERS if EVERY_CHANGE else [x for x in OTHERS if x[0] != "coverage"][::15]
"""Those that a long run makes: one of 15, and none of coverage, where one takes more than ten minutes."""


@pytest.fixture(scope="module", autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A cache of our own, and all that is shipped."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(SWITCH, "on")
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


class Asked(Exception):
    """Nothing more is to be computed."""


def answer(name: str, asking: StoredQuestion, fresh: bool) -> Any:
    """An answer as data, or why there is none."""
    try:
        return told(EVERY[name][0](asking, fresh))
    except RoadproofError as error:
        return {"error": str(error)}


def told(answers: Any) -> Any:
    """An answer as data; of drives only the parameters that their formula mentions, and no traces.

    A computed drive also lists what the user has changed and no formula mentions. Of the traces that refute
    a claim for all values, a solver that has answered other questions before may find another one.
    """
    if isinstance(answers, dict):
        return without_seconds(answers)
    return without_seconds(with_mentioned(answers.as_data(), answers.library))


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
    if name not in first:
        first[name] = answer(name, StoredQuestion(), False)
        assert "error" not in first[name]
    changed = changes_of(name)[change](StoredQuestion())
    known_now, computed = answer(name, changed, False), answer(name, changed, True)
    assert differences(known_now, computed) == []


@pytest.mark.parametrize(("name", "change"), [x for x in PAIRS if x[1] in SHORT.get(x[0], ())])
def test_a_changed_question_has_the_answer_that_is_computed(
    name: str, change: str, first: dict[str, Any]
) -> None:
    check(name, change, first)


@pytest.mark.parametrize(("name", "change"), SOME)
def test_every_other_change_has_the_answer_that_is_computed(
    name: str, change: str, first: dict[str, Any]
) -> None:
    check(name, change, first)


@pytest.mark.parametrize("name", EVERY)
def test_every_option_of_a_question_is_changed(name: str) -> None:
    assert unchanged_options(name) <= {*UNCHANGED}


@pytest.mark.parametrize("name", SHORT)
def test_the_question_asked_at_first_is_known_and_its_answer_the_same(
    name: str, first: dict[str, Any]
) -> None:
    if name not in first:
        first[name] = answer(name, StoredQuestion(), False)
    again = EVERY[name][0](StoredQuestion(), False)
    assert told(again) == first[name]
    assert isinstance(again, dict) or is_recalled(again)


def is_recalled(answers: Any) -> bool:
    return bool(answers.found.origins)


@pytest.mark.parametrize("name", [x for x in EVERY if x not in ("evaluate", "compare")])
def test_another_version_has_no_answer_to_any_question(name: str) -> None:
    """Neither a shipped one nor one that an earlier run has kept."""
    studies: list[Any] = []

    def ask(study: Any, *_: object, **__: object) -> None:
        studies.append(study)
        raise Asked

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.frontends.api.question_answers.decide_claims", ask)
        patch.setattr("roadproof.extensions.surveys.classify.division.decide_claims", ask)
        with pytest.raises(Asked):
            EVERY[name][0](StoredQuestion(), False)
        patch.setattr("roadproof.questions.store.ANSWERS", "9.9.9")
        assert look_up(studies[0]) == {}


def test_another_version_of_the_program_evaluates_again(monkeypatch: pytest.MonkeyPatch) -> None:
    lines: list[str] = []
    tell = StoredQuestion().with_more(tell=lines.append)
    evaluate = EVERY["evaluate"][0]
    evaluate(tell, False)
    lines.clear()
    evaluate(tell, False)
    assert any("already evaluated" in x for x in lines)
    lines.clear()
    monkeypatch.setattr(
        "roadproof.extensions.traffic.evaluate.results.program_digest", lambda: "another program"
    )
    evaluate(tell, False)
    assert not any("already evaluated" in x for x in lines)


@pytest.mark.parametrize(("name", "change"), [("prove", "text: a spare value"), ("overlap", "param spare")])
def test_a_change_that_no_claim_sees_leaves_answers_known(name: str, change: str) -> None:
    ask = EVERY[name][0]
    ask(StoredQuestion(), False)
    changed = changes_of(name)[change](StoredQuestion())
    recalled, computed = ask(changed, False), ask(changed, True)
    assert told(recalled) == told(computed)
    assert is_recalled(recalled)


@pytest.mark.parametrize("name", ["catalogue", "witness_scenarios"])
def test_a_value_that_was_declared_and_is_given_now_is_in_every_drive(name: str) -> None:
    """A drive that was found for one means the same for the other."""
    declared = changes_of(name)["text: a value that is declared"](StoredQuestion())
    answer(name, declared, False)
    given = changes_of(name)["param gap"](StoredQuestion())
    assert differences(answer(name, given, False), answer(name, given, True)) == []


@pytest.mark.parametrize("name", DRIVER)
def test_no_shipped_plate_answers_for_another_driver(name: str) -> None:
    using = rp.load(specs=["driver"], params={name: DRIVER[name]})
    asked: list[Any] = []

    def ask(study: Any, *_: object, **__: object) -> None:
        asked.append(study)
        raise Asked

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.frontends.api.question_answers.decide_claims", ask)
        for home in (using, None):
            with pytest.raises(Asked):
                rp.preventable("cut-in", ["careful"], home, lemmas=False, jobs=1)
    other, declared = asked
    assert {*look_up(declared)} >= {*declared.plates}
    walked = [x for batch in other.batches({}) for x in walk_batch(batch, lambda *_: None)]
    uses = {x.name for _, claim in walked for x in claim.parameters}
    assert bool(look_up(other)) == (name not in uses), "a plate is known where its lines do not use the value"
    assert name in uses or name in ("cc_drift", "r157_delay", "a_max")
