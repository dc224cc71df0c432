"""Plates: exact lines, drives on both sides, lemmas, and evidence that cannot be exchanged."""

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

import roadproof as rp
from extensions.drivers.read import boundary, specification, values
from roadproof.engines.search.batches import Engines
from roadproof.evidence.answer_codec import answer_data, read_answer
from roadproof.evidence.strict import read_json
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.lines import SIDES
from roadproof.extensions.drivers.manoeuvres import (
    CUT_IN,
    CUT_OUT,
    DECELERATION,
    KMH,
    MANOEUVRES,
    Plane,
    line,
)
from roadproof.extensions.drivers.models import MODELS, lemmas_for, manoeuvre_of, models_for
from roadproof.extensions.drivers.preventable import drawing
from roadproof.extensions.drivers.preventable.beside import beside_boundary, first_drive, judged_drive
from roadproof.extensions.drivers.preventable.question import PreventableQuestion
from roadproof.frontends.cli.main import main
from roadproof.logic import parse
from roadproof.logic.parse import parse_claim
from roadproof.questions.store import Store
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.files import write_json
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.truth import Cut, TruthSet, union
from roadproof.verdict import Verdict

OPTIONS = (
    {},
    {"cc_perception": "distance"},
    {"cc_perception": "overlap"},
    {"cc_gate": "before_perception"},
    {"cc_gate": "before_delay"},
    {"cc_threshold": "hard"},
)
EACH = [(m, model.name, {}) for m in MANOEUVRES for model in models_for(m)]
EACH += [("cut-in", "careful", x) for x in OPTIONS[1:5]] + [("deceleration", "careful", OPTIONS[5])]


def plane(manoeuvre: str, lines: int = 5, **fixed: Fraction) -> Plane:
    kind = MANOEUVRES[manoeuvre]
    high = min(kind.range[1], kind.quantities["Ve0"].value) if kind.across == "dV0" else kind.range[1]
    return Plane(kind, fixed, kind.along, (kind.range[0], high), lines)


def lines_of(manoeuvre: str, model: str, options: dict[str, str], where: Plane) -> tuple[TruthSet, ...]:
    formula = boundary(manoeuvre, model, **options)
    return tuple(line(where, formula, row) for row in where.rows)


@pytest.mark.parametrize(("manoeuvre", "model", "options"), EACH)
def test_drives_on_both_sides_are_within_a_span_of_the_boundary(manoeuvre, model, options):
    where = plane(manoeuvre)
    true = lines_of(manoeuvre, model, options, where)
    home = specification(**options)
    for side in SIDES:
        found = first_drive(
            where,
            model,
            beside_boundary(where, true, side),
            side,
            home,
            DriverSettings(values(), home.options),
        )
        assert not isinstance(found, str), found
        at, judged = found
        assert side in judged.file.formula
        assert at["Ve0"] == judged.file.drive.vehicles["SV"].v_lon


@pytest.mark.parametrize(("manoeuvre", "model", "options"), EACH[:7])
def test_a_drive_on_the_wrong_side_is_rejected(manoeuvre, model, options):
    where = plane(manoeuvre)
    true = lines_of(manoeuvre, model, options, where)
    home = specification(**options)
    reading = DriverSettings(values(), home.options)
    for side, other in (SIDES, SIDES[::-1]):
        found = first_drive(where, model, beside_boundary(where, true, side), side, home, reading)
        assert not isinstance(found, str)
        with pytest.raises(rp.InputError, match="does not hold on the drive"):
            judged_drive(where.manoeuvre, model, found[0], other, home, reading)


@pytest.mark.parametrize("changed", ["cc_delay", "cc_ramp", "cc_braking", "cc_wander", "cc_evaluation"])
def test_a_driver_with_another_constant_is_not_the_model(changed):
    """The drive is made with one value, and judged with the other."""
    home = specification()
    other = values() | {changed: values()[changed] * Fraction(101, 100)}
    given = CUT_IN.values({"dx0": Fraction(30)})
    judged = judged_drive(
        CUT_IN, "careful", given, "preventable", home, DriverSettings(values(), home.options)
    )
    assert judged.file.values[changed] == values()[changed]
    from roadproof.extensions.drivers.driving import drive_of

    wrong = drive_of(CUT_IN, "careful", given, DriverSettings(other, home.options))
    from dataclasses import replace

    from roadproof.evidence.judged import judge_file

    assert judge_file(judged.file, home.library).accepted
    assert not judge_file(replace(judged.file, drive=wrong), home.library).accepted


