"""Classes: against truth tables, against the monitor on random and simulated traces, and with faults."""

import json
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import combinations, product
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asking import prove
from monitor.cases import random_traffic
from roadproof.analysis.classify.cells import Axis, Cell, Outline, outline, refine, text_of
from roadproof.analysis.classify.classes import Classes, plan_of, what_axis, where_axis
from roadproof.analysis.classify.drives import find_examples, patched, with_zones
from roadproof.analysis.classify.shares import Shares, count_shares
from roadproof.analysis.classify.text import claims_of, ranges, with_classes, write_classes
from roadproof.analysis.requests import Asked
from roadproof.cli.main import main
from roadproof.effort import Effort
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import load_drive, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.logic.rewrite import with_values, without_names
from roadproof.monitor import compile
from roadproof.spec.bind import default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Source, Specification, build_library, bundled_library, load_library
from roadproof.traffic.simulate import Traffic
from roadproof.traffic.synthetic import simulate
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

BASE = bundled_library().select("base")
OVERLAPPING = {(1, 5), (3, 6), (4, 8), (4, 6, 8), (6, 8)}


@cache
def outlines(numbers: tuple[int, ...]) -> list[Outline]:
    """The outline of each group of scenarios of base; they are of one road sector."""
    plan = plan_of(BASE, numbers)
    return [outline(what_axis(plan, group, BASE), BASE, Effort(1.0)) for group in plan.groups]


