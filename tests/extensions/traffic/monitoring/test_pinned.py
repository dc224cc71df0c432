"""The monitor says what the recursive reading of semantics §1 says, sample by sample."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import some
from extensions.traffic.monitoring.cases import (
    boolean_differences,
    formulas,
    margin_differences,
    random_batch,
    random_traffic,
    trace_of,
)
from roadproof.extensions.traffic.evaluate.recursive import TraceReader, answer
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Application, Formula, subformulas
from roadproof.logic.rewrite import with_values
from roadproof.semantics.sampled import compile
from roadproof.semantics.sampled.answers import Convention

conventions = st.sampled_from(["truncated", "clip"])
quick = settings(max_examples=some(400), deadline=None, derandomize=True)


@quick
@given(formulas, st.integers(0, 10**6), st.integers(1, 6), st.integers(1, 14), conventions)
def test_truth_is_that_of_the_recursive_reading(
    formula: Formula, seed: int, traces: int, longest: int, convention: Convention
) -> None:
    batch = random_batch(seed, traces, longest)
    assert list(boolean_differences(formula, batch, convention)) == []


@quick
@given(formulas, st.integers(0, 10**6), st.integers(1, 6), st.integers(1, 14), conventions)
def test_margins_are_those_of_the_recursive_reading(
    formula: Formula, seed: int, traces: int, longest: int, convention: Convention
) -> None:
    batch = random_batch(seed, traces, longest, ties=seed % 2 == 0)
    assert list(margin_differences(formula, batch, convention)) == []


@settings(max_examples=40, deadline=None, derandomize=True)
@given(formulas, st.integers(0, 10**6), st.sampled_from([63, 64, 65, 130]), conventions)
def test_traces_of_several_words_do_not_mix(
    formula: Formula, seed: int, traces: int, convention: Convention
) -> None:
    batch = random_batch(seed, traces, 5)
    assert list(boolean_differences(formula, batch, convention)) == []


@quick
@given(formulas, st.integers(0, 10**6), conventions)
def test_the_sign_of_a_margin_is_its_truth(formula: Formula, seed: int, convention: Convention) -> None:
    batch = random_batch(seed, 20, 9)
    monitor = compile({"it": formula})
    truth = monitor.evaluate(batch, convention, at="all").answers["it"]
    margin = monitor.measure(batch, convention, at="all").margins["it"]
    inside = np.arange(batch.samples)[:, None] < batch.lengths
    assert (margin.low <= margin.high)[inside].all()
    assert truth.true[inside & (margin.low > 0)].all()
    assert not truth.true[inside & (margin.low < 0)].any()
    assert truth.false[inside & (margin.high < 0)].all()
    assert not truth.false[inside & (margin.high > 0)].any()
    assert np.isnan(margin.low[~inside]).all()
    assert not truth.true[~inside].any()


@quick
@given(formulas, formulas, st.integers(0, 10**6))
def test_cut_and_started_traces_are_traces_of_their_own(one: Formula, two: Formula, seed: int) -> None:
    batch = random_batch(seed, 7, 12)
    rng = np.random.default_rng(seed)
    ends = rng.integers(1, batch.lengths + 1)
    starts = rng.integers(0, ends)
    first, second = compile({"one": one}), compile({"one": one, "two": two})
    observation = second.observe(batch, known=first.observe(batch)).cut(ends)
    found = second.evaluate(observation, starts=starts).answers
    margins = second.measure(replace(batch, lengths=ends), starts=starts).margins
    for i in range(batch.traces):
        trace = trace_of(batch, i, int(starts[i]), int(ends[i]))
        for name, formula in (("one", one), ("two", two)):
            got = "true" if found[name].true[i] else "false" if found[name].false[i] else "undecided"
            assert got == answer(formula, trace)
            assert margins[name].low[i] == TraceReader(trace).margin(formula, 0, "strong")


@quick
@given(formulas, st.integers(0, 10**6), conventions)
def test_named_parts_are_answered_at_every_sample(
    formula: Formula, seed: int, convention: Convention
) -> None:
    named = f.Application("whole", (), formula)
    batch = random_batch(seed, 3, 8)
    monitor = compile({"it": named})
    verdicts = monitor.evaluate(batch, convention, named=True)
    margins = monitor.measure(batch, convention, named=True)
    assert set(verdicts.named) == {x for x in subformulas(named) if isinstance(x, Application)}
    view = "clip" if convention == "clip" else "strong"
    for i in range(batch.traces):
        reading = TraceReader(trace_of(batch, i))
        for part, found in verdicts.named.items():
            for k in range(int(batch.lengths[i])):
                assert found.true[k, i] == reading.holds(part, k, view)  # type: ignore[arg-type]
                assert margins.named[part].low[k, i] == reading.margin(part, k, view)  # type: ignore[arg-type]


def test_named_parts_with_one_body_and_two_names_are_both_answered() -> None:
    body = f.Compare(t.Signal("v_lon", "SV"), ">", t.Signal("v_lon", "POV"))
    formula = f.And((f.Application("faster", ("SV",), body), f.Not(f.Application("quicker", ("SV",), body))))
    verdicts = compile({"it": formula}).evaluate(random_batch(1, 5, 5), named=True)
    assert {x.name for x in verdicts.named} == {"faster", "quicker"}
    assert verdicts.answers["it"].false.all()


@pytest.mark.parametrize("rss_form", ["boolean", "robust"])
@pytest.mark.parametrize("set_name", ["base", "ext"])
def test_scenarios_on_random_traffic(set_name: str, rss_form: str) -> None:
    library = bundled_library()
    specification = library.select(set_name, {"rss_form": rss_form})
    values = {**default_values(library), "minSafe": Fraction(2, 25), "minDanger": Fraction(2, 25)}
    scenarios = {
        f"scenario_{i}": with_values(apply_definition(specification, f"scenario_{i}").formula, values)
        for i in (1, 3, 4, 5, 6, 7, 8)
    }
    batch = random_traffic(list(scenarios.values()), traces=16, longest=20)
    monitor = compile(scenarios)
    truncated, clipped = monitor.evaluate(batch), monitor.evaluate(batch, "clip")
    margins = monitor.measure(batch)
    seen = set()
    for i in range(batch.traces):
        reading = TraceReader(trace_of(batch, i))
        for name, formula in scenarios.items():
            found = truncated.answers[name]
            got = "true" if found.true[i] else "false" if found.false[i] else "undecided"
            seen.add(got)
            assert got == answer(formula, trace_of(batch, i))
            assert clipped.answers[name].true[i] == reading.holds(formula, 0, "clip")
            assert clipped.answers[name].false[i] == (not clipped.answers[name].true[i])
            assert margins.margins[name].low[i] == reading.margin(formula, 0, "strong")
            assert margins.margins[name].high[i] == reading.margin(formula, 0, "weak")
    assert seen == {"true", "false", "undecided"}
