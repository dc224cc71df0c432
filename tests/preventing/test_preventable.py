"""Plates: exact lines, drives on both sides, lemmas, and evidence that cannot be exchanged."""

import json
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

import roadproof as rp
from preventing.read import boundary, specification, values
from roadproof.analysis.study.evidence_store import EvidenceStore
from roadproof.drivers.driving import DriverSettings
from roadproof.drivers.lemmas import lemmas_for
from roadproof.drivers.lines import SIDES
from roadproof.drivers.manoeuvres import CUT_IN, CUT_OUT, DECELERATION, KMH, MANOEUVRES, Plane, line
from roadproof.drivers.models import MODELS, manoeuvre_of, models_for
from roadproof.engines.search.beside import beside_boundary, first_drive, judged_drive
from roadproof.evidence.certificate import read_certificate
from roadproof.frontends.cli.main import main
from roadproof.frontends.report import preventable as report
from roadproof.logic import parse
from roadproof.logic.parse import parse_claim
from roadproof.reasons import Reason, Why
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.truth import Cut, TruthSet, union

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
    from roadproof.drivers.driving import drive_of

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
    study = rp.preventable("cut-in", ["r157"], using=home, lines=2, lemmas=False).study
    lemma = next(x for x in lemmas_for("cut-in", models_for("cut-in", ("r157",))) if x.name == "r157-faster")
    shelf, read = EvidenceStore(tmp_path / "kept", study.question), list[str]()
    honest = parse._parse
    monkeypatch.setattr(parse, "_parse", lambda text, *more: read.append(text) or honest(text, *more))
    parse_claim.cache_clear()
    ((name, answer),) = study.settle(lemma).items()
    study.record(name, answer, shelf)
    assert read == ["r157_braking = 6 m/s^2"]
    kept = read_certificate(tmp_path / "kept" / f"{name}.json")
    assert kept == answer.certificate
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
    assert (found.kind, len(places) > 3) == (Why.PASSED, True)
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
    assert len(checked.rows()) == 2 + len(lemmas_for("cut-in", models_for("cut-in", ("r157",))))


def test_another_drive_in_its_place_is_told(folder, tmp_path):
    out = tmp_path / "forged"
    copy(folder, out)
    index = json.loads((out / "index.json").read_text("utf-8"))
    shown = index["plates"][0]["shown"]
    shown[0]["drive"], shown[1]["drive"] = shown[1]["drive"], shown[0]["drive"]
    (out / "index.json").write_text(json.dumps(index), "utf-8")
    assert rp.check(out).exit_code != 0


def test_another_driver_spec_beside_it_is_told(folder, tmp_path):
    out = tmp_path / "forged"
    copy(folder, out)
    spec = out / "driver.spec"
    spec.write_text(spec.read_text("utf-8").replace("0.35 s", "0.36 s"), "utf-8")
    checked = rp.check(out)
    assert checked.exit_code != 0
    assert "is not the file of that name that comes with roadproof" in str(checked)


def test_what_is_said_to_have_no_say_is_checked(folder, tmp_path):
    index = json.loads((folder / "index.json").read_text("utf-8"))
    assert index["idle"] == []
    copy(folder, tmp_path / "forged")
    (tmp_path / "forged" / "index.json").write_text(json.dumps(index | {"idle": ["cc_delay=1"]}), "utf-8")
    checked = rp.check(tmp_path / "forged")
    assert checked.exit_code != 0
    assert "what no boundary depends on is nothing that was chosen" in str(checked)
    copy(folder, tmp_path / "before")
    del index["idle"]
    (tmp_path / "before" / "index.json").write_text(json.dumps(index), "utf-8")
    assert rp.check(tmp_path / "before").exit_code == 0