def test_the_closed_form_of_a_cut_in():
    """u·theta + u²/(2A) - c, and the place from which POV has been passed; computed apart."""
    u, vy = 40 * KMH, Fraction(1)
    braking, ramp = Fraction("7.59294"), Fraction("0.6")
    theta = Fraction("0.375") / vy + Fraction("1.15") + ramp / 2
    expected = u * theta + u**2 / (2 * braking) - braking * ramp**2 / 24
    where = plane("cut-in")
    true = line(where, boundary("cut-in", "careful"), u)
    assert true.cuts[-1].point == expected


def test_two_seconds_suffice_for_every_braking_to_1_g_and_130_kmh():
    for speed in (30, 60, 100, 130):
        where = plane("deceleration", 40, Ve0=speed * KMH)
        for true in lines_of("deceleration", "careful", {}, where):
            assert not true.at(2 * speed * KMH)


def test_a_leader_that_brakes_gently_is_never_perceived_under_the_letter():
    where = plane("deceleration", 3)
    gentle = line(where, boundary("deceleration", "careful", cc_threshold="hard"), Fraction("4.9"))
    hard = line(where, boundary("deceleration", "careful", cc_threshold="hard"), Fraction(5))
    assert gentle.at(Fraction(80))
    assert not hard.at(Fraction(80))


def test_lemmas_name_values_of_the_model_that_they_are_about():
    names = {x.name for x in lemmas_for("cut-in", tuple(MODELS.values()))}
    assert {"careful-greatest", "r157-greatest", "careful-falls-slow"} <= names
    assert "r157-falls-slow" not in names  # it has no ramp


def test_a_lemma_is_the_tree_of_its_text():
    for name, joined in (
        ("cut-in", "none"),
        ("cut-in", "add"),
        ("cut-out", "none"),
        ("deceleration", "none"),
    ):
        lemmas = lemmas_for(name, models_for(name), joined)
        assert lemmas or name == "deceleration"
        assert [x.tree for x in lemmas] == [parse_claim(x.claim) for x in lemmas]


def test_a_lemma_is_proved_and_kept_without_reading_its_text(monkeypatch, tmp_path):
    """Trees are handed on: of all texts only values of parameters are parsed, as evidence has them."""
    home = rp.load(specs=["driver"])
    asked = rp.preventable("cut-in", ["r157"], using=home, lines=2, lemmas=False).question
    question = replace(asked, with_lemmas=True)
    assert "lemma-r157-faster" in question.lemmas  # whose trees are made of their file
    read = list[str]()
    honest = parse._parse
    monkeypatch.setattr(parse, "_parse", lambda text, *more: read.append(text) or honest(text, *more))
    parse_claim.cache_clear()
    claim = question.lemma_claim("lemma-r157-faster")
    answer, _ = Engines(question.work).answer_claim(claim)
    answer = Store(tmp_path, "preventable", question.work).whole(answer)
    assert answer.verdict is Verdict.PROVED
    write_json(tmp_path / "lemma.json", answer_data(answer))
    assert read == ["r157_braking = 6 m/s^2"]
    kept = read_answer(claim, read_json(tmp_path / "lemma.json"), "it").evidence
    assert read == ["r157_braking = 6 m/s^2"]
    assert kept == answer.evidence
    assert kept.tableau is not None
    assert kept.query is None  # which is read of the text again, by whoever rests on it


def test_a_false_lemma_is_refuted():
    claim = next(
        x for x in lemmas_for("cut-in", models_for("cut-in", ("r157",))) if x.name == "r157-greatest"
    )
    false = claim.claim.replace("-> gains(v, w, g,", "-> gains(v, w, g + 1 m,")
    assert false != claim.claim
    answer = rp.prove(false, using=rp.load(specs=["driver"]), declared=True, jobs=1)
    assert str(answer.verdict) == "REFUTED"


def test_the_response_of_rss_is_at_its_own_speed_until_it_begins():
    """With the speed after the response taken for the time before it, too, as once was said, it is false."""
    lemma = next(x for x in lemmas_for("cut-in", models_for("cut-in", ("rss",))) if x.name == "rss-response")
    right = "rss_gains(v, w, g, q*W, W)"
    wrong = "gains(v + a_max*rho, w, g + a_max*rho^2/2, q + rho, 1, 0 s, b_min)"
    assert right in lemma.claim
    home = rp.load(specs=["driver"])
    verdicts = [
        str(rp.prove(claim, using=home, declared=True, jobs=1).verdict)
        for claim in (lemma.claim, lemma.claim.replace(right, wrong))
    ]
    assert verdicts == ["PROVED", "REFUTED"]


