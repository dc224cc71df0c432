"""Mistakes are told in Python as on the command line, by the same errors and exit codes."""

from collections.abc import Callable
from pathlib import Path

import pytest

import roadproof as rp
from api.doors import tell

BOTH: dict[str, tuple[Callable[[], object], list[str], type[rp.RoadproofError]]] = {
    "text": (lambda: rp.prove("danger(SV,POV"), ["prove", "danger(SV,POV"], rp.TextError),
    "name": (lambda: rp.witness("dangr(SV,POV)"), ["witness", "dangr(SV,POV)"], rp.TextError),
    "unit": (lambda: rp.compare("s(SV) > 3 s", "4"), ["compare", "s(SV) > 3 s", "4"], rp.TextError),
    "property": (lambda: rp.prove("P99"), ["prove", "P99"], rp.UsageError),
    "mixed": (lambda: rp.prove("P1", "danger(SV,POV)"), ["prove", "P1", "danger(SV,POV)"], rp.UsageError),
    "unstated": (
        lambda: rp.prove("P4", using=rp.load("complete")),
        ["prove", "P4", "--set", "complete"],
        rp.UsageError,
    ),
    "scenario": (lambda: rp.prove(99), ["prove", "99"], rp.InputError),
    "set": (lambda: rp.witness(4, using=rp.load("bse")), ["witness", "4", "--set", "bse"], rp.InputError),
    "road": (lambda: rp.witness(4, road="moon"), ["witness", "4", "--road", "moon"], rp.InputError),
    "vehicle": (lambda: rp.witness(4, vehicles="tram"), ["witness", "4", "--vehicle", "tram"], rp.InputError),
    "lane": (lambda: rp.witness(4, lanes={"L": "x"}), ["witness", "4", "--lane", "x"], rp.UsageError),
    "solver": (lambda: rp.witness(4, solver="x"), ["witness", "4", "--solver", "x"], rp.UsageError),
    "dt": (
        lambda: rp.witness(4, horizon=1, dt=1),
        ["witness", "4", "--horizon", "1", "--dt", "1"],
        rp.UsageError,
    ),
    "one scenario": (lambda: rp.overlap("4"), ["overlap", "--among", "4"], rp.UsageError),
    "no range": (lambda: rp.order("x"), ["order", "--among", "x"], rp.UsageError),
    "no scenario": (lambda: rp.redundancy("99"), ["redundancy", "--among", "99"], rp.InputError),
    "no class": (lambda: rp.classify("99"), ["classify", "--among", "99"], rp.InputError),
    "wider": (
        lambda: rp.coverage(rp.load("ext"), wider="base"),
        ["coverage", "--set", "ext", "--wider", "base"],
        rp.UsageError,
    ),
    "nothing to explore": (lambda: rp.explore(4), ["explore", "4"], rp.UsageError),
    "knob": (
        lambda: rp.explore(4, vary={"x": (0, 1)}),
        ["explore", "4", "--vary", "x=0:1"],
        rp.RoadproofError,
    ),
    "term": (lambda: rp.explore(4, least="v("), ["explore", "4", "--least", "v("], rp.TextError),
    "no trace": (lambda: rp.monitor(4, "x.txt"), ["monitor", "4", "x.txt"], rp.InputError),
    "no file": (lambda: rp.monitor(4, "x.csv"), ["monitor", "4", "x.csv"], rp.InputError),
    "no drive": (lambda: rp.monitor(4, "x.json"), ["monitor", "4", "x.json"], rp.InputError),
    "no recordings": (lambda: rp.evaluate("x"), ["evaluate", "x", "--out", "out"], rp.InputError),
    "no evidence": (lambda: rp.check("x"), ["check", "x"], rp.InputError),
}


@pytest.mark.parametrize("name", BOTH)
def test_the_same_words_through_both_doors(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ask, line, kind = BOTH[name]
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kind) as raised:
        ask()
    code, printed, complaints = tell(line)
    assert f"roadproof: {raised.value}\n" == complaints
    assert (code, printed) == (raised.value.exit_code, "")


def test_a_caret_shows_where() -> None:
    with pytest.raises(rp.TextError) as raised:
        rp.witness("F danger(SV, POV) and dangr(SV, POV)")
    assert str(raised.value).splitlines()[1:] == [
        "  F danger(SV, POV) and dangr(SV, POV)",
        "                        ^",
    ]
    assert "did you mean 'danger'" in str(raised.value)
    position = raised.value.position
    assert position is not None
    assert (position.line, position.column) == (1, 23)


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: rp.prove(4, engine="x"), "engine='x': write 'dense' or 'smt' or 'milp'"),
        (lambda: rp.prove(4, expect="x"), "expect='x': write 'PROVED' or 'REFUTED'"),
        (lambda: rp.prove("P4", engine="smt"), "engine='smt' requires claims of your own"),
        (lambda: rp.prove(4, effort=0), "effort=0: write a number greater than 0"),
        (lambda: rp.prove("P4", jobs=0), "--jobs 0 must be greater than 0"),
        (lambda: rp.witness(4, engine="x"), "engine='x': write 'milp' or 'smt'"),
        (lambda: rp.witness(4, objective="x"), "objective='x': write 'any' or 'smooth'"),
        (lambda: rp.witness(4, count=0), "count=0: write a whole number greater than 0"),
        (lambda: rp.witness(4, horizon=-1), "horizon=-1: write a number greater than 0"),
        (lambda: rp.compare(3, 4, timeout=-1), "timeout=-1: write a number greater than 0"),
        (lambda: rp.compare(3, 4, rp.load("base", "extA", "ext")), "two formulas have at most two"),
        (lambda: rp.overlap("3,4", lanes="x"), "lanes='x': write 'same' or 'any'"),
        (
            lambda: rp.overlap("3,4", rp.load("base", "extA", "ext")),
            "name one spec set, or two different",
        ),
        (
            lambda: rp.explore(4, vary={"minDanger": (0, 1)}, steps=1),
            "--steps 1: write a number from 2 to 201",
        ),
        (lambda: rp.monitor(4, "x.csv", view="x"), "view='x': write 'dense' or 'recorded'"),
        (lambda: rp.monitor(4, "x.csv", view="dense"), "other traces have samples only"),
        (lambda: rp.monitor(4, "x.csv", end="x"), "end='x': write 'truncated' or 'clip'"),
        (lambda: rp.evaluate("x", end="x"), "end='x': write 'truncated' or 'clip'"),
        (lambda: rp.simulate("x", recordings=0), "recordings=0: write 1 to 999"),
        (lambda: rp.simulate("x", seed=-1), "seed=-1: a seed is 0 or more"),
        (lambda: rp.simulate("x", lanes=9), "simulate: lanes=9 must lie between 2 and 4"),
        (lambda: rp.check("x", solver="x"), "solver='x': write 'z3' or 'cvc5'"),
    ],
)
def test_choices_that_are_none(ask: Callable[[], object], told: str) -> None:
    with pytest.raises(rp.UsageError) as raised:
        ask()
    assert told in str(raised.value)
