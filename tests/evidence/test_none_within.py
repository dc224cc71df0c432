"""Trees that refute programs: found where there is no solution, never accepted where there is one."""

import json
import random
from dataclasses import replace
from fractions import Fraction

import pytest
import z3

import roadproof as rp
from engine_calls import search_for
from evidence.trees import RIGHT, WRONG
from planting import plant
from roadproof.engines.prove.properties import find_label
from roadproof.engines.search.none_within import derive, program_for, refute_with_trees
from roadproof.engines.solve.refuting import find_refutation_tree
from roadproof.engines.solve.relaxation import NotRefutedError
from roadproof.errors import InputError
from roadproof.evidence import program as program_module
from roadproof.evidence.checking import Checker
from roadproof.evidence.finding import Acceptance, checkers
from roadproof.evidence.none_within_check import first_fault
from roadproof.evidence.none_within_file import lines_of, none_within_data, read_none_within, tree_of
from roadproof.evidence.program import (
    CaseSplit,
    ColumnSplit,
    Conjunction,
    Disjunction,
    DisjunctiveProgram,
    Fact,
    Linear,
    WeightedSum,
    refutes,
)
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.verdict import ExitCode
from searching.known import known

SHORT = {"horizon": Fraction(9, 5)}
QUESTIONS = [
    "v_lon(SV) > 41 m/s",
    "F v_lon(SV) > 40 m/s",
    "s(POV) - s(SV) = 60 m and s(SV) - s(POV2) = 60 m",
    "s(SV)^2 > 1010000 * 1 m * 1 m and s(SV) > 0 m and s(POV) > s(POV2)",
    "s(SV) < 0 m and F[0.6 s, 0.6 s] s(SV) > 24 m",
    "rssViolation(SV, POV) and atLane(SV, L) and s(SV) > 9 m and v_lon(SV) > 41 m/s",
    "F (v_lon(SV) > 20 m/s and F (v_lon(SV) < 3 m/s and F v_lon(SV) > 30 m/s))",
]


# --- random programs, against z3 --------------------------------------------------------------------------


def linear(dice, columns, strict=False):
    terms = {dice.randrange(columns): dice.choice([-3, -2, -1, 1, 2, 3]) for _ in range(dice.randint(1, 3))}
    return Linear(tuple(terms.items()), dice.randint(-5, 8), strict)


def random_program(dice):
    count = dice.randint(2, 3)
    box = tuple((-dice.randint(0, 4), dice.randint(0, 4)) for _ in range(count))
    products = tuple(
        dice.choice([(i, j) for i in range(count) for j in range(i, count)])
        for _ in range(dice.randint(0, 2))
    )
    products = tuple(dict.fromkeys(products))
    columns = count + len(products)
    nodes = [linear(dice, columns, dice.random() < 0.3) for _ in range(6)]
    for _ in range(4):
        parts = tuple(dice.sample(range(len(nodes)), dice.choice([2, 3])))
        nodes.append(dice.choice([Conjunction, Disjunction])(parts))
    nodes.append(Conjunction(tuple(range(6, len(nodes)))))
    equal = (linear(dice, columns),) if dice.random() < 0.3 else ()
    return DisjunctiveProgram(
        dice.choice([1, 2]), box, products, equal, (linear(dice, columns),), tuple(nodes)
    )


def nearly(dice, program):
    """With another constant in one of its inequalities."""
    place = dice.randrange(6)
    node = program.nodes[place]
    nodes = [*program.nodes]
    nodes[place] = replace(node, constant=node.constant + dice.choice([4, 8, 20]))
    return replace(program, nodes=tuple(nodes))


def has_solution(program):
    """By z3, from the definition of a program."""
    solver = z3.Solver()
    x = [z3.Real(f"x{k}") for k in range(len(program.box))]
    for column, (low, high) in zip(x, program.box, strict=True):
        solver.add(low <= program.scale * column, program.scale * column <= high)
    x += [x[i] * x[j] for i, j in program.products]

    def worth(row):
        return sum((factor * x[column] for column, factor in row.terms), z3.RealVal(row.constant))

    solver.add(*(worth(row) == 0 for row in program.equal), *(worth(row) >= 0 for row in program.above))
    made = []
    for node in program.nodes:
        if isinstance(node, Linear):
            made.append(worth(node) > 0 if node.strict else worth(node) >= 0)
        else:
            parts = [made[p] for p in node.parts]
            made.append(z3.And(parts) if isinstance(node, Conjunction) else z3.Or(parts))
    solver.add(made[-1])
    answer = solver.check()
    assert answer != z3.unknown
    return answer == z3.sat