def test_a_boundary_that_a_drive_contradicts_is_told():
    """Not passed over for another place: the formula, or the motion, is wrong."""
    where = plane("cut-in")
    true = lines_of("cut-in", "careful", {}, where)
    farther = tuple(union([x, moved_by(x, 2)]) for x in true)
    home = specification()
    places = beside_boundary(where, farther, "unpreventable")
    found = first_drive(
        where, "careful", places, "unpreventable", home, DriverSettings(values(), home.options)
    )
    assert isinstance(found, str)
    assert "is not unpreventable, as the boundary says it is: " in found


def test_places_of_which_no_drive_is_to_be_expected_contradict_nothing():
    """A gate that opens when the boxes meet: SV has passed POV and is hit from behind, or never brakes."""
    options, other = {"cc_gate": "before_perception"}, {"cc_ttc": Fraction(0)}
    where = plane("cut-in", Ve0=Fraction(25))
    formula = boundary("cut-in", "careful", other, **options)
    true = tuple(line(where, formula, row) for row in where.rows)
    home = specification(**options)
    reading = DriverSettings(values() | other, home.options)
    places = [*beside_boundary(where, true, "preventable")]
    found = first_drive(where, "careful", places, "preventable", home, reading)
    assert isinstance(found, Reason)
    assert (found.kind, len(places) > 3) == (ReasonKind.PASSED, True)
    for at in places:
        with pytest.raises(rp.InputError, match="does not hold on the drive"):
            judged_drive(where.manoeuvre, "careful", at, "preventable", home, reading)


def moved_by(true: TruthSet, metres: int) -> TruthSet:
    return TruthSet(tuple(Cut(moved(cut.point, Fraction(metres)), cut.after) for cut in true.cuts))


def test_manoeuvres_by_name_and_by_scenario():
    assert [manoeuvre_of(x) for x in ("1", "scenario_2", "4", "6", "cut-in")] == [
        ("cut-in", 1),
        ("cut-out", 2),
        ("deceleration", 4),
        ("cut-out", 6),
        ("cut-in", None),
    ]
    with pytest.raises(rp.UsageError, match=r"'3' is not a manoeuvre .* cut-in \(scenarios 1, 5\)"):
        manoeuvre_of("3")


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["cut-in", "--model", "carefull"], "there is no driver model 'carefull'; did you mean 'careful'?"),
        (["cut-out", "--model", "r157"], "says nothing of a cut-out; these do: careful"),
        (["cut-in", "--at", "Vy=0"], "Vy=0 (SI): the lateral speed of POV has to be > 0"),
        (["cut-in", "--at", "dx=3"], "there is no initial value of a cut-in 'dx'"),
        (["cut-in", "--at", "dx0=3"], "dx0 varies on the plate"),
        (["cut-in", "--along", "dx0=-3:5"], "the gap along the road has to be >= 0"),
        (["cut-in", "--along", "dx0=5:5"], "the range is empty"),
        (["cut-in", "--along", "Vy=1:5"], "this plate varies dx0"),
        (["cut-in", "--at", "Ve0"], "write NAME=VALUE"),
        (["deceleration", "--at", "dV0=200km/h"], "SV cannot be more than Ve0"),
        (["cut-in", "--param", "cc_delay=-1"], "cc_delay"),
        (["cut-in", "--param", "cc_braking=0"], "cc_braking"),
        (["cut-in", "--param", "cc_sleep=1"], "cc_sleep"),
        (["cut-in", "--option", "cc_gate=maybe"], "cc_gate"),
        (["cut-in", "--lines", "1"], "--lines"),
    ],
)
def test_mistakes_are_named(words, told, capsys):
    assert main(["preventable", *words, "--no-lemmas"]) in (2, 3)
    assert told in " ".join(capsys.readouterr().err.split())


