"""What the fuzz once found stays found; a few cases of each reader; and faults that it notices."""

import importlib
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import Phase, find, settings

from extensions.kernel.needs import needs_coq
from extensions.kernel.raw import random_formula
from fuzz import case, claims, drives, held, printed, search, steps, texts, truths
from fuzz.run import READERS, run
from roadproof.engines.encode import unroll
from roadproof.engines.search import question
from roadproof.extensions.kernel.printer import Printer
from roadproof.logic import formula as f
from roadproof.logic import show
from roadproof.logic import terms as t
from roadproof.semantics.exact import judging, signals, truth
from roadproof.semantics.sampled import lattice

FOUND = sorted(case.FOUND.glob("*.txt"))
FEW = {"held": 160, "truths": 10, "drives": 25, "claims": 80, "search": 2, "texts": 25}
FEW |= {"printed": 1000, "steps": 1000}


def test_what_was_found_is_mended() -> None:
    for path in FOUND:
        reader, kept = case.load(path)
        importlib.import_module(f"fuzz.{reader}").check(kept)


COQS = {"printed", "steps"}


@pytest.mark.parametrize("reader", [pytest.param(x, marks=needs_coq) if x in COQS else x for x in READERS])
def test_readers_agree_on_a_few(reader: str, tmp_path: Path) -> None:
    counted = run(importlib.import_module(f"fuzz.{reader}"), FEW[reader], 1, tmp_path)
    assert counted.pairs >= FEW[reader]
    assert counted.found == ()


def test_a_case_is_read_back_from_its_file(tmp_path: Path) -> None:
    for reader in (held, truths, drives, texts):
        kept = find(reader.cases, lambda _: True, settings=settings(database=None, phases=[Phase.generate]))
        path = case.save("name", case.Disagreement("two say\ndifferent things", kept), tmp_path)
        assert case.load(path) == ("name", kept)
        assert path.read_text().startswith("# two say different things\n")


def classic_until(left, low, high, right):
    """Asks for its left side from 0 on."""
    start = truth.always(Fraction(0), low, left) if low > 0 else truth.ALWAYS
    return truth.intersection([start, truth.until(left, low, high, right)])


def full_square(name, x):
    """a·t² for a/2·t²."""
    doubled = replace(x, a_lon=2 * x.a_lon, a_lat=2 * x.a_lat) if name in ("s", "d") else x
    return TRUE_COURSE(name, doubled)


TRUE_COURSE = signals.signal_polynomial
STRICT = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
FAULTS = {
    "held: until asks for its left side too early": (held, judging, "until", classic_until),
    "held: not keeps the view": (held, lattice, "OPPOSITE", {view: view for view in lattice.View}),
    "held: strictness is lost": (held, unroll, "NEGATED", STRICT),
    "truths: until asks for its left side too early": (truths, judging, "until", classic_until),
    "drives: a square too large": (drives, signals, "signal_polynomial", full_square),
    "claims: or is and": (claims, judging, "union", truth.intersection),
    "texts: a difference binds like a product": (texts, show, "_LEVEL", {**show._LEVEL, "-": show.PRODUCT}),
    "search: all starts are at 0": (search, question, "starting_range", lambda *_: None),
}


SEEDS = {"held: until asks for its left side too early": 4, "claims: or is and": 4}
"""With which a fault is found sooner."""


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found_and_kept(fault: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    reader, owner, name, wrong = FAULTS[fault]
    monkeypatch.setattr(owner, name, wrong)
    path = run(reader, 4000, SEEDS.get(fault, 1), tmp_path, 1).found[0]
    kept = case.load(path)[1]
    with pytest.raises(case.Disagreement):
        reader.check(kept)
    monkeypatch.undo()
    assert reader.check(kept) >= 0


@needs_coq
def test_coq_notices_faults_of_printer_and_judge(monkeypatch: pytest.MonkeyPatch) -> None:
    """As the readers ``printed`` and ``steps`` do, on one formula, since they are slow to find one."""
    trace = held.plain(held.random_trace(1))
    later = f.Interval(*[t.Number(held.DT, held.SECONDS)] * 2)
    one = [(f.Until(f.Compare(t.Size("width", "SV"), "<", t.number(0)), later, f.TRUE), [trace])]
    assert steps.check(one) == 1
    monkeypatch.setattr(judging, "until", classic_until)
    with pytest.raises(case.Disagreement, match="Coq says true, the judge False"):
        steps.check(one)
    monkeypatch.undo()
    strict = next(seed for seed in range(99) if " < " in Printer().formula(random_formula(seed)))
    formula = Printer.formula
    monkeypatch.setattr(Printer, "formula", lambda *asked: formula(*asked).replace(" < ", " <= "))
    with pytest.raises(case.Disagreement, match="another formula"):
        printed.check((strict,))
