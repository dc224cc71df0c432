"""Classes: against truth tables, against the monitor on random and simulated traces, and with faults."""

import json
import os
import shutil
import signal
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import combinations, product
from pathlib import Path
from typing import Any, TypeVar

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine_calls import prove
from extensions.traffic.monitoring.cases import random_traffic
from roadproof.engines.search import valid
from roadproof.engines.search.batches import Engines
from roadproof.errors import InputError, UsageError
from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import judge_file
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.extensions.surveys.classify import simulated
from roadproof.extensions.surveys.classify.cells import (
    Axis,
    Cell,
    ClaimGenerator,
    Outline,
    outline,
    query_of,
    refine,
    whole_cell,
)
from roadproof.extensions.surveys.classify.classes import Classes, plan_of, what_axis, where_axis
from roadproof.extensions.surveys.classify.division import divide
from roadproof.extensions.surveys.classify.drives import find_examples, with_patched_zones, with_zones
from roadproof.extensions.surveys.classify.question import question_of
from roadproof.extensions.surveys.classify.simulated import (
    shares_key,
    shares_of,
    shares_text,
    simulated_shares,
)
from roadproof.extensions.surveys.classify.text import claims_of, with_classes, write_classes
from roadproof.extensions.surveys.classify.traffic_shares import Shares, count_shares
from roadproof.extensions.traffic.scenario_parts import components
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import main
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library, load_library
from roadproof.library.specification import Query, Source, Specification
from roadproof.library.words import spans
from roadproof.logic.rewrite import with_values, without_names
from roadproof.questions.basis import Basis
from roadproof.questions.decide import decide_claims
from roadproof.runtime.archives import SWITCH, remember
from roadproof.runtime.budget import BudgetExceeded, Effort, Work
from roadproof.runtime.version import ANSWERS
from roadproof.semantics.sampled import compile
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

BASE = bundled_library().select("base")
QUICK = Basis(BASE, proof=1.0)
OVERLAPPING = {(1, 5), (3, 6), (4, 8), (4, 6, 8), (6, 8)}


T = TypeVar("T")


def proving(asking: ClaimGenerator[T], units: float = 1.0) -> T:
    """What claims show that are asked one by one, with so much work for each."""
    engines = Engines(Work(proof=units))
    try:
        _, claim = next(asking)
        while True:
            _, claim = asking.send(engines.answer_claim(claim)[0])
    except StopIteration as end:
        shown: T = end.value
        return shown


def outlined(axis: Axis, units: float = 1.0) -> Outline:
    found = proving(outline(axis, BASE, "axis"), units)
    assert isinstance(found, Outline)
    return found


def refined(axis: Axis, holds: tuple[int, ...], others: tuple[int, ...], units: float = 2.0) -> Cell:
    cell, reason = proving(refine(axis, BASE, "cell", holds, others), units)
    assert not reason
    return cell


@cache
def outlines(numbers: tuple[int, ...]) -> list[Outline]:
    """The outline of each group of scenarios of base; they are of one road sector."""
    plan = plan_of(BASE, numbers)
    return [outlined(what_axis(plan, group, BASE)) for group in plan.groups]


@cache
def classes_of(numbers: tuple[int, ...]) -> Classes:
    """Classes whose cells deny every scenario that can hold beside theirs, with nothing left out."""
    plan = plan_of(BASE, numbers)
    axes = [what_axis(plan, group, BASE) for group in plan.groups]
    cells = [
        tuple(whole_cell(axis, holds, others) for holds, others in made.cells)
        for axis, made in zip(axes, outlines(numbers), strict=True)
    ]
    return Classes(plan, tuple(cells), ())


