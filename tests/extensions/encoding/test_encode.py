"""Encodings in Python: problems of cvxpy with own objectives, whose drives are judged."""

import ast
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import roadproof as rp
from console import agree
from pages import examples_of, run
from roadproof.errors import InputError, UsageError
from roadproof.extensions.encoding.encode import Encoding
from roadproof.world.motion import state_at


@pytest.fixture(scope="module")
def encoding() -> Encoding:
    return rp.encode(4, lanes={"L": "main-1"})


def test_an_own_objective_and_an_own_bound_are_kept(encoding: Encoding) -> None:
    import cvxpy as cp

    speed, acceleration = encoding.variable("SV", "v_lon"), encoding.variable("SV", "a_lon")
    assert speed.shape == encoding.times.shape == (11,)
    assert acceleration.shape == (10,)
    bound = acceleration >= -3
    problem = cp.Problem(cp.Minimize(cp.max(speed)), [*encoding.problem().constraints, bound])
    problem.solve(solver="HIGHS", mip_rel_gap=0.1)
    drive = encoding.drive()
    motion = drive.file.drive.vehicles["SV"]
    sampled = [float(state_at(motion, k * encoding.posed.question.grid.dt).v_lon) for k in range(11)]
    assert np.allclose(sampled, speed.value, atol=1e-3)
    assert min(float(x.a_lon) for x in motion.pieces) >= -3.01
    assert drive.file.formula == "scenario_4(SV, POV, L)"
    free = cp.Problem(cp.Maximize(cp.min(speed)), encoding.problem().constraints)
    free.solve(solver="HIGHS", mip_rel_gap=0.1)
    assert max(speed.value) > max(sampled) + 1


def test_constraints_are_named_by_what_they_encode(encoding: Encoding) -> None:
    assert {"motion.SV", "jump.POV", "clearance.POV.SV", "dangerAhead"} <= {*encoding.constraints}
    assert repr(encoding) == "<Encoding of scenario_4(SV, POV, L): L=main-1, 88 unknowns, 240 choices>"


def test_without_a_kind_of_constraint_the_drive_is_refused(encoding: Encoding) -> None:
    import cvxpy as cp

    kept = [x for name, some in encoding.constraints.items() if name != "motion.SV" for x in some]
    problem = cp.Problem(cp.Minimize(encoding.variable("SV", "s")[10]), kept)
    problem.solve(solver="HIGHS", mip_rel_gap=0.5)
    with pytest.raises(InputError, match=r"row motion\.SV@"):
        encoding.drive()


def test_unknown_names_are_refused(encoding: Encoding) -> None:
    with pytest.raises(UsageError, match="vehicle=X: the problem has POV, SV"):
        encoding.variable("X", "s")
    with pytest.raises(UsageError, match="signal=j_lon: write s, d"):
        encoding.variable("SV", "j_lon")
    with pytest.raises(UsageError, match="solve a problem first"):
        rp.encode(5).drive()


# --- The worked examples ------------------------------------------------------------------------------

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples/encoding"


def test_the_notebook_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLE))
    notebook = json.loads((EXAMPLE / "own_objectives.ipynb").read_text("utf-8"))
    space: dict[str, Any] = {}
    shown: dict[str, Any] = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            *lines, last = ast.parse("".join(cell["source"])).body
            exec(compile(ast.Module(lines, []), cell["id"], "exec"), space)
            assert isinstance(last, ast.Expr)
            shown[cell["id"]] = eval(compile(ast.Expression(last.value), cell["id"], "eval"), space)
    sys.modules.pop("trade_off", None)
    assert shown["drive"] == shown["cost"][0] == "scenario_4(SV, POV, L)"
    assert 0 <= shown["least"] < 3
    assert shown["cost"][1] < 0.01
    assert shown["curve"] == [(60, 0.8), (75, 1.2)]


def test_the_page_types_in_what_it_says(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    examples = [*examples_of((ROOT / "docs/explanation/encoding.md").read_text("utf-8"))]
    assert len(examples) == 8
    for example in examples:
        assert agree(run(example, names), example.expected), example