def test_a_boundary_of_what_no_initial_value_says_is_a_mistake_of_usage(tmp_path, capsys):
    text = 'signal wet(a: vehicle): m in [0, 5] "water"\n'
    text += "def unpreventable_cutIn_careful(SV, POV: vehicle) := wet(SV) > 1 m\n"
    (tmp_path / "wet.spec").write_text(text)
    files = ["--spec", "driver", "--spec", str(tmp_path / "wet.spec")]
    assert main(["preventable", "cut-in", *files, "--model", "careful", "--no-lemmas"]) == 2
    assert "the initial values do not define wet(SV)" in capsys.readouterr().err


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("plates")
    found = rp.preventable("cut-in", ["r157"], at={"Ve0": "60 km/h", "Vy": 1}, lines=5, jobs=1, out=out)
    found.add_files(False)
    assert found.exit_code == 0
    return out


def test_check_accepts_it(folder):
    checked = rp.check(folder)
    assert checked.exit_code == 0
    assert len(checked.rows()) == 3 + len(lemmas_for("cut-in", models_for("cut-in", ("r157",))))


def test_another_drive_in_its_place_is_told(folder, tmp_path):
    out = tmp_path / "forged"
    copy(folder, out)
    first, second = sorted(out.glob("r157-*preventable.json"))
    content = first.read_bytes()
    first.write_bytes(second.read_bytes())
    second.write_bytes(content)
    assert rp.check(out).exit_code != 0


def test_another_driver_spec_beside_it_is_told(folder, tmp_path):
    out = tmp_path / "forged"
    copy(folder, out)
    spec = out / "driver.spec"
    spec.write_text(spec.read_text("utf-8").replace("0.35 s", "0.36 s"), "utf-8")
    checked = rp.check(out)
    assert checked.exit_code != 0
    assert "is not the file of that name that comes with roadproof" in str(checked)


def test_a_line_that_is_not_where_the_formula_holds_is_told(folder, tmp_path):
    for number, change in enumerate((_moved, _without_a_line, _other_row)):
        out = tmp_path / f"forged-{number}"
        copy(folder, out)
        with_changed(out / "r157-Ve0-50_3-Vy-1.json", lambda x, change=change: change(x["lines"]))
        checked = rp.check(out)
        assert checked.exit_code == 10
        assert "r157-Ve0-50_3-Vy-1.json: it " in str(checked)


def with_changed(path: Path, change: Callable[[Any], object]) -> None:
    """Change the content of a file."""
    content = json.loads(path.read_text("utf-8"))
    change(content)
    path.write_text(json.dumps(content), "utf-8")


def _moved(lines):
    lines[-1]["unpreventable"][0][1]["exact"] = "50"


def _without_a_line(lines):
    del lines[2]


def _other_row(lines):
    lines[1]["at"] = "1/2"


@pytest.mark.parametrize(
    ("number", "at", "told"),
    [
        (1, {"dy0": "2.2 m", "Vy": "0.5 m/s"}, ("scenario_1(SV, POV, L)",) * 2),
        (1, {"Vy": "1 m/s"}, ("disturb_1(SV, POV, L)", "scenario_1(SV, POV, L)")),
        (2, {}, ("scenario_2(SV, POV1, POV2, L)",) * 2),
        (4, {"dV0": "10 km/h"}, ("disturb_4(SV, POV, L)", "scenario_4(SV, POV, L)")),
        (6, {}, ("", "")),
    ],
)
def test_drives_are_of_the_scenario_that_is_asked_for(number, at, told, tmp_path):
    found = rp.preventable(
        number, ["careful"], at={"Ve0": "60 km/h"} | at, lines=25, lemmas=False, jobs=1, out=tmp_path
    )
    shown = found.plates[0].shown
    assert tuple(x.scenario for x in shown) == told
    for x in shown:
        assert x.drive is not None
        assert x.drive.file.formula.endswith(f" and {x.scenario}") == bool(x.scenario)
    assert rp.check(tmp_path).exit_code == 0
    other = {1: 4, 2: 1, 4: 1, 6: 4}[number]
    with_changed(tmp_path / "question.json", lambda x: x["asked"].update(scenario=other))
    checked = rp.check(tmp_path)
    assert checked.exit_code == 10
    assert f"scenario {other} is no" in str(checked)


def copy(source: Path, target: Path) -> None:
    for path in source.rglob("*"):
        if path.is_file():
            (target / path.relative_to(source)).parent.mkdir(parents=True, exist_ok=True)
            (target / path.relative_to(source)).write_bytes(path.read_bytes())


