"""Each planted fault is noticed by the comparison with the recursive reading."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from extensions.traffic.monitoring.cases import (
    IN_LANE,
    ON_MAIN,
    boolean_differences,
    interval,
    margin_differences,
    random_batch,
)
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled import answers, arithmetic, boolean, compiled
from roadproof.semantics.sampled import lattice as semantics
from roadproof.semantics.sampled.batch import Array
from roadproof.semantics.sampled.lattice import View

NEAR = f.Compare(t.Signal("s", "SV"), "<", t.Signal("s", "POV"))
INVERSE = f.Compare(t.Inverse(t.Signal("s", "SV")), ">=", t.Inverse(t.Signal("s", "POV")))
SPEED = f.Compare(t.Sum((t.Power(t.Signal("v_lon", "SV"), 2), t.number(-1))), ">", t.number(0))
EXAMPLES: tuple[Formula, ...] = (
    f.Eventually(interval(1, 3), IN_LANE),
    f.Always(interval(0, 2), f.Or((IN_LANE, NEAR))),
    f.Until(IN_LANE, interval(0, 5), ON_MAIN),
    f.Until(IN_LANE, interval(2, 3), ON_MAIN),
    f.Until(f.Or((IN_LANE, SPEED)), interval(0, None), NEAR),
    f.Not(f.Eventually(interval(0, 2), ON_MAIN)),
    f.Always(interval(0, None), f.Not(f.Always(interval(1, 2), ON_MAIN))),
    INVERSE,
    f.Since(IN_LANE, interval(0, 5), ON_MAIN),
    f.Since(IN_LANE, interval(2, 3), ON_MAIN),
    f.Eventually(interval(0, 6), f.Since(f.Or((IN_LANE, SPEED)), interval(1, None), NEAR)),
    f.Eventually(interval(3, None), f.historically(interval(0, 2), f.Or((IN_LANE, NEAR)))),
)


def differences() -> int:
    """How often monitor and recursive reading part on the examples."""
    count = 0
    for seed, formula in enumerate(EXAMPLES):
        batch = random_batch(seed, 20, 8)
        for convention in ("truncated", "clip"):
            count += sum(1 for _ in boolean_differences(formula, batch, convention))  # type: ignore[arg-type]
            count += sum(1 for _ in margin_differences(formula, batch, convention))  # type: ignore[arg-type]
    return count


def test_without_faults_there_is_no_difference() -> None:
    assert differences() == 0


Plant = Callable[[pytest.MonkeyPatch], None]


def window_one_short(patch: pytest.MonkeyPatch) -> None:
    right = semantics._samples_in_window
    patch.setattr(semantics, "_samples_in_window", lambda *x: max(1, right(*x) - 1))


def window_starts_late(patch: pytest.MonkeyPatch) -> None:
    right = semantics.shift
    patch.setattr(semantics, "shift", lambda values, steps, padding: right(values, steps + 1, padding))


def until_asks_at_the_end(patch: pytest.MonkeyPatch) -> None:
    right = semantics.until

    def wrong(lattice: Any, held: Array, reached: Array, *rest: Any) -> Array:
        return right(lattice, held, lattice.meet(held, reached), *rest)

    patch.setattr(semantics, "until", wrong)


def until_asks_from_now_on(patch: pytest.MonkeyPatch) -> None:
    """The other reading of until: ``held`` from 0 on, not from the start of the interval."""
    right = semantics.until

    def wrong(lattice: Any, held: Array, reached: Array, low: int, high: int | None, padding: Any) -> Array:
        found = right(lattice, held, reached, low, high, padding)
        if low == 0:
            return found
        before = semantics.extremum(lattice.meet, held, 0, low - 1, padding)
        return np.asarray(lattice.meet(before, found))

    patch.setattr(semantics, "until", wrong)


def since_asks_at_the_end(patch: pytest.MonkeyPatch) -> None:
    right = semantics.since

    def wrong(lattice: Any, held: Array, reached: Array, *rest: Any) -> Array:
        return right(lattice, held, lattice.meet(held, reached), *rest)

    patch.setattr(semantics, "since", wrong)


def since_is_once(patch: pytest.MonkeyPatch) -> None:
    right = semantics.since
    patch.setattr(
        semantics,
        "since",
        lambda lattice, held, *rest: right(lattice, np.full_like(held, lattice.top), *rest),
    )


def the_first_sample_lasts(patch: pytest.MonkeyPatch) -> None:
    """What holds at the first sample is taken to have held before it."""
    right = semantics.since

    def wrong(lattice: Any, held: Array, reached: Array, low: int, high: int | None) -> Array:
        more = [np.concatenate([np.repeat(x[:1], 9, axis=0), x]) for x in (held, reached)]
        return right(lattice, *more, low, high)[9:]

    patch.setattr(semantics, "since", wrong)


def negation_keeps_the_view(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(semantics, "OPPOSITE", {view: view for view in View})


def weak_is_strong(patch: pytest.MonkeyPatch) -> None:
    for module in (compiled, answers):
        patch.setattr(module, "views", lambda _: (View.STRONG, View.STRONG))


def empty_windows_fail_always(patch: pytest.MonkeyPatch) -> None:
    right = semantics.LatticeEvaluation._padding
    patch.setattr(
        semantics.LatticeEvaluation, "_padding", lambda self, view, universal: right(self, view, False)
    )


def ends_of_traces_ignored(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(compiled, "packed_inside", lambda *_: None)


def ends_of_traces_ignored_in_margins(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(compiled, "margin_inside", lambda *_: None)


def bits_in_the_other_order(patch: pytest.MonkeyPatch) -> None:
    right = np.packbits

    def wrong(truth: Array, axis: int, bitorder: str) -> Array:
        return right(truth, axis=axis, bitorder="big")

    patch.setattr(boolean.np, "packbits", wrong)


def strictness_lost(patch: pytest.MonkeyPatch) -> None:
    patch.setitem(arithmetic.COMPARISONS, "<", np.less_equal)


def square_forgotten(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(arithmetic._BytecodeBuilder, "power_of", lambda self, base, exponent: self.place(base))


def inverse_of_zero_is_zero(patch: pytest.MonkeyPatch) -> None:
    right = arithmetic.invert
    patch.setattr(arithmetic, "invert", lambda x: np.where(x == 0, 0.0, right(x)))


FAULTS: Sequence[Plant] = (
    window_one_short,
    window_starts_late,
    until_asks_at_the_end,
    until_asks_from_now_on,
    since_asks_at_the_end,
    since_is_once,
    the_first_sample_lasts,
    negation_keeps_the_view,
    weak_is_strong,
    empty_windows_fail_always,
    ends_of_traces_ignored,
    ends_of_traces_ignored_in_margins,
    bits_in_the_other_order,
    strictness_lost,
    square_forgotten,
    inverse_of_zero_is_zero,
)


@pytest.mark.parametrize("plant", FAULTS, ids=lambda plant: plant.__name__)
def test_a_planted_fault_is_noticed(plant: Plant, monkeypatch: pytest.MonkeyPatch) -> None:
    plant(monkeypatch)
    assert differences() > 0