def test_a_line_that_is_not_where_the_formula_holds_is_told(folder, tmp_path):
    index = json.loads((folder / "index.json").read_text("utf-8"))
    for number, change in enumerate((_moved, _without_a_line, _other_row)):
        out = tmp_path / f"forged-{number}"
        copy(folder, out)
        forged = json.loads(json.dumps(index))
        change(forged["plates"][0]["lines"])
        (out / "index.json").write_text(json.dumps(forged), "utf-8")
        checked = rp.check(out)
        assert checked.exit_code != 0
        assert "plate r157-" in str(checked)


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
    index = json.loads((tmp_path / "index.json").read_text("utf-8"))
    index["plates"][0]["shown"][0]["scenario"] = f"scenario_{number}(SV, POV)"
    (tmp_path / "index.json").write_text(json.dumps(index), "utf-8")
    assert rp.check(tmp_path).exit_code != 0


def copy(source: Path, target: Path) -> None:
    for path in source.rglob("*"):
        if path.is_file():
            (target / path.relative_to(source)).parent.mkdir(parents=True, exist_ok=True)
            (target / path.relative_to(source)).write_bytes(path.read_bytes())


def test_a_run_goes_on_where_it_was(folder):
    before = {path.name: path.read_bytes() for path in (folder / "answers").iterdir()}
    again = rp.preventable("cut-in", ["r157"], at={"Ve0": "60 km/h", "Vy": 1}, lines=5, jobs=1, out=folder)
    assert {path.name: path.read_bytes() for path in (folder / "answers").iterdir()} == before
    assert len(again.plates) == 1
    assert again.plates[0].lines[-1].spans


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
    monkeypatch.setattr(report, "_draw_plate", lambda axes, study, here: drawn.append([x.name for x in here]))
    at = {"Ve0": ["60 km/h", "90 km/h"], "Vy": [1, 2], "dy0": [1, 2]}
    found = rp.preventable("cut-in", ["r157", "eu1426"], at=at, lines=2, lemmas=False, jobs=1)
    report.draw_sheet(found.question, found.plates)
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


def a_place(plate: Any, other: Any) -> None:
    plate["shown"][0]["at"]["dx0"] = "100"


def a_fixed_value(plate: Any, other: Any) -> None:
    plate["fixed"]["Vy"] = "3/2"


def the_drives_of_the_other_plate(plate: Any, other: Any) -> None:
    for mine, theirs in zip(plate["shown"], other["shown"], strict=True):
        mine.update(theirs)


def the_other_side(plate: Any, other: Any) -> None:
    one, two = plate["shown"]
    one["side"], two["side"] = two["side"], one["side"]


def another_model(plate: Any, other: Any) -> None:
    plate["model"] = "careful"
    plate["name"] = plate["name"].replace("r157", "careful")


def a_controller(plate: Any, other: Any) -> None:
    """Lines of a controller are not worked out again: an exact plate may not pass for one."""
    plate["stepped"] = "each place is decided by a drive"


def no_side(plate: Any, other: Any) -> None:
    del plate["shown"][0]


def a_place_off_the_plate(plate: Any, other: Any) -> None:
    plate["shown"][0]["at"]["dV0"] = "1"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (a_place, "its formula is not|but the plate says"),
        (a_fixed_value, "its name is"),
        (the_drives_of_the_other_plate, "are not those of the plate"),
        (the_other_side, "but its formula is not"),
        (another_model, "but that of its model is"),
        (a_controller, "'stepped' does not go with"),
        (no_side, "but has to show"),
        (a_place_off_the_plate, "is not on the plate"),
    ],
)
def test_a_changed_plate_is_rejected(
    change: Callable[[Any, Any], None], told: str, plates: Path, tmp_path: Path
) -> None:
    out = tmp_path / "forged"
    copytree(plates, out)
    index = json.loads((out / "index.json").read_text("utf-8"))
    change(*index["plates"])
    (out / "index.json").write_text(json.dumps(index), "utf-8")
    checked = rp.check(out)
    assert checked.exit_code == 10
    assert any(x in str(checked) for x in told.split("|"))


def test_the_folder_is_accepted(plates: Path) -> None:
    assert rp.check(plates).exit_code == 0