@pytest.fixture(scope="module")
def main_road() -> Classes:
    return classes_of((1, 2, 3, 4, 5, 6, 7, 8))


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the command writes for scenarios 4 and 8."""
    out = tmp_path_factory.mktemp("classes")
    line = ["classify", "--among", "4,8", "--no-shares", "--no-pictures", "--jobs", "1"]
    assert main([*line, "--out", str(out)]) == 0
    return out


# --- cells --------------------------------------------------------------------------------------

ATOMS = ("v_lon(SV) > 0", "v_lon(POV) > 0", "a_lon(SV) > 0")
FORMULAS = st.recursive(
    st.sampled_from(ATOMS),
    lambda inner: st.one_of(
        inner.map(lambda x: f"not ({x})"),
        st.tuples(inner, st.sampled_from(["and", "or"]), inner).map(lambda x: f"({x[0]} {x[1]} {x[2]})"),
    ),
    max_leaves=4,
)


def rows_that_hold(axis: Axis, values: tuple[bool, ...]) -> tuple[int, ...]:
    return tuple(n for n, row in axis.rows.items() if truth(row, values))


def read(text: str) -> Query:
    return read_claim(BASE, text)


def truth(query: Query, values: tuple[bool, ...]) -> bool:
    text = query.text
    for atom, value in zip(ATOMS, values, strict=True):
        text = text.replace(atom, str(value))
    return bool(eval(text))


@settings(max_examples=12, deadline=None, derandomize=True)
@given(st.lists(FORMULAS, min_size=1, max_size=4))
def test_cells_are_those_of_the_truth_table(rows: list[str]) -> None:
    axis = Axis((), dict(enumerate(map(read, rows), 1)), {})
    found = outlined(axis, 5.0)
    table = {values: rows_that_hold(axis, values) for values in product((True, False), repeat=len(ATOMS))}
    assert {holds for holds, _ in found.cells} == set(table.values()) - {()}
    cells = [refined(axis, holds, others) for holds, others in found.cells]
    for values, holds in table.items():
        assert [cell.holds for cell in cells if truth(query_of(axis, cell), values)] == (
            [holds] if holds else []
        )
    for query in found.empty:
        assert not any(truth(query, values) for values in table)


def test_the_cells_of_base(main_road: Classes) -> None:
    """Scenarios 4 and 6 without 8 do not occur; every other choice that may hold together is a cell."""
    pairs, triples = main_road.what
    assert {cell.holds for cell in pairs} == {(n,) for n in (1, 3, 4, 5, 6, 7, 8)} | OVERLAPPING
    assert [cell.holds for cell in triples] == [(2,)]
    (query,) = outlines((1, 2, 3, 4, 5, 6, 7, 8))[0].empty
    assert query.text == "scenario_4(SV, POV, L) and scenario_6(SV, POV, L) and not scenario_8(SV, POV, L)"


def test_rows_that_follow_are_not_said_and_not_denied() -> None:
    rows = {1: "G v_lon(SV) > 0", 2: "v_lon(SV) > 0", 3: "(v_lon(SV) > 0 and a_lon(SV) > 0)"}
    faster = read("a_lon(SV) > 0")
    axis = Axis((), {number: read(row) for number, row in rows.items()}, {3: (faster,)})
    found = outlined(axis, 5.0)
    assert [holds for holds, _ in found.cells] == [(1, 2), (1, 2, 3), (2,), (2, 3)]
    never = read("G v_lon(SV) > 0 and not v_lon(SV) > 0 and not (v_lon(SV) > 0 and a_lon(SV) > 0)")
    assert never.formula in [query.formula for query in found.empty]
    cells = {holds: refined(axis, holds, others) for holds, others in found.cells}
    assert cells[1, 2] == Cell((1, 2), (1,), (faster,))
    assert cells[1, 2, 3] == Cell((1, 2, 3), (1, 3), ())
    assert cells[2,].required == (2,)
    assert cells[2, 3] == Cell((2, 3), (3,), (axis.rows[1],))


# --- claims -------------------------------------------------------------------------------------


def test_the_command_writes_what_is_checked_again(written: Path, capsys: pytest.CaptureFixture[str]) -> None:
    index = folder_data(written)
    assert (index["schema"], index["scenarios"]) == ("roadproof/classify/2", [4, 8])
    assert {x["name"]: tuple(x["scenarios"]) for x in index["classes"]} == {
        "class_4": (4,),
        "class_4_8": (4, 8),
        "class_8": (8,),
    }
    assert {x["verdict"] for x in index["classes"]} == {"WITNESSED"}
    assert [x["verdict"] for x in index["claims"]] == ["PROVED"] * (3 + 2)
    assert main(["check", str(written), "--jobs", "1"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == f"read with {written / 'classes.spec'}"
    assert said[-1] == "8 of 8 accepted by z3 and the exact judge"
    assert said[-2] == f"not checked in {written}: claims.txt"
    assert [line.split()[0] for line in said[1:9]] == ["WITNESSED"] * 3 + ["PROVED"] * 5
    assert said[9:13] == [
        "  4: deceleration ahead, lane keep",
        "  8: deceleration ahead, lane change (SV leaves its lane)",
        "  4, 8: main road",
        f"what {written} shows (classify):",
    ]
    assert said[-3] == "each scenario is the union of its classes: 2 PROVED"


def test_the_text_is_read_by_the_other_commands(written: Path, capsys: pytest.CaptureFixture[str]) -> None:
    read = ["--spec", str(written / "classes.spec"), "--set", "classes"]
    assert main(["show", "class_4_8", *read]) == 0
    assert "exactly 4 and 8" in capsys.readouterr().out
    drive = str(written / "class_4_8.json")
    assert main(["monitor", "class_4_8(SV,POV,L)", drive, *read]) == 0
    assert main(["monitor", "class_4(SV,POV,L)", drive, *read]) == 10
    claims = str(written / "claims.txt")
    assert main(["prove", *read, "--claims", claims, "--jobs", "1", "--no-drive"]) == 0


def test_a_class_holds_on_its_own_drive_only(written: Path) -> None:
    library = load_library([written / "classes.spec"])
    files = {path.stem: load_drive(path) for path in written.glob("class_*.json")}
    assert len(files) == 3
    for name, file in files.items():
        assert file.formula == f"{name}(SV, POV, L)"
        holding = [
            x for x in files if judge_file(replace(file, formula=f"{x}(SV, POV, L)"), library).accepted
        ]
        assert holding == [name]


def test_another_run_leaves_nothing_of_the_first(tmp_path: Path) -> None:
    line = ["classify", "--no-shares", "--no-pictures", "--jobs", "1", "--out", str(tmp_path)]
    (tmp_path / "mine.json").write_text("{}")
    assert main([*line, "--among", "7"]) == 0
    assert main([*line, "--among", "4"]) == 0
    assert sorted(x.relative_to(tmp_path).as_posix() for x in tmp_path.rglob("*.json")) == [
        "class_4.json",
        "covers-scenario-04.json",
        "mine.json",
        "question.json",
    ]


def test_drives_of_ones_own_are_left_alone_in_a_new_folder(tmp_path: Path) -> None:
    (tmp_path / "drives").mkdir()
    (tmp_path / "drives/mine.json").write_text("{}")
    line = ["classify", "--no-shares", "--no-pictures", "--jobs", "1", "--out", str(tmp_path)]
    assert main([*line, "--among", "7"]) == 0
    assert (tmp_path / "drives/mine.json").exists()


# --- going on, and doubts -----------------------------------------------------------------------


def test_a_run_that_was_broken_off_goes_on(
    written: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What was kept is not asked again, what was lost or changed is; evidence without a claim goes."""
    out = tmp_path / "out"
    shutil.copytree(written, out)
    files = {path.name: path.read_bytes() for path in out.iterdir()}
    (out / "class_8.json").unlink()  # a run that was killed before it had kept this
    (out / "covers-scenario-04.json").write_text("{}")
    shutil.copyfile(out / "class_4.json", out / "class_9.json")
    assert main(["check", str(out), "--jobs", "1"]) != 0
    before = {path.name: path.stat().st_mtime_ns for path in out.iterdir()}
    line = ["classify", "--among", "4,8", "--no-shares", "--no-pictures", "--jobs", "1", "--out", str(out)]
    capsys.readouterr()
    assert main(line) == 0
    after = {path.name: path.stat().st_mtime_ns for path in out.glob("*-*.json")}
    after |= {path.name: path.stat().st_mtime_ns for path in out.glob("class_*.json")}
    written_now = {name for name in after if after[name] != before.get(name)}
    # What one process settles together is written together.
    assert written_now == {"class_8.json", "covers-scenario-04.json", "covers-scenario-08.json"}
    said = capsys.readouterr().err
    assert "a stored answer is invalid and is computed again" in said
    assert f"a stored answer is asked for no more and is removed: {out / 'class_9.json'}" in said
    assert {path.name: path.read_bytes() for path in out.iterdir()} == files
    assert main(["check", str(out), "--jobs", "1"]) == 0
    assert "8 of 8 accepted" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("def class_8(", "def class_9("),
        (" and not behaviourSV_8(SV, POV, L)", ""),
        (":= scenario_4(SV, POV, L)", ":= scenario_1(SV, POV, L)"),
    ],
)
def test_a_forged_text_is_rejected(before: str, after: str, written: Path, tmp_path: Path) -> None:
    """Each answer is about what the definitions say, so other definitions make other claims."""
    out = tmp_path / "out"
    shutil.copytree(written, out)
    text = (out / "classes.spec").read_text()
    forged = text.replace("\n  := ", " := ").replace(before, after, 1)
    assert forged != text.replace("\n  := ", " := ")
    (out / "classes.spec").write_text(forged)
    assert main(["check", str(out), "--jobs", "1"]) != 0


