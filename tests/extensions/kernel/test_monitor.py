"""The Python monitor, word for word against the algorithm that Coq proves right (proofs/kernel/Monitor.v)."""

import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from extensions.kernel import monitors
from extensions.kernel.needs import needs_coq
from extensions.kernel.reading import answers, monitor_theory
from extensions.traffic.monitoring.cases import random_batch, random_traffic
from extensions.traffic.monitoring.test_planted_faults import (
    EXAMPLES,
    bits_in_the_other_order,
    empty_windows_fail_always,
    ends_of_traces_ignored,
    negation_keeps_the_view,
    until_asks_at_the_end,
    until_asks_from_now_on,
    weak_is_strong,
    window_one_short,
    window_starts_late,
)
from roadproof.extensions.kernel.accept import AXIOMS, axioms_of
from roadproof.extensions.kernel.coq import ready
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.rewrite import with_values
from roadproof.semantics.sampled import Batch

SIZES = [(1, 14), (3, 5), (6, 14), (6, 33), (63, 4), (64, 9), (65, 9), (130, 12)]
"""Traces of a batch, and the samples of the longest."""


def random_cases(count: int, seed: int) -> list[monitors.Case]:
    r = random.Random(seed)
    cases = []
    for number in range(count):
        traces, longest = SIZES[number % len(SIZES)]
        formula = monitors.random_formula(r, r.randint(1, 4), longest + 2)
        cases.append(monitors.monitored(formula, random_batch(r.randint(0, 10**6), traces, longest)))
    return cases


def check_random(count: int, seed: int) -> None:
    cases = random_cases(count, seed)
    assert answers(monitors.compared(cases)) == ["true"] * count
    assert {x for case in cases for x in case.answers} == {0, 1, 2}


@needs_coq
def test_words_of_random_formulas_are_those_of_the_proved_algorithm() -> None:
    check_random(80, seed=6)


@needs_coq
def test_words_of_many_random_formulas_are_those_of_the_proved_algorithm() -> None:
    check_random(1000, seed=19)


def random_traffic_everywhere(formulas: list[Formula]) -> Batch:
    """Random traffic with a second car POV2, on lanes and zones that flicker at random."""
    batch = random_traffic(formulas, traces=70, longest=20)
    rng = np.random.default_rng(19)
    places = [x for x in subformulas(*formulas) if isinstance(x, f.Some | f.Every | f.Occupies)]
    signals, sizes = dict(batch.signals), dict(batch.sizes)
    for vehicle in ("POV1", "POV2"):  # each does what POV does in another trace
        order = rng.permutation(batch.traces)
        signals |= {(x, vehicle): v[:, order] for (x, a), v in batch.signals.items() if a == "POV"}
        sizes |= {(x, vehicle): v[order] for (x, a), v in batch.sizes.items() if a == "POV"}
    given = {x: rng.random((batch.samples, batch.traces)) < 0.9 for x in dict.fromkeys(places)}
    return replace(batch, signals=signals, sizes=sizes, given=given)


@needs_coq
def test_words_of_scenarios_are_those_of_the_proved_algorithm() -> None:
    library = bundled_library()
    values = {**default_values(library), "minSafe": Fraction(2, 25), "minDanger": Fraction(2, 25)}
    formulas = [
        with_values(apply_definition(library.select(set_name), f"scenario_{number}").formula, values)
        for set_name in ("base", "ext")
        for number in range(1, 25)
    ]
    batch = random_traffic_everywhere(formulas)
    cases = [monitors.monitored(formula, batch) for formula in formulas]
    assert answers(monitors.compared(cases)) == ["true"] * 48
    assert {x for case in cases for x in case.answers} == {0, 1, 2}


@needs_coq
def test_faults_of_the_python_monitor_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    faults = [
        window_one_short,
        window_starts_late,
        until_asks_at_the_end,
        until_asks_from_now_on,
        negation_keeps_the_view,
        weak_is_strong,
        empty_windows_fail_always,
        ends_of_traces_ignored,
        bits_in_the_other_order,
    ]
    cases, ahead = [], [x for x in EXAMPLES if not f.looks_back(x)]
    for fault in [None, *faults]:
        with monkeypatch.context() as patch:
            if fault is not None:
                fault(patch)
            cases += [monitors.monitored(x, random_batch(n, 20, 8)) for n, x in enumerate(ahead)]
    told = answers(monitors.compared(cases))
    size = len(ahead)
    assert told[:size] == ["true"] * size
    for number, fault in enumerate(faults, 1):
        assert "false" in told[number * size : (number + 1) * size], fault.__name__


WRONG = [
    ("Nat.min (h - low) samples + 1", "Nat.min (h - low) samples"),
    ("Nat.min (h - low) samples + 1", "Nat.min h samples + 1"),
    ("None => samples + 1", "None => samples"),
    (
        "if width <=? wanted - width then join_shifted meet kept",
        "if wanted <=? width then join_shifted meet kept",
    ),
    ("join_shifted meet start found step padding", "join_shifted join start found step padding"),
    ("let p := padding v true in extremum N.land", "let p := padding v false in extremum N.land"),
    ("map complement (value (opposite v) f)", "map complement (value v f)"),
    ("| Until_ f lo hi g => fine lo hi && proper f", "| Until_ f lo hi g => proper f"),
    ("if bit Strong then Yes else if bit Weak then Undecided else No", "if bit Weak then Yes else No"),
]
"""Wrong algorithms, for which the proof must fail."""


@needs_coq
@pytest.mark.parametrize(("right", "wrong"), WRONG)
def test_a_wrong_algorithm_is_not_proved(right: str, wrong: str) -> None:
    theory = monitor_theory()
    assert theory.count(right) == 1
    with ready() as coq:
        assert coq.run(theory.replace(right, wrong)).code != 0


@needs_coq
def test_the_proof_stands_on_known_axioms_alone() -> None:
    """The algorithm on none; worlds on those of Coq's real numbers."""
    with ready() as coq:
        ran = coq.run(f"{monitor_theory()}\nPrint Assumptions value_right.\nPrint Assumptions decided.")
    algorithm, none, worlds = ran.output.partition("Closed under the global context\n")
    assert (ran.code, algorithm, bool(none)) == (0, "", True)
    found = axioms_of(worlds)
    assert found
    assert set(found) <= AXIOMS
