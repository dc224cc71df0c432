"""The digest of a claim: made of its content alone, and the same in every process."""

import subprocess
import sys
from collections.abc import Mapping
from dataclasses import fields, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roadproof.engines.setting import Search, SearchOptions, Setting, exists_mode
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Exists, On, Valid, claim_of
from roadproof.library.elaborate import elaborate, read_claim
from roadproof.library.loading import load_library
from roadproof.library.specification import Source, Specification
from roadproof.logic import formula as f
from roadproof.runtime.budget import Effort
from roadproof.runtime.canonical import digest, encoded
from roadproof.world.models import load_road, load_vehicle

SPEC = """
param gap = 2 s where gap > 0 "a gap"
param spare = 1 s "no definition uses it"
def near(a: vehicle) "near" := (some gap in lanes: atLane(a, gap)) and v_lon(a) > gap*5 m/s^2
"""
TEXT = "near(SV) and F[0, gap] scenario_4(SV,POV,L)"


def specification(text: str = SPEC) -> Specification:
    return load_library([Source("mine.spec", text)]).select()


def claim(
    text: str = TEXT, spec: str = SPEC, mode: Any = None, values: Mapping[str, Fraction] | None = None
) -> Claim:
    home = specification(spec)
    return claim_of(home, read_claim(home, text), mode or Exists(), values or {})


def test_a_claim_has_exactly_the_parameters_that_occur() -> None:
    names = {x.name for x in claim().parameters}
    assert "gap" in names, "a quantified variable of the same name hides no parameter"
    assert "spare" not in names
    assert {x.name for x in claim("v_lon(SV) > 1 m/s").parameters} == set()
    assert {x.name for x in claim("F[0, gap] v_lon(SV) > 1 m/s").parameters} == {"gap"}


def no_judge() -> Any:
    raise AssertionError("no digest needs an answer")


CHANGED: Mapping[str, Claim] = {
    "text": claim("near(SV) and F[0, gap] scenario_3(SV,POV,L)"),
    "body": claim(spec=SPEC.replace("gap*5", "gap*6")),
    "declared value": claim(spec=SPEC.replace("gap = 2 s", "gap = 1 s")),
    "bound": claim(spec=SPEC.replace("gap > 0", "gap >= 0")),
    "value": claim(values={"gap": Fraction(3)}),
    "valid": claim(mode=Valid()),
    "on a trace": claim(mode=On(("0" * 64,), "", no_judge)),
    "on another trace": claim(mode=On(("1" * 64,), "", no_judge)),
    "on a trace, asked for more": claim(mode=On(("0" * 64,), "roles", no_judge)),
    "road": claim(mode=Exists(road=load_road("main-3"))),
    "vehicle": claim(mode=Exists(vehicles={"": load_vehicle("truck")})),
    "limit that is not shown": claim(
        mode=Exists(vehicles={"": replace(load_vehicle("car"), a_bend=Fraction(3))})
    ),
    "a car that is said": claim(mode=Exists(vehicles={"": load_vehicle("car")})),
    "lanes": claim(mode=Exists(lanes={"L": "main-2"})),
    "horizon": claim(mode=Exists(horizon=Fraction(5))),
}


def test_every_other_claim_has_another_digest() -> None:
    digests = {name: x.digest() for name, x in CHANGED.items()} | {"first": claim().digest()}
    assert len({*digests.values()}) == len(digests)


@pytest.mark.parametrize(
    "spec",
    [
        SPEC.replace("spare = 1 s", "spare = 2 s"),
        SPEC.replace('"near"', '"close"'),
        SPEC.replace("param gap", "\n\nparam gap"),
        f"{SPEC}\ndef other(a: vehicle) := v_lon(a) > 1 m/s",
    ],
)
def test_what_no_engine_sees_leaves_the_digest(spec: str) -> None:
    assert claim(spec=spec).digest() == claim().digest()
    assert claim(f" {TEXT.replace(' and ', '   and ')}").digest() == claim().digest()


def test_shared_parts_leave_the_digest() -> None:
    home = specification()
    query = read_claim(home, TEXT)
    apart = elaborate(specification(SPEC + "\n"), query.claim)
    shared = f.hash_cons([apart.formula], lambda x: x)[0]
    assert digest(query.formula) == digest(apart.formula) == digest(shared)


def test_assumptions_are_part_of_a_claim() -> None:
    home = specification()
    query = read_claim(home, "v_lon(SV) > gap*5 m/s^2")
    assumed = [
        (),
        ("motion",),
        ("motion", "v_lon(SV) <= 30 m/s"),
        ("motion", "v_lon(SV) <= 31 m/s"),
        ("gap = 1 s",),
    ]
    assert len({valid_under(home, query, x).digest() for x in assumed}) == len(assumed)


def test_every_setting_of_a_search_but_values_and_effort_is_part_of_its_claim() -> None:
    names = {x.name for kind in (Setting, SearchOptions) for x in fields(kind)} - {"values", "effort"}
    assert {x.name for x in fields(Exists)} == names | {"unlike", "trees", "apart", "by", "like"}
    home = specification()
    search = Search(home, read_claim(home, TEXT), Setting(horizon=Fraction(5)), SearchOptions("mild"))
    assert search.claim.mode == Exists(horizon=Fraction(5), objective="mild")
    others = [replace(Setting(), collisions=True), replace(Setting(), natural=False)]
    assert len({digest(exists_mode(x, SearchOptions())) for x in (Setting(), *others)}) == 3
    more = replace(search, search_options=replace(search.search_options, effort=Effort(1)))
    assert more.claim.digest() == search.claim.digest()


def test_a_digest_is_the_same_in_every_process() -> None:
    code = "from evidence.test_claim import CHANGED, claim\nprint([x.digest() for x in CHANGED.values()])"
    here = str([x.digest() for x in CHANGED.values()])
    for seed in ("1", "2"):
        told = subprocess.run(
            [sys.executable, "-c", code],
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(__file__).parents[1])},
            capture_output=True,
            text=True,
            check=True,
        )
        assert told.stdout.strip() == here


PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text() | st.binary() | st.fractions(),
    lambda x: st.lists(x).map(tuple) | st.dictionaries(st.text(), x) | st.frozensets(st.integers()),
)


@given(PLAIN, PLAIN)
def test_values_have_one_encoding_each(one: Any, other: Any) -> None:
    assert (encoded(one) == encoded(other)) == (one == other and typed(one) == typed(other))


def typed(value: Any) -> Any:
    """A value with the types of all its parts: True is no 1, and 1 is no fraction here."""
    match value:
        case tuple():
            return [*map(typed, value)]
        case dict():
            return {name: typed(x) for name, x in value.items()}
        case _:
            return type(value), value


@given(st.dictionaries(st.text(), st.integers()))
def test_the_order_of_a_mapping_makes_no_difference(given: dict[str, int]) -> None:
    assert digest(given) == digest(dict(reversed([*given.items()])))


@pytest.mark.parametrize("value", [Path("a"), object(), lambda: None, {Path("a"): 1}, [Path("a")]])
def test_a_path_and_what_is_no_plain_data_have_no_digest(value: object) -> None:
    with pytest.raises(TypeError, match="has no digest"):
        digest(value)
