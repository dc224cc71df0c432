"""The examples in Python: scripts are run by their README (tests/cli/test_book.py), the notebook here."""

import ast
import json
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from console import sessions_of

HERE = Path(__file__).parents[2] / "examples/python"
SCRIPTS = sorted(HERE.glob("*.py"))
NOTEBOOK = HERE / "first_steps.ipynb"


def test_the_page_runs_every_script() -> None:
    sessions = sessions_of((HERE / "README.md").read_text("utf-8"))
    assert {x.command for x in sessions} == {f"python {script.name}" for script in SCRIPTS}
    assert all(len(x.expected) > 5 for x in sessions)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda x: x.stem)
def test_scripts_are_short(script: Path) -> None:
    source = script.read_text("utf-8")
    assert len(source.splitlines()) <= 60
    assert ast.get_docstring(ast.parse(source))


def cells() -> list[dict[str, Any]]:
    notebook: dict[str, Any] = json.loads(NOTEBOOK.read_text("utf-8"))
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    found: list[dict[str, Any]] = notebook["cells"]
    return found


def test_the_notebook_is_well_formed() -> None:
    assert len({cell["id"] for cell in cells()}) == len(cells())
    for cell in cells():
        code = cell["cell_type"] == "code"
        expected = {"cell_type", "id", "metadata", "source"} | (
            {"execution_count", "outputs"} if code else set()
        )
        assert {*cell} == expected
        assert not code or (cell["execution_count"], cell["outputs"]) == (None, [])


def test_the_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    space: dict[str, Any] = {}
    shown: dict[str, Any] = {}
    for cell in cells():
        if cell["cell_type"] == "code":
            *lines, last = ast.parse("".join(cell["source"])).body
            exec(compile(ast.Module(lines, []), cell["id"], "exec"), space)
            if isinstance(last, ast.Expr):
                shown[cell["id"]] = eval(compile(ast.Expression(last.value), cell["id"], "eval"), space)
            else:
                exec(compile(ast.Module([last], []), cell["id"], "exec"), space)
    assert [*shown["prove"].verdicts.values()] == [rp.Verdict.PROVED, rp.Verdict.REFUTED]
    assert all(shown[name].png.startswith(b"\x89PNG") for name in ("refuted", "witness", "heat-map"))
    assert shown["monitor"]["verdict"][0] == "true"
    assert shown["overlap"]["verdict"].to_list() == ["WITNESSED"]
    assert all({*map(str, counts)} == {"accepted"} for counts in shown["check"])


def test_the_notebook_runs_as_readers_run_it(tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, resources={"metadata": {"path": str(tmp_path)}}).execute()