@cache
def classes_of(numbers: tuple[int, ...]) -> Classes:
    """Classes whose cells deny every scenario that can hold beside theirs, with nothing left out."""
    plan = plan_of(BASE, numbers)
    axes = [what_axis(plan, group, BASE) for group in plan.groups]
    cells = [
        tuple(Cell(holds, holds, tuple(axis.rows[n] for n in others)) for holds, others in made.cells)
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


def truth(text: str, values: tuple[bool, ...]) -> bool:
    for atom, value in zip(ATOMS, values, strict=True):
        text = text.replace(atom, str(value))
    return bool(eval(text))


@settings(max_examples=12, deadline=None, derandomize=True)
@given(st.lists(FORMULAS, min_size=1, max_size=4))
def test_cells_are_those_of_the_truth_table(rows: list[str]) -> None:
    axis = Axis((), dict(enumerate(rows, 1)), {})
    found = outline(axis, BASE, Effort(5.0))
    table = {values: rows_that_hold(axis, values) for values in product((True, False), repeat=len(ATOMS))}
    assert {holds for holds, _ in found.cells} == set(table.values()) - {()}
    cells = [refine(axis, BASE, holds, others, Effort()) for holds, others in found.cells]
    for values, holds in table.items():
        assert [cell.holds for cell in cells if truth(text_of(axis, cell), values)] == (
            [holds] if holds else []
        )
    for claim in found.empty:
        assert all(truth(claim, values) for values in table)


def test_the_cells_of_base(main_road: Classes) -> None:
    """Scenarios 4 and 6 without 8 do not occur; every other choice that may hold together is a cell."""
    pairs, triples = main_road.what
    assert {cell.holds for cell in pairs} == {(n,) for n in (1, 3, 4, 5, 6, 7, 8)} | OVERLAPPING
    assert [cell.holds for cell in triples] == [(2,)]
    (claim,) = outlines((1, 2, 3, 4, 5, 6, 7, 8))[0].empty
    assert claim == "not (scenario_4(SV, POV, L) and scenario_6(SV, POV, L) and not scenario_8(SV, POV, L))"


def test_rows_that_follow_are_not_said_and_not_denied() -> None:
    rows = {1: "G v_lon(SV) > 0", 2: "v_lon(SV) > 0", 3: "(v_lon(SV) > 0 and a_lon(SV) > 0)"}
    axis = Axis((), rows, {3: ("a_lon(SV) > 0",)})
    found = outline(axis, BASE, Effort(5.0))
    assert [holds for holds, _ in found.cells] == [(1, 2), (1, 2, 3), (2,), (2, 3)]
    assert (
        "not (G v_lon(SV) > 0 and not v_lon(SV) > 0 and not (v_lon(SV) > 0 and a_lon(SV) > 0))" in found.empty
    )
    cells = {holds: refine(axis, BASE, holds, others, Effort()) for holds, others in found.cells}
    assert cells[1, 2] == Cell((1, 2), (1,), ("a_lon(SV) > 0",))
    assert cells[1, 2, 3] == Cell((1, 2, 3), (1, 3), ())
    assert cells[2,].said == (2,)
    assert cells[2, 3] == Cell((2, 3), (3,), ("G v_lon(SV) > 0",))


# --- claims -------------------------------------------------------------------------------------


def test_the_command_writes_what_is_checked_again(written: Path, capsys: pytest.CaptureFixture[str]) -> None:
    index = json.loads((written / "index.json").read_text())
    assert (index["schema"], index["scenarios"]) == ("roadproof/classify/1", [4, 8])
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
    assert [line.split()[0] for line in said[1:-1]] == ["WITNESSED"] * 3 + ["PROVED"] * 5


def test_the_text_is_read_by_the_other_commands(written: Path, capsys: pytest.CaptureFixture[str]) -> None:
    read = ["--spec", str(written / "classes.spec"), "--set", "classes"]
    assert main(["show", "class_4_8", *read]) == 0
    assert "exactly 4 and 8" in capsys.readouterr().out
    drive = str(written / "drives/class_4_8.json")
    assert main(["monitor", "class_4_8(SV,POV,L)", drive, *read]) == 0
    assert main(["monitor", "class_4(SV,POV,L)", drive, *read]) == 10
    claims = str(written / "claims.txt")
    assert main(["prove", *read, "--claims", claims, "--jobs", "1", "--no-drive"]) == 0


def test_a_class_holds_on_its_own_drive_only(written: Path) -> None:
    library = load_library([written / "classes.spec"])
    files = {path.stem: load_drive(path) for path in (written / "drives").glob("*.json")}
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
    assert sorted(x.name for x in tmp_path.rglob("*.json")) == [
        "class_4.json",
        "covers-scenario-04.json",
        "index.json",
        "mine.json",
    ]


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
    monkeypatch.setattr("roadproof.cli.classify.count_on", lambda *arguments: told)
    assert main(["classify", "--among", "7", "--jobs", "1"]) == 30
    said = capsys.readouterr().out
    assert "3 traces, 1 (33.3 %) in none of these scenarios" in said
    assert "CROSSCHECK-FAILED: 1 of 2 situations" in said


def claims_that_fail(text: str, classes: Classes) -> dict[str, Verdict]:
    specification = with_classes(text, BASE)
    verdicts = {x.name: prove(specification, x.text, Effort(20)).verdict for x in claims_of(classes, {})}
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
    sectors = where_axis(plan, ("SV", "POV")).rows
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
        cells = f"{what}({vehicles}, L) and where_{classes.place(one.where)}({vehicles})"
        same = (read_claim(specification, text).formula for text in (one.formula, cells))
        assert len({without_names(formula) for formula in same}) == 1


def test_claims_about_places_are_proved_and_a_fault_is_refuted() -> None:
    plan = plan_of(BASE, (4, 12, 20))
    (group,) = plan.groups
    happens = outline(what_axis(plan, group, BASE), BASE, Effort(1.0))
    axis = where_axis(plan, group.vehicles)
    places = tuple(refine(axis, BASE, *cell, Effort()) for cell in outline(axis, BASE, Effort(1.0)).cells)
    classes = Classes(plan, ((Cell((4,), (4,), ()),),), places)
    assert [holds for holds, _ in happens.cells] == [(4,)]
    assert len(classes.all()) == len(places) == 7
    text = write_classes(classes, BASE)
    assert len(claims_of(classes, {})) == 21 + 3
    assert claims_that_fail(text, classes) == {}
    wrong = text.replace(
        ":= roadSector_4(SV, POV) and not roadSector_12(SV, POV)", ":= roadSector_4(SV, POV)"
    )
    assert wrong != text
    assert claims_that_fail(wrong, classes) == {
        "exclusive-where_main-where_main_merge-2-vehicles": Verdict.REFUTED
    }


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
    file = load_drive(written / "drives/class_4.json")
    library = bundled_library()
    found = set()
    for road in patched(file.road, file.drive):
        held = [
            judge_file(replace(file, road=road, set_name="base", formula=f"scenario_{n}(SV,POV,L)"), library)
            for n in (4, 12, 20)
        ]
        found.add(tuple(ruling.accepted for ruling in held))
        if len(found) == 7:
            break
    assert found == set(product((True, False), repeat=3)) - {(False, False, False)}


def test_a_road_of_one_zone_where_the_usual_one_does_not_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.analysis.classify.drives.usual_road", lambda formula: load_road("main-2"))
    cell = Cell((12,), (12,), ("behaviourSV_16(SV, POV, L)",))
    classes = Classes(plan_of(BASE, (12, 16)), ((cell,),), ())
    text = write_classes(classes, BASE)
    [example] = find_examples(Asked(effort=Effort(30)), text, classes.plan, classes.all())
    assert (example.name, example.verdict) == ("class_12", Verdict.WITNESSED)
    file = read_drive(dict(example.drive or {}), "drive")
    assert {lanelet.zone for lanelet in file.road.lanelets} == {"merge"}
    assert judge_file(file, with_classes(text, BASE).library).accepted


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
    roads = list(patched(load_road("main-2"), drive))
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
    recording = simulate(Traffic(seconds=60, lanes=2), seed=1)
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
    found = outline(what_axis(plan, plan.groups[0], specification), specification, Effort(1.0))
    assert found.cells == (((4, 25), ()), ((25,), (4,)))


def test_ranges() -> None:
    assert ranges([1, 2, 3, 5]) == "1-3, 5"


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
    index = json.loads((written / "index.json").read_text())
    classes = [{**x, "drive": "drive.json"} for x in index["classes"] if x["name"] == "class_4"]
    (tmp_path / "index.json").write_text(json.dumps({**index, "classes": classes, "claims": []}))
    (tmp_path / "drive.json").write_text((written / "drives/class_4.json").read_text())
    text = (written / "classes.spec").read_text()
    (tmp_path / "classes.spec").write_text(text)
    assert main(["check", str(tmp_path), "--jobs", "1"]) == 0
    (tmp_path / "classes.spec").write_text(f"{text}\n{more}\n")
    assert main(["check", str(tmp_path), "--jobs", "1"]) == 3
    assert "of the library, so what the evidence says is not what it seems" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        (["--among", "4,9"], 2, "each road sector"),
        (["--among", "99"], 3, "no scenario '99'"),
        (["--timeout", "0"], 2, "greater than 0"),
        (["--on", "/nowhere", "--no-shares"], 2, "leave out one of the two"),
        (["--on", "/nowhere"], 3, "/nowhere"),
        (["--set", "bas"], 3, "did you mean 'base'"),
    ],
)
def test_mistakes(line: list[str], code: int, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["classify", *line]) == code
    assert said in capsys.readouterr().err
