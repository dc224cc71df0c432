"""The small roads that claims about all lanes are tried on."""

import pytest

from proving.claims import specification
from roadproof.engines.prove.small_roads import roster_for
from roadproof.evidence.atoms import Atoms
from roadproof.library.elaborate import read_claim
from roadproof.logic import formula as f

SOME_LANELET = "every K in lanes: some l in lanelets(K): F occ(SV,l) and G occ(POV,l)"
SOME_LANE = "every K in lanes: some N in lanes: F atLane(SV,K) and G atLane(POV,N)"


def roster_of(claim: str):
    query = read_claim(specification(), claim)
    return roster_for(Atoms().abstract(query.formula), query.lanes)


@pytest.mark.parametrize("claim", ["F atLane(SV,L)", "F (some l in lanelets(L): occ(SV,l))"])
def test_without_open_quantifiers_there_is_none(claim):
    assert roster_of(claim) is None


def test_two_lanes_and_lanelets_only_where_they_are_spoken_of():
    roster = roster_of(SOME_LANE)
    assert (len(roster.lanes), dict(roster.lanelets)) == (2, {})
    roster = roster_of(SOME_LANELET)
    assert sorted(roster.lanelets.values()) == sorted(2 * roster.lanes)
    assert not set(roster.lanelets) & set(roster.lanes)


def test_lanes_of_the_claim_are_among_them():
    roster = roster_of(f"given L1, L2, L3: lane: ({SOME_LANE}) -> G atLane(SV,L1)")
    assert roster.lanes == ("L1", "L2", "L3")
    roster = roster_of(f"given L1: lane: ({SOME_LANE}) -> G atLane(SV,L1)")
    assert roster.lanes[0] == "L1"
    assert len(roster.lanes) == 2


def test_a_free_lanelet_is_in_the_last_lane():
    roster = roster_of(f"given l: lanelet: ({SOME_LANE}) -> G occ(SV,l)")
    assert roster.lanelets["l"] == roster.lanes[-1]


def test_members():
    roster = roster_of(SOME_LANELET)
    one, other = roster.lanes
    assert roster.members(f.Domain("lanes")) == [one, other]
    assert roster.members(f.Domain("adjacent", one)) == [other]
    assert [roster.lanelets[x] for x in roster.members(f.Domain("lanelets", one))] == [one, one]
    assert roster.members(f.Domain("zone", "main")) == list(roster.lanelets)
