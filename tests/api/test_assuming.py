"""What claims assume, from Python and at the command line: words, limits, mistakes."""

import json

import pytest

import roadproof as rp
from roadproof.errors import InputError, UsageError
from roadproof.frontends.cli.main import main
from roadproof.verdict import Verdict

BEHIND = "G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) <= s(POV)"
FAST = "v_lon(SV) <= 20 m/s -> G[0, 2 s] v_lon(SV) <= 26 m/s"
OF_A_CAR = (
    "assuming motion, v_lon(SV) >= 15 m/s, v_lon(SV) <= 40 m/s, a_lon(SV) >= -6 m/s^2, a_lon(SV) <= 3 m/s^2"
)


def test_an_answer_says_what_it_assumes():
    answer = rp.prove(BEHIND, assume="motion", jobs=1)
    assert str(answer).startswith(f"PROVED  assuming motion: {BEHIND}\n")
    [row], [said] = answer.rows(), answer.as_data()["verdicts"]
    assert (row["assuming"], row["refuted_by"]) == ("motion", None)
    assert (said["claim"], said["assuming"]) == (BEHIND, ["motion"])
    assert "assuming motion: " in str(answer.check())


def test_a_claim_may_say_itself_what_it_assumes():
    assert (
        rp.prove(f"assuming motion: {BEHIND}", jobs=1).verdicts
        == rp.prove(BEHIND, assume="motion", jobs=1).verdicts
    )
    iso = rp.load()
    built = rp.G(rp.SV.v_lon <= rp.POV.v_lon) & (rp.SV.s < rp.POV.s)
    assert rp.prove(built >> rp.G(rp.SV.s <= rp.POV.s), using=iso, assume="motion", jobs=1).verdict is (
        Verdict.PROVED
    )


def test_limits_of_a_model_are_what_is_printed():
    for vehicles in ("car", {"SV": "car"}):
        answer = rp.prove(FAST, assume="motion", vehicles=vehicles, jobs=1)
        assert str(answer).startswith(f"PROVED  {OF_A_CAR}: {FAST}\n")
    again = rp.prove(str(answer).splitlines()[0].removeprefix("PROVED  "), jobs=1)
    assert again.verdicts == answer.verdicts


@pytest.mark.parametrize(
    ("claims", "asked", "wrong"),
    [
        ((BEHIND,), {"assume": "rest"}, "write 'motion'"),
        (("P1",), {"assume": "motion"}, "claims of your own"),
        ((), {"assume": "motion"}, "claims of your own"),
        ((BEHIND,), {"vehicles": "car"}, "limits of vehicles require assume=motion"),
        ((BEHIND,), {"assume": "motion", "vehicles": {"POV2": "car"}}, "the claim mentions POV, SV"),
        ((BEHIND,), {"assume": "motion", "engine": "smt"}, "is about drives anyway"),
        ((f"assuming motion: {BEHIND}",), {"engine": "smt"}, "is about drives anyway"),
        ((f"assuming motion, s(SV) < s(POV): {BEHIND}",), {}, "is no limit"),
        ((f"assuming motion, v_lon(POV2) < 3 m/s: {BEHIND}",), {}, "speaks of POV2"),
        ((f"assuming motion and rest: {BEHIND}",), {}, "only motion can be assumed"),
    ],
)
def test_mistakes_are_named(claims, asked, wrong):
    with pytest.raises((UsageError, InputError), match=wrong):
        rp.prove(*claims, jobs=1, **asked)


def test_places_of_mistakes_stay_where_they_are_behind_what_is_assumed():
    with pytest.raises(InputError, match="line 1, column 20"):
        rp.prove("assuming motion: G dangr(SV,POV)", jobs=1)


def test_the_command_line_asks_the_same(capsys, tmp_path):
    (tmp_path / "claims.txt").write_text(f"# of motions\nassuming motion: {BEHIND}\n\n{BEHIND}\n", "utf-8")
    claims = ["--claims", str(tmp_path / "claims.txt"), "--no-drive", "--jobs", "1", "--json", "-"]
    assert main(["prove", *claims]) == 10
    found = json.loads(capsys.readouterr().out)["verdicts"]
    assert [x["verdict"] for x in found] == ["PROVED", "REFUTED"]
    assert [x["assuming"] for x in found] == [["motion"], []]
    assert [x["refuted_by"] for x in found] == [None, "trace"]
    assert main(["prove", "--assume", "motion", "--vehicle", "SV=car", FAST, "--jobs", "1"]) == 0
    assert capsys.readouterr().out.startswith(f"PROVED  {OF_A_CAR}: {FAST}\n")
    assert main(["prove", "--vehicle", "car", FAST]) == 2
