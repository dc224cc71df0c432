"""All readers of formulas say the same of random formulas with every operator."""

import pytest

from examples import some
from extensions.exchange.streaming.c_programs import needs_compiler
from operators import agreement, readers, rtamt_text
from operators.cases import ATOMS, case
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact import judging, truth

COUNT = some(800, least=150)


def differences(count: int) -> dict[str, int]:
    """Return how many verdicts of each reader differ on the first formulas."""
    wrong: dict[str, int] = {}
    for number in range(count):
        for reader, _, different in agreement.compared(number):
            wrong[reader] = wrong.get(reader, 0) + different
    return wrong


def test_readers_in_python_agree() -> None:
    assert differences(COUNT) == dict.fromkeys(list(agreement.PAIRS)[:4], 0)


@needs_compiler
def test_monitors_in_c_agree() -> None:
    formulas, verdicts, wrong = agreement.in_c(range(some(100)))
    assert (wrong, formulas > 20, verdicts > 100) == (0, True, True)


@pytest.mark.skipif(not rtamt_text.PYTHON, reason="rtamt is not installed: name ROADPROOF_RTAMT_PYTHON")
def test_rtamt_agrees() -> None:
    formulas, verdicts, wrong = agreement.in_rtamt(range(COUNT))
    assert (wrong, formulas > 50, verdicts > 300) == (0, True, True)


def test_a_fault_in_the_judge_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = truth.since
    monkeypatch.setattr(judging, "since", lambda left, low, high, reached: right(left, low, None, reached))
    assert differences(60)["exact judge"] > 0


def test_the_judge_differs_from_samples_only_where_a_since_begins_before_a_sample() -> None:
    """The difference that docs/reference/language.md names: without ``for_steps`` it shows."""
    formula: Formula = f.Since(ATOMS["P"], f.FOREVER, ATOMS["Q"])
    batches = [case(number)[1] for number in range(20)]
    assert all(readers.judged(formula, x) == readers.lasting(readers.for_steps(formula), x) for x in batches)
    assert any(readers.judged(formula, x) != readers.lasting(formula, x) for x in batches)
