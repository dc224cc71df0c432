"""A drive that is known is never denied: not by a NONE-WITHIN, and its negation is not PROVED-BOUNDED."""

from dataclasses import replace
from fractions import Fraction

import pytest

from engine_calls import search_for, search_problem
from roadproof.engines.search.bounded import check_bounded
from roadproof.engines.search.drive_search import search_drive
from roadproof.engines.search.search import show_none
from roadproof.engines.setting import SearchOptions
from roadproof.evidence.judged import judge_file
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from searching.known import LIBRARY, holds_on_samples, known
from searching.test_planted_faults import SHORT
from tables import read_table


def ask_for(what, engine="milp", **changes):
    return search_drive(
        search_for(what, search_options=SearchOptions(engine=engine, effort=Effort(30)), **changes)
    )


@pytest.mark.parametrize("engine", ["milp", "smt"])
def test_random_drives_are_not_denied(engine):
    """A longer run of the same, seeds 0 to 1999 with smt, denied none either."""
    verdicts = set()
    for seed in range(20):
        case = known(seed)
        assert holds_on_samples(case.text, case.road, case.drive, case.grid, case.lanes)
        verdict = show_none(case.question(), SearchOptions(engine=engine, effort=Effort(30))).verdict
        assert verdict is not Verdict.NONE_WITHIN, f"seed {seed}: {case.text}"
        verdicts.add(verdict)
    assert Verdict.WITNESSED in verdicts


@pytest.mark.parametrize("engine", ["milp", "smt"])
@pytest.mark.parametrize(
    ("what", "road"),
    [
        ("s(SV) = 30 m", None),
        ("s(SV) = 900 m", None),
        ("s(POV) = -30 m and v_lon(SV) > 20 m/s", None),
        ("F[1.8 s, 1.8 s] s(SV) = 0 m", None),
        ("G[0, 1.8 s] s(SV) <= 0 m", None),
        ("s(SV) + s(POV) = 100 m and s(SV) - s(POV) = 60 m", None),
        ("not inMergeZone(SV) and F inMergeZone(SV)", None),
        ("inMergeZone(SV) and F[0, 1.8 s] not inMergeZone(SV)", None),
        ("not inDepartZone(SV) and inDepartZone(POV)", None),
        ("G[0, 1.8 s] (d(SV) < 0 m and rear(SV) >= -100 m)", "merge"),
        ("F[1.8 s, 1.8 s] s(SV) < 30 m and s(SV) > 0 m", None),
        ("F[1.8 s, 1.8 s] s(SV) - s(POV) < 20 m and G[0, 1.2 s] s(SV) - s(POV) > 20 m", None),
    ],
)
def test_where_a_drive_starts_and_what_comes_after_it_is_left_open(what, road, engine):
    outcome = ask_for(what, engine, road=road, **SHORT)
    assert outcome.verdict is Verdict.WITNESSED
    assert judge_file(outcome.drives[0].file, LIBRARY).accepted


@pytest.mark.parametrize("engine", ["milp", "smt"])
@pytest.mark.parametrize(
    ("claim", "road"),
    [
        ("s(SV) <= 1 m", None),
        ("s(POV) >= 0 m or v_lon(SV) < 20 m/s", None),
        ("inMergeZone(SV) or G not inMergeZone(SV)", "merge"),
        ("F[6 s, 6 s] s(SV) >= s(POV)", None),
    ],
)
def test_claims_about_places_are_refuted(claim, road, engine):
    search_options = SearchOptions(engine=engine, effort=Effort(30))
    result = check_bounded(search_for(claim, road=road, search_options=search_options))
    assert result.verdict is Verdict.REFUTED
    assert judge_file(result.drive.file, LIBRARY).accepted


BORDERLINE = read_table(__file__, "borderline")


@pytest.mark.parametrize("what", BORDERLINE)
def test_what_holds_by_a_hair_is_not_denied(what):
    outcome = ask_for(what, **SHORT)
    assert outcome.verdict is Verdict.WITNESSED


