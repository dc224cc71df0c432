"""What is read of a solver's answer, and which solver is asked."""

import sys
from fractions import Fraction

import pytest

from roadproof.engines.solve.smt import Session, ask, parse_sexpression, read_value, solve
from roadproof.errors import MissingSolverError
from roadproof.runtime.budget import Effort

SCRIPT = "(declare-const x Real)(assert (> x 1.0))(check-sat)"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("false", False),
        ("(- 2.5)", Fraction(-5, 2)),
        ("(/ (- 1.0) 3.0)", Fraction(-1, 3)),
        ("(- (/ 1.0 3.0))", Fraction(-1, 3)),
        ("(root-obj (+ (^ x 2) (- 2)) 2)", None),
        ("(- (root-obj (+ (^ x 2) (- 2)) 2))", None),
        ("(/ (root-obj (+ (^ x 2) (- 2)) 2) 2.0)", None),
        ("(/ 2.0 (root-obj (+ (^ x 2) (- 2)) 2))", None),
    ],
)
def test_values(text: str, value: Fraction | bool | None) -> None:
    (read,) = parse_sexpression(f"({text})")
    assert read_value(read) == value


def test_a_value_that_is_not_rational_is_left_out() -> None:
    told = "(declare-const x Real)(declare-const p Bool)(assert (and p (< x 0.0) (= (* x x) 2.0)))"
    session = Session()
    session.tell(told)
    assert session.check() == "sat"
    assert session.values(["x", "p", "(* x x)"]) == [None, True, Fraction(2)]
    assert solve(f"{told}(check-sat)", ["x", "p"], Effort().meter()) == {"p": True}


def test_z3_needs_no_other_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cvc5", None)
    assert ask(SCRIPT) == ask(SCRIPT, "z3") == "sat"
    with pytest.raises(MissingSolverError, match="solver=cvc5 is not installed"):
        ask(SCRIPT, "cvc5")


def test_cvc5_is_asked_where_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Session, "answer", None)
    assert ask(SCRIPT, "cvc5") == "sat"