def test_a_run_goes_on_where_it_was(folder):
    before = {path.name: path.read_bytes() for path in folder.glob("*.json")}
    again = rp.preventable("cut-in", ["r157"], at={"Ve0": "60 km/h", "Vy": 1}, lines=5, jobs=1, out=folder)
    assert {path.name: path.read_bytes() for path in folder.glob("*.json")} == before
    assert len(again.plates) == 1
    assert again.plates[0].lines[-1].spans
    assert not again.found.costs


def test_the_table_has_a_row_for_each_span(folder):
    rows = (folder / "plates.csv").read_text("utf-8").splitlines()
    assert rows[0].startswith("model,Ve0,Vy,dV0,dx0_from,dx0_to")
    assert len(rows) > 3


def test_touching_is_at_the_edges():
    sizes = "length(SV) = length(POV) and width(SV) = width(POV)"
    same = f"s(SV) = s(POV) - length(POV) and d(SV) = d(POV) and {sizes}"
    answer = rp.prove(f"{same} -> touches(SV, POV)", using=rp.load(specs=["driver"]), jobs=1)
    assert str(answer.verdict) == "PROVED"


def test_every_manoeuvre_has_vehicles_that_its_formula_speaks_of():
    for kind in (CUT_IN, CUT_OUT, DECELERATION):
        assert kind.vehicles[0] == "SV"


def test_a_side_that_has_no_place_with_few_digits_is_shown_all_the_same():
    where = Plane(CUT_IN, {}, (Fraction(15), Fraction("15.004")), (30 * KMH, 31 * KMH), 2)
    true = lines_of("cut-in", "careful", {}, where)
    assert all(x.at(Fraction("15.002")) for x in true)
    places = [x["dx0"] for x in beside_boundary(where, true, "unpreventable")]
    assert places[0] == Fraction("15.002")
    assert all(15 < x < Fraction("15.004") for x in places)
    assert not list(beside_boundary(where, true, "preventable"))


def test_no_two_plates_of_a_model_are_drawn_over_each_other(monkeypatch):
    drawn: list[list[str]] = []
    monkeypatch.setattr(
        drawing, "_draw_plate", lambda axes, study, here: drawn.append([x.name for x in here])
    )
    at = {"Ve0": ["60 km/h", "90 km/h"], "Vy": [1, 2], "dy0": [1, 2]}
    found = rp.preventable("cut-in", ["r157", "eu1426"], at=at, lines=2, lemmas=False, jobs=1)
    drawing.draw_sheet(found.question, found.plates)
    assert sorted(name for names in drawn for name in names) == sorted(found.question.plates)
    assert [len(names) for names in drawn] == [2] * 8


@pytest.mark.parametrize(
    ("manoeuvre", "models", "options", "parameters", "told"),
    [
        ("deceleration", "careful", {"cc_aeb": "max"}, {}, ["cc_aeb=max"]),
        ("deceleration", "careful", {"cc_threshold": "hard"}, {"cc_delay": 1}, []),
        ("cut-in", "careful", {"cc_aeb": "max"}, {"aeb_braking": 9}, []),
        (
            "cut-in",
            "careful",
            {"cc_threshold": "hard"},
            {"aeb_braking": 9},
            ["cc_threshold=hard", "aeb_braking=9"],
        ),
        ("cut-in", "r157", {}, {"cc_delay": 1}, ["cc_delay=1"]),
        ("cut-in", "r157,careful", {}, {"cc_delay": 1}, []),
        (
            "cut-in",
            "fsm",
            {"cc_perception": "overlap"},
            {"cc_delay": 1},
            ["cc_perception=overlap", "cc_delay=1"],
        ),
        ("cut-in", "careful", {"lateral_sign": "literal"}, {"minSafe": "0.6 s"}, ["lateral_sign=literal"]),
    ],
)
def test_what_is_chosen_and_has_no_say_is_told(manoeuvre, models, options, parameters, told, capsys):
    words = [
        "preventable",
        manoeuvre,
        "--model",
        models,
        "--lines",
        "2",
        "--no-lemmas",
        "--jobs",
        "1",
        "--quiet",
    ]
    words += ["--at", "Ve0=60 km/h", *(["--at", "Vy=1"] if manoeuvre == "cut-in" else [])]
    words += [x for name, value in options.items() for x in ("--option", f"{name}={value}")]
    words += [x for name, value in parameters.items() for x in ("--param", f"{name}={value}")]
    main([*words, "--json", "-"])
    assert json.loads(capsys.readouterr().out)["idle"] == told
    main(words)
    said = capsys.readouterr().out
    assert [x.split(":")[0] for x in said.splitlines() if "no boundary that is asked for" in x] == told
    others = [x for x in (*options, *parameters) if all(not y.startswith(f"{x}=") for y in told)]
    shown = [x.partition("=")[0] for x in said.partition("\nwith ")[2].partition("\n")[0].split(", ") if x]
    assert shown == [x for x in others if x != "minSafe"]  # 0.6 s is its declared value


