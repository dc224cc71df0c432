"""What the operators that look back, weak until, release, edges, durations and ``let`` mean as formulas."""

from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import TextError
from roadproof.evidence.answer_files import Cause
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.logic.formula import Formula

P, Q = "v_lon(SV) > 1 m/s", "v_lon(POV) > 1 m/s"
SAME = {
    "O": (f"O[1, 2] {P}", f"true S[1, 2] {P}"),
    "H": (f"H[1, 2] {P}", f"not (true S[1, 2] not {P})"),
    "W": (f"{P} W[1, 2] {Q}", f"({P} U[1, 2] {Q}) or G[1, 2] {P}"),
    "R": (f"{P} R[1, 2] {Q}", f"not (not {P} U[1, 2] not {Q})"),
    "rise": (f"rise({P}, 0.4 s)", f"{P} and O[0, 0.4 s] not {P}"),
    "fall": (f"fall({P}, 0.4 s)", f"not {P} and O[0, 0.4 s] {P}"),
    "to the right": (f"{P} S {Q} U {P}", f"{P} S ({Q} U {P})"),
    "let": (
        f"let L = lane of SV at start: {P}",
        f"some L in lanes: (some k in lanelets(L): occ(SV, k)) and {P}",
    ),
    "names": ("given S, W, R: vehicle: v_lon(S) > 1 m/s S v_lon(W) > 1 m/s", None),
}


def formula(text: str) -> Formula:
    return read_claim(bundled_library().select(), text).formula


@pytest.mark.parametrize("name", SAME)
def test_operators_mean_what_they_are_written_with(name: str) -> None:
    text, other = SAME[name]
    if other is None:
        assert "S" in {*read_claim(bundled_library().select(), text).vehicles}
    else:
        assert str(formula(text)).replace("L_lanelet", "k") == str(formula(other))


def test_functions_in_python_write_the_same() -> None:
    one, other = rp.SV.v_lon > "1 m/s", rp.POV.v_lon > "1 m/s"
    for made, text in (
        (rp.O(one, (1, 2)), f"O[1, 2] {P}"),
        (rp.H(one), f"H {P}"),
        (rp.S(one, other), f"{P} S {Q}"),
        (rp.W(one, other), f"{P} W {Q}"),
        (rp.R(one, other, (0, "4 s")), f"{P} R[0, 4 s] {Q}"),
    ):
        assert formula(str(made)) == formula(text)


DURATIONS = "def soon(a, b: vehicle, d: duration) := F[0, d] danger(a, b)\n"


def test_a_duration_is_a_bound_of_an_interval(tmp_path: Path) -> None:
    (tmp_path / "durations.spec").write_text(DURATIONS, "utf-8")
    using = rp.load(specs=[tmp_path / "durations.spec"])
    library = load_library([Source("durations.spec", DURATIONS)])
    for text, verdict in (
        ("soon(SV,POV,2 s) -> soon(SV,POV,minSafe + 2 s)", "PROVED"),
        ("soon(SV,POV,3 s) -> soon(SV,POV,2 s)", "REFUTED"),
    ):
        assert rp.prove(text, using=using, jobs=1).verdict == verdict
    for text, message in (
        ("soon(SV,POV,minSafe - 1 s)", "is a duration, which may never be negative"),
        ("soon(SV,POV,-1 s)", "is a duration, which may never be negative"),
        ("soon(SV,POV,3 m)", "is in s, but this is in m"),
        ("given d: duration: soon(SV,POV,d)", "only arguments of definitions are"),
    ):
        with pytest.raises(TextError, match=message):
            read_claim(library.select(), text)


MISTAKES = {
    "F let L = lane of SV at start: atLane(SV,L)": "outside of temporal operators",
    "O (let L = lane of SV at start: atLane(SV,L))": "outside of temporal operators",
    f"rise({P})": "takes a formula and a time, but got 1 argument",
    f"fall({P}, 1 m)": "an interval bound is a time",
    f"rise({P}, -1 s)": "the interval is empty: low=0 is above high=-1",
    f"fall({P}, minSafe - 1 s)": "an interval bound may never be negative",
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes(text: str) -> None:
    with pytest.raises(TextError, match=MISTAKES[text]):
        formula(text)


def test_definitions_have_no_let() -> None:
    text = "def mine(a, b: vehicle) := let L = lane of a at start: atLane(b, L)\n"
    with pytest.raises(TextError, match="stands in claims only"):
        read_claim(load_library([Source("mine.spec", text)]).select(), "mine(SV,POV)")


@pytest.mark.parametrize("number", range(1, 9))
def test_naming_the_lane_at_the_start_says_the_same_as_some_lane(number: int) -> None:
    """docs/reference/language.md: the lane from outside decides no answer about scenarios 1 to 8."""
    called = f"scenario_{number}({'SV,POV1,POV2' if number == 2 else 'SV,POV'},L)"
    named = f"let L = lane of {'POV' if number == 7 else 'SV'} at start: {called}"
    assert rp.prove(f"(some L in lanes: {called}) <-> ({named})", jobs=1).verdict == "PROVED"


def test_proofs_refuse_to_look_back() -> None:
    answer = rp.prove("G (danger(SV,POV) -> O danger(SV,POV))", effort=1, jobs=1)
    [verdict] = answer.as_data()["verdicts"]  # type: ignore[index,call-overload]
    assert answer.verdict == "UNKNOWN"
    assert verdict["doubt"]["cause"] == Cause.PAST
    assert verdict["doubt"]["tried"] == ["drives"]


def test_a_drive_on_which_something_was_so_before() -> None:
    assert rp.witness(f"not {P} and O[0, 2] {P}", effort=2, jobs=1).verdict == "NONE-WITHIN"
    later = rp.witness("F (v_lon(SV) < 20 m/s and O[0, 3 s] v_lon(SV) > 21 m/s)", pictures=False, jobs=1)
    assert later.verdict == "WITNESSED"