@pytest.mark.parametrize(
    "what",
    [
        "v_lon(SV) > 40 m/s",
        "F d(SV) > 7 m and G v_lat(SV) = 0 m/s",
        "s(POV) - s(SV) > 80 m",
        "s(SV) < 0 m and F[0.6 s, 0.6 s] s(SV) > 24 m",
        "d(SV) < 1.8 m",
    ],
)
def test_what_fails_by_a_hair_is_denied(what):
    assert ask_for(what, **SHORT).verdict is Verdict.NONE_WITHIN
    assert ask_for(what, "smt", **SHORT).verdict is Verdict.NONE_WITHIN


@pytest.mark.parametrize(
    ("what", "verdict"),
    [
        ("s({0}) - s({1}) = 60 m and s({1}) - s({2}) = 60 m", Verdict.NONE_WITHIN),
        ("s({0}) - s({1}) = 40 m and s({1}) - s({2}) = 40 m", Verdict.WITNESSED),
        ("s({0}) = 1004.5 m and s({1}) = 924.5 m and s({2}) = 964 m", Verdict.WITNESSED),
        ("s({0})^2 > 1010000 * 1 m * 1 m and s({0}) > 0 m and s({1}) > s({2})", Verdict.NONE_WITHIN),
    ],
)
def test_which_vehicle_comes_first_makes_no_difference(what, verdict):
    question = search_problem(search_for(what.format("SV", "POV", "POV2"), natural=False, **SHORT))
    for turn in (("SV", "POV", "POV2"), ("POV2", "SV", "POV"), ("POV", "POV2", "SV")):
        turned = replace(question, vehicles={name: question.vehicles[name] for name in turn})
        assert show_none(turned, SearchOptions(effort=Effort(30))).verdict is verdict


def test_a_road_that_ends_has_drives(tmp_path):
    ending = tmp_path / "ending.toml"
    ending.write_text(
        '[[lanelet]]\nid = "a"\nlane = "A"\nzone = "main"\nattribute = "main"\ns = [0, 700]\nd = [0, 4]\n'
    )
    for what in ("v_lon(SV) > 20 m/s", "rear(SV) = 0 m", "s(POV) - s(SV) > 30 m and s(POV) = 400 m"):
        assert ask_for(what, road=str(ending), **SHORT).verdict is Verdict.WITNESSED
    assert ask_for("rear(SV) < 0 m", road=str(ending), **SHORT).verdict is Verdict.NONE_WITHIN


def test_every_limit_is_named_in_text_and_data():
    changes = {"lanes": {"L": "main-2"}, "values": {"rho": Fraction(1)}, **SHORT}
    what = "rssViolation(SV, POV) and atLane(SV, L) and s(SV) > 9 m and v_lon(SV) > 41 m/s"
    outcome = ask_for(what, **changes)
    assert outcome.verdict is Verdict.NONE_WITHIN
    for part in (
        "road main-2",
        "every 0.6 s up to 1.8 s",
        "the formula read at them and the last standing for all later time",
        "accelerations constant between them",
        "boxes on the road and apart at them",
        "vehicles POV=car, SV=car",
        "lane L=main-2",
        "at most 80 m apart",
        "between s=-1072 m and s=1013.5 m",
        "rho=1",
    ):
        assert part in outcome.reason
    told = outcome.limits.as_json()
    assert told["starts"] == ["-1072", "2027/2"]
    assert told["lanes"] == {"L": "main-2"}
    assert told["parameters"]["rho"] == "1"
    assert told["shown"]
    assert outcome.reason.endswith(f"({', '.join(told['shown'])})")
    alone = ask_for("v_lon(SV) > 41 m/s", **SHORT)
    assert alone.limits.starts is None
    assert "starts" not in alone.reason
    assert "apart" not in alone.reason
    together = ask_for("v_lon(SV) > 41 m/s and v_lon(POV) > 20 m/s", collisions=True, **SHORT)
    assert "boxes on the road at them" in together.reason