@pytest.mark.parametrize("seed", range(4))
def test_of_random_programs_those_without_a_solution_are_refuted_and_no_others(seed):
    dice, refuted, missed, solved, spoiled = random.Random(seed), 0, 0, 0, 0
    for _ in range(60):
        program = random_program(dice)
        possible = has_solution(program)
        solved += possible
        try:
            tree = find_refutation_tree(program, 200)
        except NotRefutedError:
            missed += not possible
            continue
        assert not possible
        assert refutes(program, tree)
        refuted += 1
        for _ in range(6):
            other = nearly(dice, program)
            if has_solution(other):
                spoiled += 1
                assert not refutes(other, tree)
    assert min(refuted, solved, spoiled) >= 5
    assert missed <= 4  # false by nothing at all, on products


def test_of_a_program_that_is_too_deep_for_recursion_the_work_is_counted():
    nodes = [Linear(((0, 1),), -1), Linear(((0, 1), (1, 1)), -3)]
    for _ in range(2000):
        nodes += [Conjunction((len(nodes) - 1, 0)), Disjunction((len(nodes), 1))]
    with pytest.raises(NotRefutedError, match="more than 20 linear programs"):
        find_refutation_tree(DisjunctiveProgram(1, ((0, 2), (0, 0)), (), (), (), tuple(nodes)), 20)


def test_right_trees_are_accepted_and_wrong_ones_refused():
    assert [told for told, (program, tree) in RIGHT.items() if not refutes(program, tree)] == []
    assert [told for told, (program, tree) in WRONG.items() if refutes(program, tree)] == []


# With each of these faults the checker accepts a wrong tree, or refuses a right one.
FAULTS = [
    ("linear_of", "if number in known.nodes else None", ""),
    ("is_contradiction", 'or (weight < 0 and fact.kind != "equal")', ""),
    ("_greatest", "max(factor * end", "min(factor * end"),
    ("is_contradiction", "strict and greatest == 0", "greatest == 0"),
    ("is_contradiction", "linear.strict and weight > 0", "linear.strict"),
    ("is_contradiction", "constant * known.program.scale**2", "constant"),
    ("refutes", "or number not in here.nodes", ""),
    ("_product_fact", "1 if first == second else -1", "1"),
    ("_product_fact", "if one != other:", "if False:"),
]


@pytest.mark.parametrize(("name", "right", "wrong"), FAULTS)
def test_the_trees_notice_each_fault(monkeypatch, name, right, wrong):
    plant(monkeypatch, program_module, name, right, wrong)
    judged = {told: program_module.refutes(*pair) for told, pair in (RIGHT | WRONG).items()}
    assert judged != {**dict.fromkeys(RIGHT, True), **dict.fromkeys(WRONG, False)}


# --- questions, files -------------------------------------------------------------------------------------


def none_within(what, **setting):
    found = refute_with_trees(search_for(what, **{**SHORT, **setting}))
    assert found is not None
    return found


@pytest.mark.parametrize("what", QUESTIONS)
def test_a_none_within_is_kept_and_derived_again(what):
    file = none_within(what)
    again = read_none_within(json.loads(json.dumps(none_within_data(file))), "it")
    assert none_within_data(again) == none_within_data(file)
    assert again.refutations == file.refutations
    assert first_fault(again, derive(again, bundled_library())) == ""


def test_for_what_has_a_drive_there_is_no_tree():
    for what in ("4", "v_lon(SV) > 39 m/s", "s(POV) - s(SV) = 80 m"):
        assert refute_with_trees(search_for(what, **SHORT)) is None


@pytest.mark.parametrize("seed", range(12))
def test_of_a_drive_that_is_known_the_program_is_not_refuted(seed):
    case = known(seed)
    question = case.question()
    [lanes] = [x for x in question.lanes if x.items() <= case.lanes.items()]
    with pytest.raises(NotRefutedError):
        find_refutation_tree(program_for(question, lanes), 100)


def accepted(tmp_path, data):
    path = tmp_path / "file.json"
    path.write_text(json.dumps(data), "utf-8")

    def ask(script):
        raise AssertionError("no solver is asked")

    return Checker(bundled_library(), ask, find_label, derive=derive).check(path)