# --- Plates of which one thing was changed: ``check`` says what does not fit ------------------------


@pytest.fixture(scope="module")
def plates(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("plates")
    at = {"Ve0": ["60 km/h", "90 km/h"], "Vy": 1}
    rp.preventable("cut-in", ["r157"], at=at, lines=3, lemmas=False, jobs=1, out=out)
    return out


ONE, OTHER = "r157-Ve0-50_3-Vy-1", "r157-Ve0-25-Vy-1"


def a_place(out: Path) -> None:
    with_changed(out / f"{ONE}-preventable.json", lambda x: x["vehicles"]["POV"].update(s="1000"))


def a_fixed_value(out: Path) -> None:
    with_changed(out / f"{ONE}.json", lambda x: x["plate"]["fixed"].update(Vy="3/2"))


def the_drives_of_the_other_plate(out: Path) -> None:
    for side in SIDES:
        (out / f"{ONE}-{side}.json").write_bytes((out / f"{OTHER}-{side}.json").read_bytes())


def the_other_side(out: Path) -> None:
    one, two = (out / f"{ONE}-{side}.json" for side in SIDES)
    content = one.read_bytes()
    one.write_bytes(two.read_bytes())
    two.write_bytes(content)


def another_model(out: Path) -> None:
    with_changed(out / f"{ONE}.json", lambda x: x["plate"].update(model="careful"))


def a_controller(out: Path) -> None:
    with_changed(out / f"{ONE}.json", lambda x: x["plate"].update(model="fsm"))


def another_parameter(out: Path) -> None:
    with_changed(out / f"{ONE}.json", lambda x: x["parameters"].update(r157_braking="5"))


def a_line_more(out: Path) -> None:
    with_changed(out / "question.json", lambda x: x["asked"].update(lines=4))


def another_name(out: Path) -> None:
    (out / f"{ONE}.json").rename(out / "r157-Ve0-50_3-Vy-2.json")


def no_formula(out: Path) -> None:
    with_changed(out / f"{ONE}.json", lambda x: x.update(claim="F touches(SV, POV)"))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (a_place, "its drive is one of"),
        (a_fixed_value, "it is about another plate"),
        (the_drives_of_the_other_plate, "its drive is one of"),
        (the_other_side, "its drive is one of"),
        (another_model, "it is about another plate"),
        (a_controller, "it is about another plate"),
        (another_parameter, "its parameters have other values"),
        (a_line_more, "it is about another plate"),
        (another_name, "no claim of the question has this name"),
        (no_formula, "it is about F touches"),
    ],
)
def test_a_changed_plate_is_rejected(
    change: Callable[[Path], None], told: str, plates: Path, tmp_path: Path
) -> None:
    out = tmp_path / "forged"
    copytree(plates, out)
    change(out)
    checked = rp.check(out)
    assert checked.exit_code == 10
    assert told in str(checked)


def test_the_folder_is_accepted(plates: Path) -> None:
    checked = rp.check(plates)
    assert checked.exit_code == 0
    assert [x.verdict for x in checked.findings].count("DERIVED") == 2


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"lines": 1}, "below 2"),
        ({"lines": 100_000}, "lines=100000"),
        ({"fixed": {"dx0": "1"}}, "dx0 varies on the plate"),
        ({"fixed": {"Vx": "1"}}, "there is no initial value of a cut-in 'Vx'"),
        ({"models": ["r157", "r157"]}, "twice"),
        ({"along": ["5", "5"]}, "the range is empty"),
        ({"along": ["-5", "5"]}, "has to be >= 0"),
        ({"manoeuvre": "cut-out"}, "says nothing of a cut-out"),
        ({"sheet": [{"name": "Vy", "values": ["0"]}]}, "has to be > 0"),
        ({"sheet": [{"name": "Vy", "values": [f"{k}" for k in range(1, 250)]}]}, "ask for 200 at most"),
    ],
)
def test_a_question_that_nobody_can_ask_is_refused(
    change: dict[str, object], told: str, plates: Path, tmp_path: Path
) -> None:
    out = tmp_path / "forged"
    copytree(plates, out)
    with_changed(out / "question.json", lambda x: x["asked"].update(change))
    checked = rp.check(out)
    assert checked.exit_code == 10
    assert told in str(checked)


