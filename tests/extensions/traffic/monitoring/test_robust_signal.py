"""Robustness over time on recordings: at each sample that of the trace which starts there."""

import json
from dataclasses import replace
from math import isfinite
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import roadproof as rp
from examples import some
from extensions.traffic.monitoring.cases import IN_LANE, ON_MAIN, formulas, interval, random_batch, trace_of
from roadproof.extensions.traffic.evaluate import margin_signal, observed
from roadproof.extensions.traffic.evaluate.margin_signal import RobustnessSignal
from roadproof.extensions.traffic.evaluate.observed import observe_samples
from roadproof.extensions.traffic.evaluate.recursive import TraceReader, answer
from roadproof.extensions.traffic.evaluate.signal_data import signal_data
from roadproof.frontends.cli.main import main
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled import Batch
from roadproof.semantics.sampled.answers import Convention, Margin

conventions = st.sampled_from(["truncated", "clip"])
DRIVE = Path(__file__).parents[4] / "examples" / "traffic" / "drives" / "scenario-04-base.json"


def suffix(batch: Batch, start: int) -> Batch:
    """The one trace of a batch from a sample on."""
    return replace(
        batch,
        lengths=batch.lengths - start,
        signals={key: x[start:] for key, x in batch.signals.items()},
        given={key: x[start:] for key, x in batch.given.items()},
    )


def faults(formula: Formula, batch: Batch, convention: Convention) -> list[str]:
    """Where the signal is not the robustness of the rest of the trace, or its sign is wrong."""
    found = observe_samples("it", formula, batch, convention, with_signal=True).signal
    assert found is not None
    wrong = [] if len(found) == batch.lengths[0] else [f"{len(found)} samples"]
    for k, (low, high, truth) in enumerate(zip(found.low, found.high, found.truths, strict=True)):
        rest = suffix(batch, k)
        trace = trace_of(rest, 0)
        reading = TraceReader(trace)
        views = ("clip", "clip") if convention == "clip" else ("strong", "weak")
        if (low, high) != tuple(reading.margin(formula, 0, x) for x in views):  # type: ignore[arg-type]
            wrong.append(f"sample {k}: {low}, {high}")
        if (low, high) != observe_samples("it", formula, rest, convention).margin:
            wrong.append(f"sample {k}: not the single value")
        verdict = answer(formula, trace, 0, convention == "clip")
        if truth != verdict:
            wrong.append(f"sample {k}: {truth} for {verdict}")
        sign = found.signs()[k]
        if sign and {1: "true", -1: "false"}[sign] != verdict:
            wrong.append(f"sample {k}: sign {sign}, but {verdict}")
        if found.at(k * batch.dt) != (low, high):
            wrong.append(f"sample {k}: at")
    return wrong


def looks_ahead(formula: Formula) -> bool:
    return not f.looks_back(formula)


@settings(max_examples=some(300), deadline=None, derandomize=True)
@given(formulas.filter(looks_ahead), st.integers(0, 10**6), st.integers(1, 9), conventions)
def test_each_sample_has_the_robustness_of_the_rest(
    formula: Formula, seed: int, longest: int, convention: Convention
) -> None:
    assert faults(formula, random_batch(seed, 1, longest, ties=seed % 2 == 0), convention) == []


@settings(max_examples=some(100), deadline=None, derandomize=True)
@given(formulas, st.integers(0, 10**6), conventions)
def test_data_says_what_the_signal_says(formula: Formula, seed: int, convention: Convention) -> None:
    """Infinite bounds are null; verdicts say of which sign they are."""
    found = observe_samples("it", formula, random_batch(seed, 1, 9), convention, with_signal=True).signal
    assert found is not None
    data = signal_data(found)
    for k, truth in enumerate(data.verdicts):
        low, high = data.low[k], data.high[k]
        assert found.low[k] == (low if low is not None else np.inf if truth == "true" else -np.inf)
        assert found.high[k] == (high if high is not None else -np.inf if truth == "false" else np.inf)
    known = [low for low, high in zip(found.low, found.high, strict=True) if low == high and isfinite(low)]
    assert (data.least.value if data.least else None) == min(known, default=None)
    for sign, spans in ((1, data.positive), (-1, data.negative)):
        inside = [any(a <= x <= (b or 0.0) for a, b in spans) for x in np.round(found.times, 9)]
        assert inside == [x == sign for x in found.signs()]


def only_strong(margin: Margin, answer: object, dt: object) -> RobustnessSignal:
    return margin_signal.recorded_signal(Margin(margin.low, margin.low), answer, dt)  # type: ignore[arg-type]


def one_late(margin: Margin, answer: object, dt: object) -> RobustnessSignal:
    moved = Margin(np.roll(margin.low, 1, axis=0), np.roll(margin.high, 1, axis=0))
    return margin_signal.recorded_signal(moved, answer, dt)  # type: ignore[arg-type]


@pytest.mark.parametrize("fault", [only_strong, one_late])
def test_planted_faults_are_noticed(fault: object, monkeypatch: pytest.MonkeyPatch) -> None:
    formula = f.Or((f.Eventually(interval(1, 3), IN_LANE), f.Not(ON_MAIN)))
    batch = random_batch(6, 1, 9)
    assert faults(formula, batch, "truncated") == []
    monkeypatch.setattr(observed, "recorded_signal", fault)
    assert faults(formula, batch, "truncated") != []


def test_signs_are_those_of_bounds() -> None:
    signal = RobustnessSignal(
        random_batch(1, 1, 1).dt,
        (1.0, -2.0, 0.0, -1.0),
        (2.0, -1.0, 0.0, 0.0),
        ("true",) * 4,
        1,  # type: ignore[arg-type]
    )
    assert signal.signs() == (1, -1, 0, None)


# --- The command and Python ---------------------------------------------------------------------------


def test_command_and_python_agree(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    asked = ["monitor", "danger(SV,POV)", str(DRIVE), "--view", "recorded", "--robust-signal"]
    main([*asked, "--json", "-", "--picture", str(tmp_path / "signal.svg")])
    told = json.loads(capsys.readouterr().out)["robust_signal"]
    made = rp.monitor("danger(SV,POV)", str(DRIVE), view="recorded", robust_signal=True).robust_signal
    assert made is not None
    assert told["times"] == list(made.times)
    assert told["low"] == [x if isfinite(x) else None for x in made.low]
    assert told["verdicts"] == list(made.truths)
    assert "robustness" in (tmp_path / "signal.svg").read_text("utf-8")
    assert rp.monitor("danger(SV,POV)", str(DRIVE)).robust_signal is None
    frame = made.to_frame()
    assert frame.columns == ["time", "low", "high", "verdict"]


def test_without_the_option_answers_are_as_before(capsys: pytest.CaptureFixture[str]) -> None:
    main(["monitor", "danger(SV,POV)", str(DRIVE), "--json", "-"])
    assert "robust_signal" not in json.loads(capsys.readouterr().out)


def test_pieces_in_json_are_the_function(capsys: pytest.CaptureFixture[str]) -> None:
    main(["monitor", "rssViolation(SV,POV)", str(DRIVE), "--robust-signal", "--json", "-"])
    told = json.loads(capsys.readouterr().out)["robust_signal"]
    assert told["exact"] is True
    assert "sampled" not in told
    for time, low in zip(told["times"], told["low"], strict=True):
        piece = [x for x in told["pieces"] if x["begin"] <= time][-1]
        value = sum(eval(x) * time**k for k, x in enumerate(piece["coefficients"]))
        assert value == pytest.approx(low, abs=1e-6)
