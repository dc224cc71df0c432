"""Why there is no drive: no part of a conflict can be left out, and the remedy gives a drive."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.engines.encode.problem import ColumnValues
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.errors import UsageError
from roadproof.extensions.encoding import conflict as conflict_module
from roadproof.extensions.encoding.conflict import NoneWithinExplanation, explain_none
from roadproof.frontends.cli.main import main

HOME = rp.load("base")
BRAKES = "F (v_lon(SV) > 30 m/s and F[0, 1] v_lon(SV) < 20 m/s)"


def explained(formula: str, **options: object) -> NoneWithinExplanation:
    return rp.conflict(formula, horizon=3, **options)


BESIDE = "G (s(SV) - s(POV) > -4 m and s(SV) - s(POV) < 4 m)"
ACROSS = "G (d(SV) - d(POV) > -1 m and d(SV) - d(POV) < 1 m)"
CASES = {
    BRAKES: (
        "acceleration of SV: the acceleration is within the limits of the vehicle",
        f"{BRAKES[:-2]} s] v",
    ),
    "v_lon(SV) > 25 m/s and G v_lon(SV) < 20 m/s and d(SV) > 3 m": (
        "v_lon(SV) > 25 m/s",
        "G v_lon(SV) < 20 m/s",
    ),
    "s(POV) - s(SV) > 100 m and F s(SV) > s(POV)": ("s(POV) - s(SV) > 100 m",),
    "s(POV) < s(SV) - 1 m and G v_lon(POV) < v_lon(SV) and F s(POV) > s(SV)": (
        "motion of POV: places follow from speeds by the trapezoid rule",
        "motion of SV: places follow from speeds by the trapezoid rule",
        "s(POV) < s(SV) - 1 m",
        "G v_lon(POV) < v_lon(SV)",
        "F s(POV) > s(SV)",
    ),
    f"{BESIDE} and {ACROSS}": ("clearance of SV and POV: the boxes are apart", BESIDE, ACROSS),
}


@pytest.mark.parametrize("formula", CASES)
def test_the_parts_that_conflict(formula: str) -> None:
    (conflict,) = explained(formula).conflicts
    assert conflict.irreducible
    expected = CASES[formula]
    if formula == BRAKES:
        assert conflict.parts[0] == expected[0]
        assert conflict.parts[1].startswith("F (v_lon(SV) > 30 m/s")
    else:
        assert {x.replace("POV and SV", "SV and POV") for x in conflict.parts} == {*expected}


def test_the_remedy_is_the_least_that_gives_a_drive() -> None:
    shown = explained(BRAKES)
    assert shown.remedy == "a model of SV with a_lon.min=-12"
    query = HOME.numbered(BRAKES)[1]
    place = Setting(horizon=Fraction(3), natural=False)
    search = Search(HOME.specification, query, place, SearchOptions())
    assert explain_none(search) == shown
    stronger = replace(place, limits={"SV": {"a_lon.min": Fraction(-12)}})
    with pytest.raises(UsageError, match="no solver shows that there is no drive"):
        explain_none(replace(search, setting=stronger))
    later = rp.conflict("F v_lon(SV) > 38 m/s and v_lon(SV) < 25 m/s", horizon=3)
    assert later.remedy == "--horizon 24/5"


def test_definitions_have_their_place() -> None:
    (conflict, *_) = rp.conflict("sameLane(SV, POV, L) and G d(SV) - d(POV) > 4 m", horizon=1).conflicts
    assert any(x.startswith("atLane (iso34502.spec, line 31): d(") for x in conflict.parts), conflict.parts


def test_where_squares_are_too_steep_the_core_is_that_of_the_exact_problem() -> None:
    (conflict,) = rp.conflict(
        "v_lon(SV)^3 > 30 m/s * v_lon(SV)^2 and v_lon(SV) < 25 m/s", horizon=1
    ).conflicts
    assert not conflict.irreducible
    assert conflict.parts


def test_what_no_solver_decides_is_not_called_irreducible(monkeypatch: pytest.MonkeyPatch) -> None:
    honest, asked = conflict_module.solve_mixed, []

    def unsure(*args: object, **more: object) -> ColumnValues:
        asked.append(args)
        return honest(*args, **more) if len(asked) == 1 else ColumnValues("unknown")

    monkeypatch.setattr(conflict_module, "solve_mixed", unsure)
    monkeypatch.setattr(conflict_module, "_has_drive", lambda _: False)
    shown = explained(BRAKES)
    (conflict,) = shown.conflicts
    assert len(asked) > 5
    assert not conflict.irreducible
    assert len(conflict.parts) == len(asked) - 1
    assert "none can be left out" not in str(shown)


def test_a_horizon_of_too_many_steps_is_no_remedy() -> None:
    never = "v_lon(SV) > 25 m/s and G v_lon(SV) < 20 m/s"
    assert rp.conflict(never, horizon=6, dt="1/50").remedy == ""


def test_a_modifier_may_object_to_any_drive_so_none_is_a_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conflict_module, "find_modifier", lambda _: object())
    assert explained(BRAKES).remedy == ""


def test_the_command_line_prints_it(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    line = ["witness", BRAKES, "--horizon", "3", "--explain", "--no-pictures", "--jobs", "1"]
    assert main([*line, "--out", str(tmp_path)]) == 10
    assert capsys.readouterr().out.count("in conflict") == 1
    assert main(line) == 10
    out = capsys.readouterr().out
    assert "none can be left out:\n  acceleration of SV" in out
    assert out.endswith("a drive exists with a model of SV with a_lon.min=-12\n")
    assert main(["witness", "4", "--explain", "--no-pictures", "--jobs", "1"]) == 0
    assert "in conflict" not in capsys.readouterr().out