@pytest.mark.parametrize(
    "change",
    [
        lambda asked: asked["groups"][0]["cells"].pop(),
        lambda asked: asked["groups"][0]["cells"].append([1]),
        lambda asked: asked["scenarios"].pop(),
        lambda asked: asked["scenarios"].append(1),
        lambda asked: asked["groups"].pop(),
        lambda asked: asked["groups"][0]["empty"].append("false"),
        lambda asked: asked["places"].append([9]),
    ],
)
def test_a_forged_division_is_rejected(change: Callable[..., object], written: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    shutil.copytree(written, out)
    data = json.loads((out / "question.json").read_text())
    change(data["asked"])
    (out / "question.json").write_text(json.dumps(data))
    assert main(["check", str(out), "--jobs", "1", "--strict"]) != 0


def die(*_: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def late(*_: object) -> None:
    raise BudgetExceeded(1.0)


@pytest.mark.parametrize(
    ("fault", "said"),
    [(die, "its process ended each time"), (late, "cut off by the clock")],
    ids=["lost", "late"],
)
def test_a_cell_in_doubt_is_said_in_full_and_the_run_is_in_doubt(
    fault: Callable[..., None],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    axis = what_axis(plan_of(BASE, (4, 8)), plan_of(BASE, (4, 8)).groups[0], BASE)
    _, first = next(refine(axis, BASE, "class_4", (4,), (8,)))
    settle_valid = valid.decide_valid

    def one_fails(claim: Claim, *more: Any) -> Any:
        if claim.text == first.text:
            fault()
        return settle_valid(claim, *more)

    monkeypatch.setattr(valid, "decide_valid", one_fails)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    line = ["classify", "--among", "4,8", "--no-shares", "--no-pictures", "--jobs", "2"]
    assert main([*line, "--out", str(tmp_path)]) == 20
    printed = capsys.readouterr().out
    assert f"UNKNOWN: whether there is a shorter text for class_4: {said}" in printed
    assert "3 classes: 3 WITNESSED" in printed
    index = folder_data(tmp_path)
    assert ":= scenario_4(SV, POV, L) and not scenario_8(SV, POV, L)" in index["text"].replace("\n  ", " ")
    assert "and not behaviourSV_4(SV, POV, L)" in index["text"]
    (doubt,) = index["doubts"]
    assert said in doubt["reason"]
    assert main(["check", str(tmp_path), "--jobs", "1"]) == 0
    assert "UNKNOWN   whether there is a shorter text for class_4" in capsys.readouterr().out
    monkeypatch.undo()
    assert main([*line, "--out", str(tmp_path)]) == 0
    assert main(["check", str(tmp_path), "--jobs", "1"]) == 0


@pytest.mark.parametrize(
    ("fault", "said"),
    [(die, "its process ended each time"), (late, "cut off by the clock")],
    ids=["lost", "late"],
)
def test_an_outline_in_doubt_makes_no_classes_and_leaves_the_folder_alone(
    fault: Callable[..., None],
    said: str,
    written: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = tmp_path / "out"
    shutil.copytree(written, out)
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    monkeypatch.setattr(valid, "decide_valid", fault)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    line = ["classify", "--no-pictures", "--jobs", "2", "--out", str(out)]
    # Of one axis alone there is no job that could be lost.
    assert main([*line, "--among", "4,8" if fault is late else "1-8"]) == 20
    printed = capsys.readouterr().out
    assert f"no classes\n  UNKNOWN: which classes there are: {said}" in printed
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before


def test_lost_drives_are_doubts(monkeypatch: pytest.MonkeyPatch) -> None:
    basis = Basis(BASE)
    question = question_of(basis, divide(basis, plan_of(BASE, (4, 8)), 1))
    monkeypatch.setattr("roadproof.engines.search.drive_search.search_drive", die)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    found = question.view(decide_claims(question, executor=2).answers)
    assert {(x.verdict, x.drive is None) for x in found.examples} == {(Verdict.UNKNOWN, True)}
    assert all("its process ended each time" in x.reason for x in found.examples[:1])
    assert {x.verdict for x in found.decisions} == {Verdict.PROVED}


def test_a_doubt_is_no_pass(capsys: pytest.CaptureFixture[str]) -> None:
    """A class without a drive stays, and no verdict is without evidence."""
    line = ["classify", "--among", "5", "--no-shares", "--effort", "0.05", "--jobs", "1", "--json", "-"]
    assert main(line) == 20
    data = json.loads(capsys.readouterr().out)
    ((one,), (claim,)) = data["classes"], data["claims"]
    assert (one["name"], one["verdict"], one["drive"]) == ("class_5", "UNKNOWN", None)
    assert "0.05 units of work" in one["reason"]
    assert (claim["verdict"] == "PROVED") == (claim["certificate"] is not None)


def test_classes_that_recordings_contradict(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told = Shares(["01"], 3, 2, classified=Counter({2: 2}), broken=["recording 01: two classes"])
    monkeypatch.setattr(
        "roadproof.extensions.surveys.classify.simulated.count_shares", lambda *arguments, **more: told
    )
    assert main(["classify", "--among", "7", "--jobs", "1"]) == 30
    said = capsys.readouterr().out
    assert "3 traces, 1 (33.3 %) in none of these scenarios" in said
    assert "CROSSCHECK-FAILED: 1 of 2 situations" in said


def claims_that_fail(text: str, classes: Classes) -> dict[str, Verdict]:
    specification = with_classes(text, BASE)
    claims = claims_of(classes, {}, specification)
    verdicts = {x.name: prove(specification, x.query.text, Effort(20)).verdict for x in claims}
    return {name: verdict for name, verdict in verdicts.items() if verdict is not Verdict.PROVED}


def test_faults_in_the_text_are_refuted() -> None:
    classes = classes_of((4, 8))
    text = write_classes(classes, BASE)
    assert claims_that_fail(text, classes) == {}
    without_denial = text.replace(" and not scenario_8(SV, POV, L)", "", 1)
    assert without_denial != text
    assert claims_that_fail(without_denial, classes) == {"exclusive-class_4-class_4_8": Verdict.REFUTED}
    lost = text.replace(":= scenario_4(SV, POV, L) and scenario_8(SV, POV, L)", ":= false")
    assert lost != text
    assert claims_that_fail(lost, classes) == {
        "covers-scenario-04": Verdict.REFUTED,
        "covers-scenario-08": Verdict.REFUTED,
    }
    too_much = text.replace(":= scenario_4(SV, POV, L) and not", ":= not")
    assert too_much != text
    assert claims_that_fail(too_much, classes)["covers-scenario-04"] is Verdict.REFUTED


def test_a_class_that_is_left_out_is_missed() -> None:
    classes = classes_of((4, 8))
    fewer = replace(classes, what=(classes.what[0][:-1],))
    text = write_classes(fewer, BASE)
    assert claims_that_fail(text, fewer) == {"covers-scenario-08": Verdict.REFUTED}


# --- what happens, and where --------------------------------------------------------------------


def test_classes_of_all_scenarios_are_products(main_road: Classes) -> None:
    """With the cells of the main road, and all choices of road sectors; no proof is needed for that."""
    plan = plan_of(BASE, tuple(range(1, 25)))
    axes = [what_axis(plan, group, BASE) for group in plan.groups]
    what = tuple(
        tuple(
            Cell(c.holds, c.holds, tuple(x for n, x in axis.rows.items() if n not in c.holds)) for c in cells
        )
        for axis, cells in zip(axes, main_road.what, strict=True)
    )
    sectors = where_axis(plan, BASE).rows
    where = tuple(
        Cell(holds, holds, tuple(sectors[n] for n in sectors if n not in holds))
        for count in (1, 2, 3)
        for holds in combinations(sectors, count)
    )
    classes = Classes(plan, what, where)
    pairs, triples = (classes.of(group) for group in classes.plan.groups)
    assert (len(pairs), len(triples)) == (12 * 7, 7)
    assert len({one.scenarios for one in pairs}) == len(pairs)
    by_name = {one.name: one.scenarios for one in (*pairs, *triples)}
    assert by_name["class_4_8_main"] == (4, 8)
    assert by_name["class_4_8_main_departure"] == (4, 8, 20, 24)
    assert by_name["class_2_merge"] == (10,)
    specification = with_classes(write_classes(classes, BASE), BASE)
    for one in (pairs[0], pairs[40], triples[3]):
        assert one.where is not None
        vehicles = ", ".join(one.vehicles)
        what = "_".join(["what", *map(str, one.what.holds)])
        cells = f"{what}({vehicles}, L) and where_{one.place}({vehicles})"
        same = (read_claim(specification, text).formula for text in (one.formula, cells))
        assert len({without_names(formula) for formula in same}) == 1


def test_claims_about_places_are_proved_and_a_fault_is_refuted() -> None:
    plan = plan_of(BASE, (4, 12, 20))
    (group,) = plan.groups
    happens = outlined(what_axis(plan, group, BASE))
    axis = where_axis(plan, BASE)
    places = tuple(refined(axis, *cell) for cell in outlined(axis).cells)
    classes = Classes(plan, ((Cell((4,), (4,), ()),),), places)
    assert [holds for holds, _ in happens.cells] == [(4,)]
    assert len(classes.all()) == len(places) == 7
    text = write_classes(classes, BASE)
    assert len(claims_of(classes, {}, with_classes(text, BASE))) == 21 + 3
    assert claims_that_fail(text, classes) == {}
    wrong = text.replace(
        ":= roadSector_4(SV, POV) and not roadSector_12(SV, POV)", ":= roadSector_4(SV, POV)"
    )
    assert wrong != text
    assert claims_that_fail(wrong, classes) == {
        "exclusive-where_main-where_main_merge-2-vehicles": Verdict.REFUTED
    }


def test_places_of_three_vehicles_alone_are_of_any_group() -> None:
    """Their definitions take SV and any group, so they are not said of POV1 and POV2."""
    division = divide(QUICK, plan_of(BASE, (2, 10, 18)), 1)
    study = question_of(QUICK, division)
    assert len(study.classes.all()) == 7
    assert ":= roadSector_2(SV, POV) and not roadSector_10(SV, POV)" in study.text.replace("\n  ", " ")


def test_zones_may_change_under_vehicles() -> None:
    road = load_road("main-2")
    new = with_zones(road, (Fraction(-5), Fraction(5)), ("merge", "main", "depart"))
    assert [(x.id, x.zone, x.s) for x in new.lanelets[:3]] == [
        ("m1-1", "merge", (None, Fraction(-5))),
        ("m1-2", "main", (Fraction(-5), Fraction(5))),
        ("m1-3", "depart", (Fraction(5), None)),
    ]
    assert {x.d for x in new.lanelets} == {x.d for x in road.lanelets}
    assert new.lanes == road.lanes


def test_a_drive_is_put_in_every_place(written: Path) -> None:
    file = load_drive(written / "class_4.json")
    library = bundled_library()
    found = set()
    for road in with_patched_zones(file.road, file.drive):
        held = [
            judge_file(replace(file, road=road, set_name="base", formula=f"scenario_{n}(SV,POV,L)"), library)
            for n in (4, 12, 20)
        ]
        found.add(tuple(ruling.accepted for ruling in held))
        if len(found) == 7:
            break
    assert found == set(product((True, False), repeat=3)) - {(False, False, False)}


def test_a_road_of_one_zone_where_the_usual_one_does_not_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "roadproof.extensions.surveys.classify.drives.usual_road", lambda formula: load_road("main-2")
    )
    (leaves, *_) = components(BASE, 16, ("SV", "POV"))
    assert leaves.text == "behaviourSV_16(SV, POV, L)"
    classes = Classes(plan_of(BASE, (12, 16)), ((Cell((12,), (12,), (leaves,)),),), ())
    specification = with_classes(write_classes(classes, BASE), BASE)
    [example] = find_examples(Basis(specification, effort=Effort(30)), classes.all())
    assert (example.one.name, example.verdict) == ("class_12", Verdict.WITNESSED)
    assert example.drive is not None
    file = example.drive.file
    assert {lanelet.zone for lanelet in file.road.lanelets} == {"merge"}
    assert judge_file(file, specification.library).accepted


def test_vehicles_side_by_side_may_be_in_three_zones() -> None:
    motion = Motion(
        Fraction(4),
        Fraction(2),
        Fraction(0),
        Fraction(2),
        Fraction(20),
        Fraction(0),
        (Piece(None, Fraction(0), Fraction(0)),),
    )
    drive = Drive({"SV": motion, "POV": replace(motion, d=Fraction(6))})
    roads = list(with_patched_zones(load_road("main-2"), drive))
    assert any({x.zone for x in road.lanelets} == {"main", "merge", "depart"} for road in roads)
    assert all(road.lanes == ("main-1", "main-2") for road in roads)


# --- monitors -----------------------------------------------------------------------------------


def partition_faults(classes: Classes, specification: Specification, swapped: bool) -> tuple[int, int]:
    """On random traces: how many have a scenario, and how many are not in exactly the class of theirs."""
    values = {
        **default_values(specification.library),
        "minSafe": Fraction(2, 25),
        "minDanger": Fraction(2, 25),
    }
    group = classes.plan.groups[0]
    arguments = "(POV, SV, L)" if swapped else "(SV, POV, L)"
    names = [*(f"scenario_{n}" for n in group.rows), *(one.name for one in classes.of(group))]
    formulas = {
        name: with_values(read_claim(specification, f"{name}{arguments}").formula, values) for name in names
    }
    batch = random_traffic(list(formulas.values()), traces=4000, longest=20, seed=3, noise=4.0)
    answers = {
        name: answer.true for name, answer in compile(formulas).evaluate(batch, "clip").answers.items()
    }
    covered = faults = 0
    for k in range(batch.traces):
        scenarios = tuple(n for n in group.rows if answers[f"scenario_{n}"][k])
        found = [one.scenarios for one in classes.of(group) if answers[one.name][k]]
        covered += bool(scenarios)
        faults += found != ([scenarios] if scenarios else [])
    return covered, faults


@pytest.mark.parametrize("swapped", [False, True])
def test_random_traces_lie_in_exactly_one_class(main_road: Classes, swapped: bool) -> None:
    text = write_classes(main_road, BASE)
    covered, faults = partition_faults(main_road, with_classes(text, BASE), swapped)
    assert covered > 50
    assert faults == 0
    if not swapped:
        wrong = text.replace(" and not scenario_8(SV, POV, L)", "")
        assert partition_faults(main_road, with_classes(wrong, BASE), swapped)[1] > 0


def test_random_traces_agree_with_the_short_texts(written: Path) -> None:
    text, short = (written / "classes.spec").read_text(), classes_of((4, 8))
    assert "behaviourSV" in text
    assert partition_faults(short, with_classes(text, BASE), False)[1] == 0


def test_simulated_traffic_lies_in_exactly_one_class(main_road: Classes) -> None:
    recording = simulate(TrafficSettings(seconds=60, lanes=2), seed=1)
    values = default_values(bundled_library())
    text = write_classes(main_road, BASE)
    shares = count_shares(main_road, with_classes(text, BASE), values, [recording])
    assert shares.broken == []
    assert sum(shares.situations.values()) == sum(shares.classified.values()) > 5
    assert 0 < shares.covered <= shares.all_traces
    assert max(shares.traces.values()) <= shares.covered
    wrong = text.replace(
        ":= scenario_3(SV, POV, L) and not scenario_6(SV, POV, L)", ":= scenario_1(SV, POV, L)"
    )
    assert wrong != text
    assert count_shares(main_road, with_classes(wrong, BASE), values, [recording]).broken

    told = shares_of(shares_text(shares))
    assert replace(told, source="") == shares
    keys = [shares_key(Basis(with_classes(x, BASE)), main_road) for x in (text, wrong, text)]
    assert keys[0] == keys[2] != keys[1]


def test_simulated_shares_are_known_the_second_time(
    main_road: Classes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not where they contradict what is proved, with --fresh, or where a kept text is none of shares."""
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(simulated, "simulate", lambda *_: None)
    basis = Basis(with_classes(write_classes(main_road, BASE), BASE))
    counted = list[int]()
    broken = list[str]()

    def count(*_: object, source: str) -> Shares:
        counted.append(1)
        return Shares(["01"], 3, 2, Counter(a=2, b=1), Counter(a=1), Counter({2: 3}), broken, source=source)

    monkeypatch.setattr(simulated, "count_shares", count)
    first = simulated_shares(basis, main_road)
    assert simulated_shares(basis, main_road) == first
    assert len(counted) == 1
    assert simulated_shares(basis, main_road, fresh=True) == first
    assert len(counted) == 2
    monkeypatch.setattr(simulated, "ANSWERS", "9.9.9")
    broken.append("recording 01: two classes")
    assert simulated_shares(basis, main_road).broken == simulated_shares(basis, main_road).broken == broken
    assert len(counted) == 4
    remember(shares_key(basis, main_road), "{}")
    simulated_shares(basis, main_road)
    assert len(counted) == 5
    monkeypatch.setenv(SWITCH, "off")
    monkeypatch.setattr(simulated, "ANSWERS", ANSWERS)
    simulated_shares(basis, main_road)
    assert len(counted) == 6


# --- mistakes -----------------------------------------------------------------------------------


def test_rows_that_are_not_those_of_every_sector() -> None:
    with pytest.raises(UsageError, match="1-8, 9-16 or 1-24"):
        plan_of(BASE, (1, 4, 9))


def test_sets_and_names_that_are_taken() -> None:
    classes = classes_of((4, 8))
    text = write_classes(classes, BASE)
    with pytest.raises(UsageError, match="there is a set 'classes' already"):
        plan_of(with_classes(text, BASE), (4, 8))
    taken = build_library([Source("mine", "def class_4(a: vehicle) := v_lon(a) > 0")], bundled_library())
    with pytest.raises(InputError, match="rename it"):
        write_classes(classes, taken.select("base"))
    shapeless = "def scenario_25(SV, POV: vehicle, L: lane) := danger(SV, POV)"
    library = build_library([Source("mine", shapeless)], bundled_library())
    with pytest.raises(InputError, match="roadSector_25"):
        plan_of(library.select("base"), (4, 25))


def test_a_scenario_of_ones_own_is_divided_too() -> None:
    mine = (
        'def scenario_25(SV, POV: vehicle, L: lane) "mine"\n'
        "  := initSafe(SV, POV) and roadSector_25(SV, POV) and disturb_25(SV, POV, L)\n"
        "def roadSector_25(SV: vehicle, POV: vehicles) := mainRoad(SV, POV)\n"
        "def disturb_25(SV, POV: vehicle, L: lane) := laneKeep(SV, L) U danger(SV, POV)\n"
    )
    specification = build_library([Source("mine", mine)], bundled_library()).select("base")
    plan = plan_of(specification, (4, 25))
    found = proving(outline(what_axis(plan, plan.groups[0], specification), specification, "axis"))
    assert isinstance(found, Outline)
    assert found.cells == (((4, 25), ()), ((25,), (4,)))


def test_ranges() -> None:
    assert spans([1, 2, 3, 5], least=2) == "1-3, 5"


@pytest.mark.parametrize(
    "more",
    [
        "def danger(a, b: vehicle) := true",
        "when lateral_sign = rss { def danger(a, b: vehicle) := true }",
        "option new = one | two\nwhen new = one { def danger(a, b: vehicle) := true }",
        "set base { def danger(a, b: vehicle) := true }",
        "param minDanger = 0 s where minDanger >= 0",
    ],
)
def test_a_specification_beside_evidence_may_only_add(
    written: Path, tmp_path: Path, more: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    shutil.copytree(written, out)
    text = (out / "classes.spec").read_text()
    assert main(["check", str(out), "--jobs", "1"]) == 0
    (out / "classes.spec").write_text(f"{text}\n{more}\n")
    assert main(["check", str(out), "--jobs", "1"]) == 10
    assert "of the library, so what the evidence says is not what it seems" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        (["--among", "4,9"], 2, "each road sector"),
        (["--among", "99"], 3, "no scenario 99"),
        (["--timeout", "0"], 2, "greater than 0"),
        (["--on", "/nowhere", "--no-shares"], 2, "contradict each other"),
        (["--on", "/nowhere"], 3, "/nowhere"),
        (["--set", "bas"], 3, "did you mean 'base'"),
    ],
)
def test_mistakes(line: list[str], code: int, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["classify", *line]) == code
    assert said in capsys.readouterr().err
