"""Whoever follows the remedy of an UNKNOWN gets no error, and not the same UNKNOWN again."""

import json
import re
import shlex

import pytest

from roadproof.engines.prove.doubt import Cause
from roadproof.engines.search.remedy import remedy_of
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.motion import split

HOME = bundled_library().select()
CLAIMS = (
    "atLane(POV,L) -> F atLane(POV,L) U onMainRoad(POV)",
    "s(POV) <= 0 m -> G[1 s, 1 s] s(POV) <= 9 m",
    "danger(SV,POV) -> F[0, 3 s] aheadOf(SV,POV)",
    "inMergeZone(SV) -> F onMainRoad(SV)",
    "G F atLane(SV,L) -> F G atLane(SV,L)",
    "(every M in lanes: not atLane(SV,M)) -> G not onMainRoad(SV)",
    "assuming motion: s(POV) <= 0 m -> G[1 s, 1 s] s(POV) <= 9 m",
    "assuming motion, v_lon(POV) <= 30 m/s: s(POV) <= 0 m -> G[1 s, 1 s] s(POV) <= 9 m",
    "assuming motion: atLane(SV,L) and F atLane(POV,L) -> atLane(SV,L) U atLane(POV,L)",
    "given x: m/s: v_lon(SV) > x -> F v_lon(SV) < x",
)
BY_ITSELF = (Cause.WORK, Cause.CLOCK, Cause.PROCESS)
entries = {}
OPTION = re.compile(r"--[a-z]+( (?!--)[\w=.-]+)?")


def followed(claim, remedy, capsys):
    """The answer to the claim with the options that a remedy names."""
    if "assume nothing" in remedy:
        claim = split(claim)[1]
    options = shlex.split(" ".join(x[0] for x in OPTION.finditer(remedy)))
    code = main(["prove", claim, *options, "--effort", "3", "--jobs", "1", "--json", "-"])
    printed = capsys.readouterr()
    assert code in (0, 10, 20), printed.err
    (entry,) = json.loads(printed.out)["verdicts"]
    return entry


@pytest.mark.parametrize("cause", [x for x in Cause if x not in BY_ITSELF])
@pytest.mark.parametrize("claim", CLAIMS)
def test_every_remedy_is_accepted_and_changes_the_answer(claim, cause, capsys):
    said, plain = split(claim)
    remedy = remedy_of(HOME, read_claim(HOME, plain), said, cause)
    assert remedy
    if "--" not in remedy:
        assert plain.startswith("given") or cause is Cause.SOLVER
        return
    if (claim, remedy) not in entries:
        entries[claim, remedy] = followed(claim, remedy, capsys)
    told = entries[claim, remedy].get("doubt") or {}
    assert told.get("cause") != cause or (plain.startswith("given") and told["remedy"] != remedy)


@pytest.mark.parametrize("cause", BY_ITSELF)
def test_what_more_work_helps_has_no_other_remedy(cause):
    assert remedy_of(HOME, read_claim(HOME, CLAIMS[0]), (), cause) is None


def test_limits_are_those_of_a_vehicle_that_the_claim_mentions():
    for name in ("SV", "POV", "POV2"):
        query = read_claim(HOME, f"s({name}) <= 0 m -> G[1 s, 1 s] s({name}) <= 9 m")
        assert f"--vehicle {name}=car" in remedy_of(HOME, query, ("motion",), Cause.FACTS)


def test_motion_that_is_assumed_is_not_named_again():
    query = read_claim(HOME, CLAIMS[0])
    assert "--assume motion" in remedy_of(HOME, query, (), Cause.FIRST_INSTANT)
    assert "--assume motion" not in remedy_of(HOME, query, ("motion",), Cause.FIRST_INSTANT)


def test_limits_that_are_there_are_not_named_again():
    query = read_claim(HOME, "s(SV) <= 0 m -> G[1 s, 1 s] s(SV) <= 9 m")
    assert "--vehicle" not in remedy_of(HOME, query, ("motion", "v_lon(SV) <= 30 m/s"), Cause.FACTS)


def test_options_of_limits_stand_beside_assuming_motion_in_the_claim(capsys):
    code = main(["prove", CLAIMS[6], "--vehicle", "POV=car", "--jobs", "1", "--effort", "3"])
    assert code in (0, 10, 20)
    assert "requires" not in capsys.readouterr().err
    assert main(["prove", CLAIMS[1], "--vehicle", "POV=car"]) == 2
    assert "assuming motion:" in capsys.readouterr().err
