"""Problems as files: they are what the search solves, other solvers solve them, and every row has a name."""

import csv
import io
import re
import tempfile
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import highspy
import numpy as np
import pytest

import roadproof as rp
from roadproof.engines.encode.problem import LimitKind
from roadproof.engines.solve.highs import MixedIntegerProgram, model_text
from roadproof.errors import InputError, UsageError
from roadproof.extensions.encoding import judging
from roadproof.extensions.encoding.encode import Encoding
from roadproof.extensions.encoding.judging import NoWitnessError, columns_of, judged
from roadproof.extensions.encoding.naming import WHOLE, Naming, QuestionPart
from roadproof.extensions.encoding.row_table import CONDITIONS
from roadproof.extensions.encoding.solutions import parse_solution
from roadproof.frontends.cli.main import main

BASE, EXT = rp.load("base"), rp.load("ext")
LANE = {"L": "main-1"}
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_.]*@\d+(\.\d+)?")


def encoded(number: int | str = 4, **options: object) -> Encoding:
    return rp.encode(number, **{"lanes": LANE, **options})


def read_model(tmp_path: Path, encoding: Encoding, to: str) -> highspy.HighsLp:
    path = tmp_path / f"model.{to}"
    path.write_text(encoding.text(to))
    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    assert solver.readModel(str(path)) == highspy.HighsStatus.kOk
    return solver.getLp()


def matrix_of(lp: highspy.HighsLp) -> dict[tuple[str, str], float]:
    """The entries of a matrix by the names of their row and column."""
    a, entries = lp.a_matrix_, {}
    outer, inner = (lp.col_names_, lp.row_names_), a.format_ == highspy.MatrixFormat.kColwise
    for k in range(len(a.start_) - 1):
        for place in range(a.start_[k], a.start_[k + 1]):
            row, column = (a.index_[place], k) if inner else (k, a.index_[place])
            entries[outer[1][row], outer[0][column]] = a.value_[place]
    return entries


@pytest.mark.parametrize("to", ["mps", "lp"])
def test_a_file_is_the_program_that_the_search_solves(tmp_path: Path, to: str) -> None:
    encoding = encoded()
    naming = Naming(encoding.posed)
    program = encoding.posed.program.program
    lp = read_model(tmp_path, encoding, to)
    assert [*lp.col_names_] == [*naming.columns] if to == "mps" else {*lp.col_names_} == {*naming.columns}
    names = [name for name, _ in naming.rows]
    bounds = {n: x for n, *x in zip(lp.col_names_, lp.col_lower_, lp.col_upper_, strict=True)}
    for name, ends in zip(naming.columns, program.box, strict=True):
        assert np.allclose(bounds[name], ends, rtol=1e-12, atol=1e-12)
    made: dict[tuple[str, str], float] = {}
    for row, column, value in zip(program.rows, program.columns, program.values, strict=True):
        key = (names[row], naming.columns[column])
        made[key] = made.get(key, 0.0) + value
    read = matrix_of(lp)
    if to == "lp":  # a row with two bounds is two rows there
        read = {(re.sub(r"(lo|up)$", "", row), column): x for (row, column), x in read.items()}
    assert {k: x for k, x in made.items() if x} == pytest.approx(read, rel=1e-12)
    whole = {n for n, kind in zip(lp.col_names_, lp.integrality_, strict=True) if kind.name == "kInteger"}
    assert whole == {naming.columns[k] for k in program.binaries}


def named_everywhere(encoding: Encoding) -> set[str]:
    """Check the names of all columns and rows of a problem; return the kinds of its rows."""
    naming = Naming(encoding.posed)
    names = [*naming.columns, *(name for name, _ in naming.rows)]
    assert len(names) == len({*names})
    assert [x for x in names if not NAME.fullmatch(x)] == []
    kinds = set()
    for name, part in naming.rows:
        inside = part.name != WHOLE
        assert inside or encoding.posed.query.text.startswith(("F", "given")), f"{name} encodes nothing"
        kinds.add(part.name.partition(".")[0] if part.limit else "comparison")
    return kinds


def test_every_column_and_row_has_a_name() -> None:
    limits = {"motion", "acceleration", "lateral_share", "jump", "clearance", "lane", "one_way"}
    assert named_everywhere(encoded()) == {*limits, "comparison"}
    ramp = named_everywhere(rp.encode(9, drives="all"))
    assert "road" in ramp
    third = "given C: vehicle: F (v_lon(SV) > v_lon(POV) and v_lon(POV) > v_lon(C))"
    assert "reach" in named_everywhere(rp.encode(third))


def test_conditions_of_limits_are_complete() -> None:
    assert {*CONDITIONS} == {*LimitKind}