# --- Claims: each thing that a plate depends on makes another one -----------------------------------


def asked(**more: Any) -> PreventableQuestion:
    given = {"at": {"Ve0": "60 km/h", "Vy": 1}, "lines": 2, "lemmas": False, **more}
    options, params = given.pop("options", {}), given.pop("params", {})
    manoeuvre, model = given.pop("manoeuvre", "cut-in"), given.pop("model", "careful")
    home = rp.load(specs=["driver", *given.pop("specs", ())], options=options, params=params)
    found: list[PreventableQuestion] = []

    class Stopped(Exception):
        pass

    def stop(question: PreventableQuestion, *_: object) -> None:
        found.append(question)
        raise Stopped

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.frontends.api.question_answers.decide_claims", stop)
        with pytest.raises(Stopped):
            rp.preventable(manoeuvre, [model], home, jobs=1, **given)
    return found[0]


def digests(question: PreventableQuestion) -> dict[str, str]:
    """By what a claim is about, whatever the plate is called."""
    found: dict[str, str] = {}
    for name in question.plates:
        found["lines"] = question.boundary_claim(name).digest()
        found |= {side: question.side_claim(name, side).digest() for side in SIDES}
    return found


BRAKES = {"manoeuvre": "deceleration", "at": {"Ve0": "60 km/h", "dGdt": 5}}
CHANGES: list[tuple[dict[str, Any], dict[str, Any], set[str]]] = [
    ({}, {"lines": 3}, {"lines", *SIDES}),
    ({}, {"along": (0, 60)}, {"lines", *SIDES}),
    ({}, {"across": (1, 5)}, {"lines", *SIDES}),
    ({}, {"at": {"Ve0": "61 km/h", "Vy": 1}}, {"lines", *SIDES}),
    ({}, {"at": {"Ve0": "60 km/h", "Vy": 1, "length": 5}}, {"lines", *SIDES}),
    ({}, {"model": "r157"}, {"lines", *SIDES}),
    ({}, {"manoeuvre": 1}, {*SIDES}),
    *(
        ({}, {"params": {x: 4}}, {"lines", *SIDES})
        for x in ("cc_braking", "cc_delay", "cc_ramp", "cc_wander")
    ),
    ({}, {"params": {"cc_evaluation": "0.5 s"}}, {"lines", *SIDES}),
    ({}, {"options": {"cc_perception": "overlap"}}, {"lines", *SIDES}),
    ({}, {"options": {"cc_gate": "before_delay"}}, {"lines", *SIDES}),
    ({}, {"options": {"cc_aeb": "max"}}, {"lines", *SIDES}),
    (BRAKES, {"params": {"cc_delay": 1}}, {"lines", *SIDES}),
    (BRAKES, {"options": {"cc_threshold": "hard"}}, {"lines", *SIDES}),
    (BRAKES, {"at": {"Ve0": "60 km/h", "dGdt": 6}}, {"lines", *SIDES}),
    ({"manoeuvre": 1}, {"params": {"minSafe": 1}}, {*SIDES}),
    ({}, {"params": {"minSafe": 1}}, set()),
    ({}, {"params": {"aeb_braking": 9}}, {*SIDES}),
]


@pytest.mark.parametrize(("before", "change", "seen"), CHANGES)
def test_what_a_plate_depends_on_makes_other_claims(
    before: dict[str, Any], change: dict[str, Any], seen: set[str]
) -> None:
    one, other = digests(asked(**before)), digests(asked(**{**before, **change}))
    assert {x for x in one if one[x] != other[x]} == seen


def test_a_definition_that_only_drives_use_makes_other_claims(tmp_path: Path) -> None:
    """The drive is judged on how SV follows its model; no boundary says that."""
    own = tmp_path / "own.spec"
    own.write_text("def follows_cutIn_careful(a, b: vehicle, y, z: m, v: m/s) := v_lon(a) <= v\n", "utf-8")
    one, other = digests(asked()), digests(asked(specs=[own]))
    assert {x for x in one if one[x] != other[x]} == {*SIDES}