def test_changed_files_are_rejected(tmp_path):
    data = none_within_data(none_within("atLane(SV, L) and v_lon(SV) > 40.5 m/s"))
    assert accepted(tmp_path, data).outcome is Acceptance.ACCEPTED
    assert "horizon" not in accepted(tmp_path, data).reason
    faster = {**data["vehicles"]["SV"], "v_lon": ["3", "41"]}
    for change in (
        {"formula": "atLane(SV, L) and v_lon(SV) > 39.5 m/s"},
        {"formula": "v_lon(SV) > 39.5 m/s and atLane(SV, L)"},
        {"vehicles": {"SV": faster}},
        {"refutations": [{**x, "tree": ["sum above 0 * 1"]} for x in data["refutations"]]},
    ):
        finding = accepted(tmp_path, data | change)
        assert finding.outcome is Acceptance.REJECTED, change
        assert "does not refute" in finding.reason
    [first, *_] = data["refutations"]
    for change in (
        {"refutations": [first, {**first, "lanes": {"L": "nowhere"}}]},
        {"refutations": [{**first, "tree": ["cases 1 2", *first["tree"]]}]},
        {"refutations": [{**first, "tree": [*first["tree"], *first["tree"]]}]},
        {"vehicles": data["vehicles"] | {"POV": data["vehicles"]["SV"]}},
        {"vehicles": {"SV": data["vehicles"]["SV"] | {"length": "-5"}}},
        {"vehicles": {"SV": data["vehicles"]["SV"] | {"v_lon": ["-1", "40"]}}},
        {"road": data["road"] | {"lanelets": [], "adjacent": []}},
        {"refutations": [{**x, "lanes": x["lanes"] | {"M": "main-1"}} for x in data["refutations"]]},
        {"dt": "0"},
        {"dt": "7/10"},
        {"horizon": "-1"},
    ):
        assert accepted(tmp_path, data | change).outcome is Acceptance.UNREADABLE, change


def test_what_names_do_not_say_is_told(tmp_path):
    data = none_within_data(none_within("atLane(SV, L) and v_lon(SV) > 40.5 m/s"))
    assert len(accepted(tmp_path, data).checked) == 1
    [model], road = data["vehicles"].values(), data["road"]
    for change, told in (
        ({"vehicles": {"SV": model | {"v_lon": ["15", "20"]}}}, "SV=car with v_lon=15..20"),
        ({"vehicles": {"SV": model | {"kind": "bus"}}}, "SV=car with kind=bus"),
        ({"vehicles": {"SV": model | {"name": "mine"}}}, "SV=mine with length=9/2, width=9/5, v_lon=15..40"),
        ({"road": road | {"name": "main-9"}}, "road main-9 as in the file, with 2 lanelets"),
        ({"road": road | {"lanelets": road["lanelets"][:1], "adjacent": []}}, "road main-2 as in the file"),
    ):
        finding = accepted(tmp_path, data | change | _of_one_lane(change, data))
        assert finding.outcome is Acceptance.ACCEPTED, finding.reason
        assert finding.checked[1].startswith(told)


def _of_one_lane(change, data):
    """The refutations for the lanes that a changed road has."""
    lanes = {x["lane"] for x in change.get("road", data["road"])["lanelets"]}
    return {"refutations": [x for x in data["refutations"] if set(x["lanes"].values()) <= lanes]}


def test_the_scenario_of_a_file_is_that_of_its_formula(tmp_path):
    data = none_within_data(none_within("atLane(SV, L) and v_lon(SV) > 40.5 m/s"))
    finding = accepted(tmp_path, data | {"scenario": 4})
    assert finding.outcome is Acceptance.REJECTED
    assert "scenario=4, but its formula is another" in finding.reason


def test_a_file_says_every_reading_and_value_of_its_question(tmp_path):
    data = none_within_data(none_within("rssViolation(SV, POV) and v_lon(SV) > 41 m/s"))
    for name in ("rho", "lateral_sign"):
        left = {x: value for x, value in data["parameters"].items() if x != name}
        finding = accepted(tmp_path, data | {"parameters": left})
        assert finding.outcome is Acceptance.REJECTED
        assert finding.reason == f"it does not say with which {name} it was judged"


def test_a_missing_assignment_of_lanes_is_told():
    file = none_within("given M: lane: atLane(SV, L) and atLane(SV, M) and v_lon(SV) > 41 m/s")
    assert len(file.refutations) == 4
    with pytest.raises(InputError, match="an assignment of lanes is missing"):
        derive(replace(file, refutations=file.refutations[1:]), bundled_library())
    # With both lanes fixed it says less, and its limits name them.
    one = derive(replace(file, refutations=file.refutations[:1]), bundled_library())
    assert "lane L=main-1, M=main-1" in one.limits