def test_the_table_says_where_each_row_is_written(tmp_path: Path) -> None:
    made = rp.compile(4, to="mps", out=tmp_path, lanes=LANE)
    assert {x.name for x in tmp_path.iterdir()} == {*made.files} == {"scenario_4.mps", "scenario_4.rows.csv"}
    rows = [*csv.DictReader(io.StringIO((tmp_path / "scenario_4.rows.csv").read_text()))]
    declared = {*re.findall(r"^ [ELG]\s+(\S+)", made.files["scenario_4.mps"], re.M)}
    assert {x["row"] for x in rows} == declared
    sets = Path(rp.__file__).parent / "library/sets"
    for x in rows:
        if x["file"]:
            line = (sets / x["file"]).read_text().splitlines()[int(x["line"]) - 1]
            assert f"def {x['part']}(" in line.replace("{i}", "4")
            assert x["within"].split(" / ")[0] == "scenario_4"
            assert x["within"].split(" / ")[-1] == x["part"]
        else:
            assert x["condition"] in CONDITIONS.values() or x["row"].startswith("choose.")


# --- Solutions that are none ------------------------------------------------------------------------


@pytest.fixture(scope="module")
def solution() -> tuple[Naming, dict[str, Fraction]]:
    """A problem and a solution of it, choices included."""
    encoding = encoded()
    posed = encoding.posed
    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    naming = Naming(posed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.mps"
        path.write_text(encoding.text("mps"))
        solver.readModel(str(path))
    solver.run()
    values = solver.getSolution().col_value
    return naming, {name: Fraction(x) for name, x in zip(solver.getLp().col_names_, values, strict=True)}


def as_text(values: dict[str, Fraction]) -> str:
    return "# Objective value = 0\n" + "".join(f"{name} {float(x)!r}\n" for name, x in values.items())


def test_each_kind_of_row_is_checked(solution: tuple[Naming, dict[str, Fraction]]) -> None:
    """A solution of the program without the rows of one kind is refused by a row of that kind."""
    naming, _ = solution
    program = naming.posed.program.program
    rng = np.random.default_rng(1)
    for kind in sorted({kind_of(part) for _, part in naming.rows}):
        rows = [k for k, (_, part) in enumerate(naming.rows) if kind_of(part) == kind]
        assert any(refused_by(naming, values) == kind for values in without(naming, program, rows, rng)), kind


def can_break(program: MixedIntegerProgram, row: int) -> bool:
    """Whether values within the bounds of the columns break a row."""
    inside = program.rows == row
    ends = program.values[inside, None] * program.box[program.columns[inside]]
    return ends.min(1).sum() < program.low[row] - 1e-3 or ends.max(1).sum() > program.high[row] + 1e-3


def kind_of(part: QuestionPart) -> str:
    return "comparison" if part.limit is None else part.name.partition(".")[0]


def without(naming: Naming, program: MixedIntegerProgram, rows: list[int], rng: np.random.Generator):
    """Solutions of the program without some rows, each as far on the wrong side of one as it can be."""
    low, high = program.low.copy(), program.high.copy()
    low[rows], high[rows] = -np.inf, np.inf
    names = [name for name, _ in naming.rows]
    text = model_text(replace(program, low=low, high=high), naming.columns, names, "mps")
    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("mip_rel_gap", 0.5)
    solver.setOptionValue("time_limit", 10.0)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.mps"
        path.write_text(text)
        solver.readModel(str(path))
    names_read = [*solver.getLp().col_names_]
    for row in rng.permutation([k for k in rows if can_break(program, k)])[:4]:
        inside = program.rows == row
        sign = 1.0 if np.isfinite(program.low[row]) else -1.0
        cost = dict(zip(program.columns[inside], sign * program.values[inside], strict=True))
        for k, name in enumerate(names_read):
            solver.changeColCost(k, float(cost.get(naming.columns.index(name), 0.0)))
        solver.run()
        values = solver.getSolution().col_value
        yield {name: Fraction(x) for name, x in zip(solver.getLp().col_names_, values, strict=True)}


def refused_by(naming: Naming, values: dict[str, Fraction]) -> str:
    """The kind of the row that refuses values, or nothing."""
    try:
        columns_of(naming, parse_solution(as_text(values), "a.sol"))
    except InputError as error:
        row = str(error).partition("row ")[2].removeprefix("choose.")
        kind = re.split("[.@]", row)[0]
        return kind if kind.replace("_", " ") in {*LimitKind} else "comparison"
    return ""


def test_solutions_that_are_none_are_refused(solution: tuple[Naming, dict[str, Fraction]]) -> None:
    naming, values = solution

    def refusal(changed: dict[str, Fraction]) -> str:
        with pytest.raises(InputError) as error:
            columns_of(naming, parse_solution(as_text(changed), "a.sol"))
        return str(error.value)

    assert len(columns_of(naming, parse_solution(as_text(values), "a.sol"))) == 88
    unknowns = {name: x for name, x in values.items() if not name.startswith("choice.")}
    assert len(columns_of(naming, parse_solution(as_text(unknowns), "a.sol"))) == 88
    less = {name: x for name, x in values.items() if name != "POV.v_lon@3"}
    assert refusal(less).startswith(
        "a.sol: column POV.v_lon@3 is missing: row motion.POV@2: motion of POV at"
    )
    assert "SV.s@99 is not of this problem" in refusal({**values, "SV.s@99": Fraction(1)})
    assert "it has no column of this problem" in refusal({"x": Fraction(1)})
    assert "POV.v_lon@0 is 90, not in [22, 34]" in refusal({**unknowns, "POV.v_lon@0": Fraction(90)})


TEXTS = {
    "HiGHS": "Model status\nOptimal\n\n# Primal solution values\nFeasible\nObjective 0\n# Columns 2\n"
    "a 1\nb 0.5\n# Rows 1\nr 3\n",
    "SCIP": "solution status: optimal solution found\nobjective value:   0\n"
    "a   1 \t(obj:0)\nb  0.5 \t(obj:1e2)\n",
    "CBC": "Optimal - objective value 0.00000000\n      0 a      1       0\n**      1 b   0.5    0\n",
    "Gurobi": "# Solution for model m\n# Objective value = 0\na 1\nb 0.5\n",
    "SMT-LIB model": "sat\n(\n  (define-fun n1 () Bool true)\n  (define-fun b () Real (/ 1.0 2.0))\n"
    "  (define-fun |a| () Real 1.0)\n)\n",
}


@pytest.mark.parametrize("form", TEXTS)
def test_solutions_of_all_solvers_are_read(form: str) -> None:
    read = parse_solution(TEXTS[form], "x.sol")
    assert read.format == form
    assert read.values == {"a": 1, "b": Fraction(1, 2)}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "begins no solution"),
        ("a 1\n", "begins no solution"),
        ("Model status\nInfeasible\n\n# Primal solution values\nNone\n", "status is 'Infeasible'"),
        (TEXTS["HiGHS"].replace("# Columns 2", "# Columns 5"), "it ends after 4 of 5 columns"),
        (TEXTS["HiGHS"].replace("b 0.5\n# Rows 1\nr 3\n", ""), "it ends after 1 of 2 columns"),
        ("solution status: infeasible\n", "it has no solution"),
        ("solution status: infeasible\nno solution available\n", "status is 'infeasible'"),
        ("Infeasible - objective value 0.00000000\n 0 a 1 0\n", "it has no solution"),
        ("Optimal - objective value 0\n 0 a\n", "line 2: '0 a' is no name with a value"),
        (TEXTS["Gurobi"] + "a 2\n", "column a has a value already"),
        (TEXTS["Gurobi"].replace("0.5", "nan"), "line 4: 'nan' is no finite number"),
        (TEXTS["Gurobi"].replace("0.5", "0x1"), "is no finite number"),
        ("unsat\n", "status is 'unsat'"),
        ("sat\n((define-fun a () Real (root-obj (+ (^ x 2) (- 2)) 1)))\n", "a has an irrational value"),
    ],
)  # fmt: skip
def test_texts_that_are_no_solution_are_refused(text: str, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        parse_solution(text, "x.sol")


# --- The command line --------------------------------------------------------------------------------


def test_a_solution_becomes_evidence(
    tmp_path: Path,
    solution: tuple[Naming, dict[str, Fraction]],
    capsys: pytest.CaptureFixture[str],
) -> None:
    _, values = solution
    file, out = tmp_path / "a.sol", tmp_path / "drives"
    file.write_text(as_text(values))
    line = ["witness", "4", "--lane", "L=main-1", "--solution", str(file), "--no-pictures", "--jobs", "1"]
    assert main([*line, "--out", str(out)]) == 0
    assert "scenario 4   base  WITNESSED" in capsys.readouterr().out
    assert main(["check", str(out), "--jobs", "1"]) == 0
    file.write_text(as_text({**values, "SV.s@3": values["SV.s@3"] + 1}))
    assert main(line) == 3
    assert "row motion.SV@" in capsys.readouterr().err
    assert main(["witness", "4,5", "--solution", str(file)]) == 2
    assert "it is one drive, and 2 are asked for" in capsys.readouterr().err


def test_formulas_that_no_row_bounds_are_refused() -> None:
    cubic = "v_lon(SV)^3 > 30 m/s * v_lon(SV)^2"
    with pytest.raises(UsageError, match="conditions at time 0 that no row bounds"):
        rp.encode(cubic)
    with pytest.raises(UsageError, match="degree above 2, which no linear row bounds: write it as smt2"):
        rp.encode(cubic, drives="outer").text("mps")
    assert "(check-sat)" in rp.encode(cubic, drives="outer").text("smt2")


def test_a_drive_to_which_a_modifier_objects_is_refused(
    solution: tuple[Naming, dict[str, Fraction]], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Objecting:
        def objector(self, search: object, problem: object) -> object:
            return lambda drive: "the driver brakes in time"

    naming, values = solution
    columns = columns_of(naming, parse_solution(as_text(values), "a.sol"))
    assert judged(naming.posed, columns, "a.sol").file.formula == "scenario_4(SV, POV, L)"
    monkeypatch.setattr(judging, "find_modifier", lambda _: Objecting())
    with pytest.raises(NoWitnessError, match="its drive is no witness: the driver brakes in time"):
        judged(naming.posed, columns, "a.sol")
