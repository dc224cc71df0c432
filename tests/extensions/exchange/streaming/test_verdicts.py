"""Monitors in C say what the monitor says, on every sample of every trace."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from examples import some
from extensions.exchange.streaming.c_programs import (
    SANITIZED,
    STRICT,
    UNKNOWN,
    answers,
    build,
    differences,
    needs_compiler,
    samples_of,
)
from extensions.exchange.streaming.random_formulas import random_formula
from extensions.traffic.monitoring.cases import DT, interval, random_batch
from roadproof.errors import InputError
from roadproof.extensions.exchange.streaming.c_files import CSource, compile_c
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled import Batch, compile

pytestmark = needs_compiler
OWN = """
signal jerk(a: vehicle): m/s^3 in [-10, 10]
signal red: bool
signal int: bool
def stops(a: vehicle) := red and not int and jerk(a) < 0 and not is_truck(a)
def is_truck(a: vehicle) := kind(a) = truck
"""


def _compiled(some: Mapping[str, Formula]) -> CSource:
    return compile_c({name: (name, formula) for name, formula in some.items()}, DT, "monitor", 65_536)


def _random(seed: int, count: int = 25) -> CSource:
    """Monitors of random formulas, without those that are refused."""
    rng, kept = np.random.default_rng(seed), dict[str, Formula]()
    for k in range(count):
        formula = random_formula(rng, int(rng.integers(2, 6)))
        try:
            _compiled({"it": formula})
        except InputError:
            continue
        kept[f"formula_{k}"] = formula
    assert len(kept) > count / 2
    return _compiled(kept)


@pytest.mark.parametrize("seed", range(some(12, least=4)))
def test_random_formulas_on_random_traces(seed: int, tmp_path: Path) -> None:
    source = _random(seed)
    program = build(source, tmp_path, (*STRICT, f"-O{seed % 4}"))
    for longest, traces in ((4, 30), (30, 20), (110, 3)):
        batch = random_batch(seed, traces, longest)
        assert list(differences(source, program, batch)) == []


def test_no_memory_is_left_nor_any_value_undefined(tmp_path: Path) -> None:
    source = _random(99, 12)
    program = build(source, tmp_path, SANITIZED)
    assert list(differences(source, program, random_batch(99, 20, 90))) == []


EDGES = (1, 63, 64, 127)
"""Widths of windows near those of words."""


def test_windows_at_the_edges_of_words(tmp_path: Path) -> None:
    leaf = f.Compare(t.Signal("s", "SV"), ">", t.number(-1))
    other = f.Compare(t.Signal("s", "POV"), ">", t.number(0))
    made: dict[str, Formula] = {}
    for width in EDGES:
        window, later = interval(0, width), interval(width, 0)
        below = f.Until(leaf, f.FOREVER, f.Not(other))
        made[f"until_{width}"] = f.Until(leaf, window, f.Not(leaf))
        made[f"table_{width}"] = f.Until(leaf, window, f.And((other, below)))
        made[f"late_{width}"] = f.And((leaf, f.Or((other, f.Eventually(later, f.Not(leaf))))))
        made[f"always_{width}"] = f.Always(window, f.Or((leaf, f.Always(f.FOREVER, other))))
    source = _compiled(made)
    program = build(source, tmp_path, SANITIZED)
    batch = random_batch(7, 6, 200)
    rare = np.random.default_rng(7).random((200, 6)) < 0.99
    signals = {key: np.where(rare, 1.0, -1.5) for key in batch.signals}
    assert list(differences(source, program, replace(batch, signals=signals))) == []


# --- Samples that are rejected ----------------------------------------------------------------------

GOOD = {"jerk_SV": 0.0, "red": 0.0, "int": 0.0, "s_SV": 0.0, "s_POV": 0.0, "length_SV": 4.0, "kind_SV": 1.0}


def _batch(values: Mapping[str, float]) -> Batch:
    """Four samples; signals are what is given in the third of them, and sizes at all times."""
    signals, sizes = {}, {}
    for name, usual in GOOD.items():
        signal, vehicle = name.rsplit("_", 1) if "_" in name else (name, "")
        value = values.get(name, usual)
        if signal in ("length", "kind"):
            sizes[signal, vehicle] = np.array([value])
        else:
            signals[signal, vehicle] = np.array([[usual], [usual], [value], [usual]])
    return Batch(DT, np.array([4]), signals, sizes)


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> tuple[CSource, Path]:
    """Formulas with custom signals, a kind, a quotient by a size, an inverse and a maximum."""
    home = rp.load(specs=[OWN])
    formulas = (
        "stops(SV)",
        "max(s(SV)/length(SV), s(POV)^3/length(SV)^3) < 5",
        "inverse(s(SV)) >= 0 and not (s(POV) > 3 m)",
    )
    source = rp.compile(formulas, using=home).source
    return source, build(source, tmp_path_factory.mktemp("asked"), SANITIZED)


@pytest.mark.parametrize(
    "good",
    [{}, {"red": 1.0, "jerk_SV": -10.0}, {"kind_SV": 2.0}, {"s_SV": 5e-324}, {"s_POV": 1e102}],
)
def test_good_samples_are_accepted(good: dict[str, float], asked: tuple[CSource, Path]) -> None:
    assert list(differences(*asked, _batch(good))) == []


@pytest.mark.parametrize(
    ("name", "value", "where"),
    [
        ("jerk_SV", 11.0, 0),
        ("jerk_SV", -10.5, 0),
        ("jerk_SV", float("nan"), 0),
        ("kind_SV", 0.0, 0),
        ("length_SV", -4.0, 1),
        ("length_SV", 1e-320, 1),
        ("s_POV", 1e103, 1),
        ("s_POV", float("nan"), 2),
        ("s_POV", float("inf"), 2),
        ("s_SV", float("nan"), 2),
    ],
)
def test_wrong_samples_are_rejected_for_good(
    name: str, value: float, where: int, asked: tuple[CSource, Path]
) -> None:
    source, program = asked
    monitor = source.monitors[where]
    with pytest.raises(InputError):
        compile({"it": monitor.plan.formula}).evaluate(_batch({name: value, "s_SV": 1.0} | {name: value}))
    samples = samples_of(source, _batch({"s_SV": 1.0}), 0)
    samples[name][2] = value
    found = answers(source, program, [samples])[monitor.identifier][:, 0, 0].tolist()
    assert UNKNOWN not in found[:2]
    assert found[2:] == [UNKNOWN, UNKNOWN]
