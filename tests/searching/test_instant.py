"""Claims about one instant that no engine reads: refuted from a sampled state, by a drive that is judged."""

from fractions import Fraction

import pytest

import roadproof as rp
from roadproof.engines.search import instant_claims, settle
from roadproof.engines.search.instant_claims import sampled_drive
from roadproof.engines.search.question import Setting
from roadproof.engines.search.settle import settle as settled
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.fragment import is_cubic_state
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict

HOME = bundled_library().select()
FALSE = "v_lon(SV)*v_lon(SV)*v_lon(SV) <= v_lon(SV)*v_lon(POV)^2 or v_lon(SV) <= v_lon(POV)"
TRUE = "v_lon(SV) >= 0 and v_lon(POV) >= v_lon(SV) -> v_lon(SV)^3 <= v_lon(POV)^3"


def claim(text):
    return read_claim(HOME, text)


def sampled(text, values=None):
    return sampled_drive(HOME, claim(text), values or {}, Setting())


def test_a_false_claim_is_refuted_by_constant_motion():
    drive = sampled(FALSE)
    assert all(len(x.pieces) == 1 for x in drive.file.drive.vehicles.values())
    assert judge(drive.judgement.formula, drive.file.drive).holds


def test_a_claim_that_is_so_is_not_refuted():
    assert sampled(TRUE) is None


def test_states_beyond_the_limits_of_the_vehicles_are_looked_at():
    drive = sampled("v_lon(SV)^3 <= 64000*(1 m/s)*(1 m/s)*(1 m/s)")  # 40 m/s, which a car drives at most
    assert drive.file.drive.vehicles["SV"].v_lon > 40


def test_at_the_values_that_are_asked_for():
    text = "v_lon(SV)^3 <= rho*rho*rho*(120 m/s^2)*(120 m/s^2)*(120 m/s^2)"
    assert sampled(text) is None  # 72 m/s, which is far beyond what a car drives
    assert sampled(text, {"rho": Fraction(1, 5)}).file.values["rho"] == Fraction(1, 5)


@pytest.mark.parametrize(
    ("text", "cubic"),
    [
        (FALSE, True),
        ("v_lon(SV)^2 <= v_lon(POV)^2", False),
        (f"G ({FALSE})", False),
        ("given v: m/s: v*v*v <= v*v_lon(SV)^2", False),
        (f"atLane(SV, L) and ({FALSE})", False),
    ],
)
def test_of_which_claims_states_are_sampled(text, cubic):
    assert is_cubic_state(claim(text).formula) == cubic
    assert cubic or sampled(text) is None


def test_a_state_in_which_the_claim_is_true_is_no_refutation(monkeypatch):
    """A state that nobody has judged is handed on; the drive is judged all the same."""
    monkeypatch.setattr(
        instant_claims, "states", lambda _, space, most: [{x: low for x, (low, _) in space.ranges.items()}]
    )
    assert sampled(TRUE) is None


def test_what_a_proof_does_not_decide_quickly_is_sampled(monkeypatch):
    """With no work for z3 the drive comes from a sampled state; with none for samples it stays in doubt."""
    monkeypatch.setattr(settle, "BRIEF", 1e-6)
    monkeypatch.setattr("roadproof.engines.search.refute.quick_drive", lambda *_: None)
    found = settled(HOME, claim(FALSE), Effort(2e-6))
    assert found.verdict is Verdict.REFUTED
    assert found.refuted_by == "drive"
    monkeypatch.setattr(settle._Settler, "_quick", lambda _: None)
    monkeypatch.setattr(settle._Settler, "_searched", lambda *_: None)
    assert settled(HOME, claim(FALSE), Effort(2e-6)).verdict is Verdict.UNKNOWN


def test_driver_models_are_told_apart_both_ways():
    home = rp.load(specs=["driver"])
    names = ("unpreventable_cutIn_r157(SV,POV)", "unpreventable_cutIn_eu1426(SV,POV)")
    found = rp.compare(*names, using=home, jobs=1)
    assert [str(x) for x in found.verdicts.values()] == ["REFUTED", "REFUTED"]
    assert all(drive.judgement.holds for drive in found.evidence)
