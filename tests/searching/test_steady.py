"""A claim about one instant that no search can refute is refuted by constant motion from there."""

import roadproof as rp
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.semantics.exact.exact import judge


def test_a_cubic_claim_is_refuted_by_a_steady_drive():
    home = rp.load()
    claim = "v_lon(SV)*v_lon(SV)*v_lon(SV) <= v_lon(SV)*v_lon(POV)*v_lon(POV) or v_lon(SV) <= v_lon(POV)"
    answer = rp.prove(claim, using=home, jobs=1)
    [drive] = answer.evidence
    assert str(answer.verdict) == "REFUTED"
    formula = bind(read_claim(home.specification, claim).formula, drive.file.road, {}, drive.file.values)
    assert not judge(formula, drive.file.drive).holds
    assert all(len(x.pieces) == 1 for x in drive.file.drive.vehicles.values())


def test_a_number_of_the_claims_own_is_refuted_by_a_trace():
    answer = rp.prove("given v: m/s: v*v*v <= v*v_lon(SV)^2", jobs=1)
    assert str(answer.verdict) == "REFUTED"
    assert "by a trace" in str(answer)


def test_two_formulas_about_one_instant_are_compared_without_a_search():
    """At the declared values: the engines cannot bound cubes."""
    first = "v_lon(SV)*v_lon(SV)*v_lon(SV) > rho*a_max*v_lon(POV)^2 and v_lon(POV) > rho*a_max"
    second = "v_lon(SV)*v_lon(SV)*v_lon(SV) > (rho*a_max)^3"
    found = rp.compare(first, second, jobs=1)
    assert [str(x) for x in found.verdicts.values()] == ["PROVED", "REFUTED"]
    _, drive = found.evidence
    assert found.exit_code == 0
    assert len(drive.file.drive.vehicles) == 2
