"""Work is counted, the clock is a backstop that an answer names."""

import pickle

import pytest

import roadproof as rp
from roadproof.runtime import budget
from roadproof.runtime.budget import Budget, BudgetExceeded, Effort, backstop
from roadproof.verdict import Verdict


class Clock:
    """A clock that stands still unless it is moved on."""

    def __init__(self, monkeypatch):
        self.now = 0.0
        monkeypatch.setattr(budget.time, "monotonic", lambda: self.now)


@pytest.fixture
def clock(monkeypatch):
    return Clock(monkeypatch)


def test_a_part_spends_from_the_whole_and_has_no_more_than_it():
    whole = Effort(10).meter()
    part = whole.part(4)
    part.spend(3)
    assert (whole.left(), part.left()) == (7, 1)
    part.part(100).spend(2)
    assert (whole.left(), part.left()) == (5, 0)
    assert part.is_exhausted()
    assert not whole.is_exhausted()
    whole.spend(6)
    assert whole.left() == whole.part(4).left() == 0


def test_a_meter_apart_spends_on_its_own_account():
    whole = Effort(2).meter()
    whole.spend(5)
    apart = whole.separate(3)
    assert apart.left() == 3
    apart.spend(1)
    assert whole.spent == 5


def test_the_reason_names_the_limit_that_was_reached():
    whole = Effort(10).meter()
    part = whole.part(4)
    part.spend(4)
    assert part.reason() == "no answer within 4 units of work"
    whole.spend(6)
    assert part.reason() == "no answer within 10 units of work"


@pytest.mark.parametrize("made", [Budget.part, Budget.separate])
def test_what_the_clock_cuts_off_is_late(clock, made):
    meter = made(Effort(10, 3.0).meter(), 4)
    clock.now = 2.5
    assert meter.seconds_left() == 0.5
    assert not meter.is_exhausted()
    clock.now = 3.0
    for ask in (meter.seconds_left, meter.is_exhausted):
        with pytest.raises(BudgetExceeded, match=r"cut off by the clock after 3 s, .*raise --timeout"):
            ask()


def test_work_alone_never_makes_an_answer_late(clock):
    meter = Effort(1, 3.0).meter()
    meter.spend(1e6)
    assert meter.is_exhausted()


def test_the_backstop_follows_from_the_work_unless_it_is_given(clock):
    assert Effort(60).meter().seconds_left() == backstop(60) == 3600
    assert Effort(0.1).meter().seconds_left() == backstop(0.1) == 600
    assert Effort(60, 7.0).with_units(1).meter().seconds_left() == 7


def test_lateness_comes_back_from_another_process():
    late = pickle.loads(pickle.dumps(BudgetExceeded(2.5)))
    assert isinstance(late, BudgetExceeded)
    assert str(late) == str(BudgetExceeded(2.5))
    assert late.exit_code == 20


def test_the_seconds_of_a_timeout_run_over_all_meters_of_a_running_effort(clock):
    running = Effort(10, timeout=20).with_clock_started()
    clock.now = 12
    assert (
        running.with_units(1).meter().seconds_left()
        == running.with_clock_started().meter().seconds_left()
        == 8
    )
    clock.now = 21
    with pytest.raises(BudgetExceeded, match="after 20 s"):
        running.with_units(5).meter().is_exhausted()
    assert Effort(10, timeout=20).meter().seconds_left() == 20


def test_without_a_timeout_each_meter_has_its_own_backstop(clock):
    running = Effort(10).with_clock_started()
    clock.now = 500
    assert running.meter().seconds_left() == backstop(10)


def test_when_an_effort_began_is_no_part_of_it(clock):
    clock.now = 7
    effort = Effort(10, timeout=20)
    assert effort.with_clock_started() == effort
    assert repr(effort.with_clock_started()) == repr(effort)


@pytest.mark.parametrize(
    ("claim", "options"),
    [
        ("G F scenario_4(SV,POV,L) -> G F G F scenario_5(SV,POV,L)", {}),
        ("G F scenario_4(SV,POV,L) -> G F G F scenario_5(SV,POV,L)", {"engine": "smt"}),
        ("scenario_4(SV,POV,L) -> F G scenario_9(SV,POV,L)", {"engine": "milp"}),
        (
            "s(SV) <= s(POV) and G[0, 2 s] (v_lon(SV) <= 30 m/s and v_lon(POV) >= 25 m/s) "
            "-> G[0, 2 s] s(SV) <= s(POV) + 11 m and danger(SV,POV) or not danger(SV,POV)",
            {"assume": "motion"},
        ),
    ],
)
def test_a_claim_ends_with_its_timeout_whatever_is_tried(claim, options):
    """Proofs, sampled drives and searches share the seconds; one step may be under way when they end."""
    found = rp.prove(claim, jobs=1, timeout=2, effort=500, fresh=True, **options)
    answer = found.answers[0]
    cut_off = answer.verdict is Verdict.UNKNOWN and "after 2 s" in answer.reason
    assert cut_off or answer.verdict is Verdict.REFUTED, "a machine may be quick enough to refute it"
    assert (answer.cost.work or 0) < 500, "it does not go on for the effort"