def test_a_file_of_many_free_lanes_is_refused_at_once(tmp_path):
    data = none_within_data(none_within("v_lon(SV) > 41 m/s"))
    names = [f"L{k}" for k in range(40)]
    tree = data["refutations"][0]["tree"]
    some = [{"lanes": dict.fromkeys(names, lane), "tree": tree} for lane in ("main-1", "main-2")]
    many = {"formula": f"given {', '.join(names)}: lane: v_lon(SV) > 41 m/s", "refutations": some}
    finding = accepted(tmp_path, data | many)
    assert finding.outcome is Acceptance.UNREADABLE
    assert "an assignment of lanes is missing" in finding.reason


@pytest.mark.parametrize(
    "lines", [["sum node 1"], ["sum near 1 * 2"], ["cut 1 2", "sum node 1 * 1"], ["cases 1 x"], []]
)
def test_lines_that_are_no_tree_are_refused(lines):
    with pytest.raises(InputError, match="tree"):
        tree_of(lines, "it")


def test_a_tree_is_read_as_it_was_written():
    leaf = WeightedSum(
        ((Fact("corner", 3, (0, 1)), 5), (Fact("equal", 1), -2), (Fact("tangent", 0, (-7, 0)), 1))
    )
    tree = CaseSplit(
        4, (ColumnSplit(1, -3, leaf, WeightedSum(((Fact("node", 2), 1),))), leaf, CaseSplit(2, ()))
    )
    assert tree_of([*lines_of(tree)], "it") == tree


def test_witness_writes_it_and_check_accepts_it(tmp_path, capsys):
    out = tmp_path / "out"
    words = ["witness", "v_lon(SV) > 41 m/s", "--horizon", "1.8", "--out", str(out), "--no-pictures"]
    assert main([*words, "--jobs", "1"]) == ExitCode.UNEXPECTED
    assert "written to" in capsys.readouterr().out
    assert [x.name for x in out.glob("none-within-*")] == ["none-within-formula-01-base.json"]
    assert main(["check", str(out), "--jobs", "1"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("NONE-WITHIN base  v_lon(SV) > 41 m/s  [no drive on road main-2")
    assert "not checked: the encoder" in said
    assert said.endswith("\n1 of 1 accepted by exact integer arithmetic\n")
    rp.prove("true", jobs=1, out=tmp_path / "proof")
    both = str(rp.check(tmp_path, jobs=1)).splitlines()[-1]
    assert both == "2 of 2 accepted by z3, the exact judge and exact integer arithmetic"
    findings = rp.check(tmp_path, jobs=1).findings
    asked = [replace(x, kernel="accepted") for x in findings]
    tree = [x for x in asked if x.verdict == "NONE-WITHIN"]
    assert checkers(tree, "coq") == "coq and exact integer arithmetic"
    assert checkers(asked, "coq") == "coq, the exact judge and exact integer arithmetic"
    assert checkers([x for x in asked if x not in tree], "coq") == "coq and the exact judge"


def test_readings_that_are_not_usual_are_told(tmp_path):
    claims = tmp_path / "claims"
    for reading, told in (("rss", False), ("literal", True)):
        using = rp.load(options={"lateral_sign": reading})
        rp.prove("danger(SV,POV) -> danger(SV,POV)", using=using, out=claims / reading, jobs=1)
        rp.witness(
            "rssViolation(SV,POV)", using=using, out=claims / reading / "drive", pictures=False, jobs=1
        )
        found = rp.check(claims / reading, jobs=1).findings
        assert {x.verdict for x in found} == {"PROVED", "WITNESSED"}
        assert [x.checked[-1:] == ("read with lateral_sign=literal",) for x in found] == [told] * len(found)


def test_names_of_a_file_begin_no_line_of_check_and_steer_no_terminal(tmp_path, capsys):
    found = refute_with_trees(search_for(QUESTIONS[0], **SHORT))
    assert found is not None
    named = {name: replace(x, name="car\nPROVED    P1 \x1b[31m") for name, x in found.vehicles.items()}
    data = none_within_data(replace(found, vehicles=named))
    (tmp_path / "none-within-formula-01-base.json").write_text(json.dumps(data))
    assert main(["check", str(tmp_path), "--quiet"]) == ExitCode.AS_EXPECTED
    first, *_, last = capsys.readouterr().out.splitlines()
    assert r"vehicles SV=car\nPROVED    P1 \x1b[31m" in first
    assert last == "1 of 1 accepted by exact integer arithmetic"
