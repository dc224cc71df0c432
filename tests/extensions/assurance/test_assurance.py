"""Cases with evidence, from the files to exit codes, paths and limits."""

import hashlib
import json
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import roadproof as rp
from roadproof.errors import InputError
from roadproof.extensions.assurance.case.case import ElementKind
from roadproof.extensions.assurance.case.reading import read_case
from roadproof.extensions.assurance.case.states import ElementState
from roadproof.extensions.assurance.case.template import EvidenceFolder, fill_template, tables
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.extensions.assurance.solutions import whole_verdict
from roadproof.frontends.cli.main import main

ROOT = Path(__file__).parents[3]
CLAIMS = ("false -> danger(SV,POV)", "v_lon(SV) > 2 m/s -> v_lon(SV) > 3 m/s")
CASE = """\
title = "Trial"
[G1]
goal = "All is well"
supported-by = ["S1"]
[S1]
strategy = "Argument by claims"
supported-by = ["G2", "G3"]
[G2]
goal = "Claims hold"
supported-by = "Sn1"
[Sn1]
solution = "Proofs"
evidence = "claims"
expect = ["PROVED", "REFUTED"]
[G3]
goal = "The review is done"
supported-by = "Sn2"
[Sn2]
solution = "Protocol of the review"
evidence = "review.txt"
sha256 = "DIGEST"
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The files of a case that holds."""
    folder = tmp_path_factory.mktemp("made")
    rp.prove(*CLAIMS, out=folder / "claims", jobs=1)
    review = b"reviewed\n"
    (folder / "review.txt").write_bytes(review)
    text = CASE.replace("DIGEST", hashlib.sha256(review).hexdigest())
    (folder / "case.toml").write_text(text, "utf-8")
    return {x.relative_to(folder).as_posix(): x.read_bytes() for x in folder.rglob("*") if x.is_file()}


@pytest.fixture
def case(made: dict[str, bytes], tmp_path: Path) -> Path:
    for name, content in made.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(content)
    return tmp_path / "case.toml"


def certificates(case: Path) -> list[Path]:
    return sorted((case.parent / "claims").glob("claim-*.json"))


def test_a_case_holds(case: Path) -> None:
    found = rp.assurance(case, jobs=1)
    assert found.exit_code == 0
    assert {*found.states.values()} == {ElementState.HOLDS}
    assert found.open_points == ()
    assert str(found).endswith("2 solutions: 2 holds; the top goal G1 holds")
    assert found.solutions["Sn1"].verdicts == {"PROVED": 1, "REFUTED": 1}


def test_limits_become_assumptions_of_the_goals_above(case: Path) -> None:
    data = rp.assurance(case, jobs=1).as_data()
    elements = {x["id"]: x for x in data["elements"]}
    assert elements["G2"]["in_context_of"] == ["Sn1.limits"]
    limits = {x["name"]: x["told"] for x in elements["Sn1.limits"]["limits"]}
    assert "lateral_sign=rss" in limits["readings"]
    assert limits["not checked"] == ["limits of vehicles"]
    assert elements["Sn2.limits"]["limits"][0]["name"] == "digest"
    assert elements["Sn1.limits"]["kind"] == "assumption"


def test_a_damaged_certificate_breaks_the_case_up_to_the_top(
    case: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = certificates(case)[0]
    path.write_text(
        path.read_text("utf-8").replace("danger", "safe", 1).replace("3 m/s", "1 m/s", 1), "utf-8"
    )
    found = rp.assurance(case, jobs=1)
    assert found.states == dict.fromkeys(("Sn1", "G2", "S1", "G1"), ElementState.BROKEN) | dict.fromkeys(
        ("Sn2", "G3"), ElementState.HOLDS
    )
    assert found.exit_code == 10
    for command in ("assurance", "check"):
        assert main([command, str(case), "--jobs", "1"]) == 10
        told = capsys.readouterr().out
        assert "broken: Sn1 -> G2 -> S1 -> G1\n" in told
        assert path.name in told


def test_a_case_does_not_hold_where_a_file_is_gone_or_no_json(case: Path) -> None:
    certificates(case)[0].write_text("{", "utf-8")
    found = rp.assurance(case, jobs=1)
    assert (found.state, found.exit_code) == (ElementState.BROKEN, 3)
    certificates(case)[0].unlink()
    found = rp.assurance(case, jobs=1)
    assert (found.state, found.exit_code) == (ElementState.UNDECIDED, 20)
    (case.parent / "review.txt").unlink()
    assert "review.txt does not exist" in rp.assurance(case, jobs=1).reasons("Sn2")[0]


def test_a_changed_file_without_evidence_breaks_the_case(case: Path) -> None:
    (case.parent / "review.txt").write_text("rejected\n", "utf-8")
    found = rp.assurance(case, jobs=1)
    assert [x.path for x in found.open_points] == [("Sn2", "G3", "S1", "G1")]
    assert "review.txt has changed: sha256 " in found.reasons("Sn2")[0]


@pytest.mark.parametrize(
    ("old", "new", "code", "told"),
    [
        ('["PROVED", "REFUTED"]', '"PROVED"', 10, "REFUTED: base, expected PROVED"),
        ('["PROVED", "REFUTED"]', '"COVERED"', 20, "claims is without a verdict, expected COVERED"),
        ('["PROVED", "REFUTED"]', '"PROVED"\nselect = "P9 *"', 10, "no entry of claims matches P9 *"),
        ('"REFUTED"]', '"REFUTED"]\nentries = 3', 10, "claims has 2 entries, expected 3"),
        ('"claims"', '"other"', 3, "other does not exist"),
    ],
)  # fmt: skip
def test_other_verdicts_than_expected_are_told(case: Path, old: str, new: str, code: int, told: str) -> None:
    case.write_text(case.read_text("utf-8").replace(old, new), "utf-8")
    found = rp.assurance(case, jobs=1)
    assert found.exit_code == code
    assert told in " ".join(found.reasons("Sn1"))


def test_selected_entries_alone_count(case: Path) -> None:
    proof = next(x.name for x in certificates(case) if "claim" in json.loads(x.read_text("utf-8")))
    text = case.read_text("utf-8").replace('["PROVED", "REFUTED"]', f'"PROVED"\nselect = "{proof}"')
    case.write_text(text, "utf-8")
    assert rp.assurance(case, jobs=1).exit_code == 0
    (case.parent / "claims" / proof).write_text("{}", "utf-8")
    assert rp.assurance(case, jobs=1).state is ElementState.BROKEN


def test_bounded_answers_hold_within_limits_and_not_when_strict(case: Path) -> None:
    found = rp.witness("F[0, 1 s] v_lon(SV) > 200 m/s", jobs=1)
    (case.parent / "none.json").write_text(json.dumps(found.as_data()), "utf-8")
    text = (
        case.read_text("utf-8")
        .replace('"claims"', '"none.json"')
        .replace('["PROVED", "REFUTED"]', '"NONE-WITHIN"')
    )
    case.write_text(text, "utf-8")
    found = rp.assurance(case, jobs=1)
    assert found.exit_code == 0
    limits = {x.name: x.texts for x in found.solutions["Sn1"].limits}
    assert limits["within limits"][0].startswith("NONE-WITHIN: road main-2; dt 1/2; horizon 6; ")
    strict = rp.assurance(case, jobs=1, strict=True)
    assert (strict.states["Sn1"], strict.exit_code) == (ElementState.UNDECIDED, 20)


def test_a_case_is_checked_alone(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(case), str(case.parent / "claims")]) == 2
    assert "an assurance case is checked alone" in capsys.readouterr().err
    case.write_text("[", "utf-8")
    with pytest.raises(InputError, match="is no TOML"):
        rp.assurance(case)


def test_a_case_is_drawn_and_written_as_a_page(case: Path, tmp_path: Path) -> None:
    files = {"svg": tmp_path / "case.svg", "page": tmp_path / "case.html"}
    found = rp.assurance(case, jobs=1, **files)
    picture, page = (x.read_text("utf-8") for x in files.values())
    assert found.page == page
    for element in found.elements:
        assert f"{element.kind} {element.id}: {element.text.split()[0]}" in picture
        assert element.id in page
    for solution in found.solutions.values():
        assert solution.sha256 in page
    assert "<script" not in page


def test_the_template_refuses_folders_without_its_evidence(
    case: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = case.parent / "new.toml"
    asked = ["assurance", "--template", "catalogue-coverage", "--evidence", str(case.parent / "claims")]
    for words, told in (
        ([], "claims has no claim of a template property: run prove"),
        (["--evidence", str(case.parent)], "has no answers: name a folder"),
        (["--template", "other"], "template='other'; there is catalogue-coverage"),
    ):
        assert main([*asked, "--out", str(out), *words]) == 3
        assert told in capsys.readouterr().err
    assert main(asked) == 2
    assert main(["assurance"]) == 2


@pytest.mark.parametrize(
    ("lemmas", "speeds"), [(False, ["60 km/h"]), (False, ["60 km/h", "80 km/h"]), (True, ["60 km/h"])]
)
def test_the_template_claims_what_the_plates_show(tmp_path: Path, lemmas: bool, speeds: list[str]) -> None:
    """Plates of one model, its own drives and its own lemmas, and no more than these."""
    out, told = tmp_path / "plates", tmp_path / "case.toml"
    found = rp.preventable(
        "deceleration", models=["careful"], at={"Ve0": speeds}, lines=2, lemmas=lemmas, out=out
    )
    asked = ["assurance", "--template", "catalogue-coverage", "--evidence", str(out), "--out", str(told)]
    assert main(asked) == 0
    read = read_case(told)
    (solution,) = read.solutions
    assert solution.evidence is not None
    drives, proofs = sum(len(x.shown) for x in found.plates), len(found.lemmas)
    assert (proofs > 0) is lemmas
    assert solution.evidence.entries == len(found.plates) + drives + proofs
    assert "DERIVED" in solution.evidence.expect
    assert ("PROVED" in solution.evidence.expect) is lemmas
    assert ("lemma*" in solution.evidence.select) is lemmas
    goal = read.elements["G4.1"].text
    assert [x in goal for x in ("60 km/h", "80 km/h")] == [x in speeds for x in ("60 km/h", "80 km/h")]
    assert f"{len(found.plates)} plate" in goal
    assert ("without a lemma" in goal) is not lemmas
    assert (f"{proofs} lemmas" in solution.text) is lemmas
    state = rp.assurance(told, jobs=1).states
    assert state[solution.id] is ElementState.HOLDS


def answered(home: Path) -> dict[str, tuple[Path, str]]:
    """Small answers of four kinds, and the number in words that the goal about each may state."""
    drives = home / "tests"
    drives.mkdir()
    for name in ("braking", "cut-in"):
        shutil.copy(ROOT / "examples" / "catalogue" / "tests" / "drives" / f"{name}.json", drives)
    rp.prove("P2", "P4", out=home / "index", jobs=1)
    rp.witness("1", "F v_lon(SV) > 20 m/s", out=home / "witness", pictures=False, jobs=1)
    rp.overlap(among="1-3", out=home / "overlap", jobs=1)
    rp.catalogue(drives, among="1,4", classes=False, drivers=(), out=home / "catalogue", jobs=1)
    count = len(folder_data(home / "index")["verdicts"])
    told = {
        "index": f"{count} claims of template properties P2, P4 hold",
        "witness": "2 formulas can happen",
        "overlap": "Of 3 pairs of scenarios of set base",
        "catalogue": "show 2 scenarios of set base",
    }
    return {kind: (home / kind, words) for kind, words in told.items()}


def test_the_template_counts_what_each_folder_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A goal states how much its evidence shows, and breaks where the folder holds less."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROADPROOF_KNOWN", "on")
    found = answered(tmp_path)
    folders = ",".join(str(folder) for folder, _ in found.values())
    assert (
        main(["assurance", "--template", "catalogue-coverage", "--evidence", folders, "--out", "c.toml"]) == 0
    )
    read = read_case(Path("c.toml"))
    texts = {x.evidence.path: read.elements[x.id] for x in read.solutions if x.evidence}
    assert {*texts} == {*found}
    goals = " | ".join(x.text for x in read.elements.values())
    for _, words in found.values():
        assert words in goals
    for wide in ("foreseeable", "every scenario", "A collision that is missed"):
        assert wide not in goals
    whole = rp.assurance("c.toml", jobs=1)
    assert {x.id: whole.states[x.id] for x in read.solutions} == {
        x.id: ElementState.HOLDS for x in read.solutions
    }
    text = Path("c.toml").read_text("utf-8")
    for count in {str(x.evidence.entries) for x in read.solutions if x.evidence}:
        Path("d.toml").write_text(
            text.replace(f"entries = {count}\n", f"entries = {int(count) + 1}\n"), "utf-8"
        )
        assert rp.assurance("d.toml", jobs=1).exit_code != 0
    capsys.readouterr()


def test_the_example_claims_what_the_template_does() -> None:
    """The example is a case of the template, whose goals name sets, manoeuvres and values."""
    example = read_case(ROOT / "examples" / "assurance" / "case.toml")
    kinds = ("coverage", "catalogue", "preventable")
    plain = dict(tables([EvidenceFolder(x, x, {}) for x in kinds]))
    for name, table in plain.items():
        (text,) = (table[str(kind)] for kind in ElementKind if str(kind) in table)
        assert example.elements[name].text == text
    folders = {Path(x.evidence.path).name: x for x in example.solutions if x.evidence}
    assert all(x.evidence and x.evidence.entries for x in folders.values())
    assert {*folders} == {"coverage", "catalogue", "cut-out", "cut-in", "deceleration"}


@given(
    st.lists(
        st.tuples(st.sampled_from(["coverage", "overlap", "catalogue", "preventable"]), st.integers(0, 3)),
        min_size=1,
        max_size=5,
    )
)
def test_the_template_has_what_there_is_and_no_more(kinds: list[tuple[str, int]]) -> None:
    """A branch for each kind of evidence, a solution for what a folder shows, and a goal for the rest."""
    words = dict.fromkeys(
        ("set", "pairs", "targets", "boundary", "manoeuvre", "plates", "drives", "lemmas"), "x"
    )
    folders = [
        EvidenceFolder(f"{kind}-{k}", kind, words, entries=entries, left=("a",) * (entries < 2))
        for k, (kind, entries) in enumerate(kinds)
    ]
    made = dict(tables(folders))
    there = {kind for kind, _ in kinds}
    branches = {"G2": {"coverage", "overlap"}, "G3": {"catalogue"}, "G4": {"preventable"}}
    assert {x for x in branches if x in made} == {x for x, those in branches.items() if those & there}
    assert {x["evidence"] for x in made.values() if "evidence" in x} == {x.path for x in folders if x.entries}
    undeveloped = [x["goal"] for x in made.values() if x.get("undeveloped")]
    assert len(undeveloped) == sum(bool(x.left) for x in folders)
    assert ("A2" in made) == ("preventable" in there)
    assert ("collisions" in made["G1"]["goal"]) == ("preventable" in there)
    assert ("tests show" in made["G1"]["goal"].lower()) == ("catalogue" in there)
    named = {x for table in made.values() for x in table.get("supported-by", ())}
    assert named == {x for x in made if x[0] in "GS"} - {"G1"}


def test_formulas_are_counted_one_by_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Formulas of one spec set have one label; the drive of one is not that of another."""
    monkeypatch.chdir(tmp_path)
    impossible = "v_lon(SV) > 20 m/s and v_lon(SV) < 10 m/s"
    for name, formulas, shown in (
        ("both", ("F v_lon(SV) > 20 m/s", "F v_lon(SV) > 21 m/s"), 2),
        ("one", (impossible, "F v_lon(SV) > 21 m/s"), 1),
        ("none", (impossible,), 0),
    ):
        rp.witness(*formulas, out=name, pictures=False, jobs=1)
        text = fill_template("catalogue-coverage", [Path(name)], Path())
        assert (f"{shown} formula{'s' * (shown != 1)} can happen" in text) is bool(shown)
        assert ("Still to be shown" in text) is (shown < len(formulas))
        Path("case.toml").write_text(text, "utf-8")
        states = {rp.assurance("case.toml", jobs=1).states[f"Sn{k + 1}"] for k in range(min(shown, 1))}
        assert states <= {ElementState.HOLDS}


def test_what_a_folder_does_not_show_is_a_goal_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An untested scenario, a fault of a test, and a search that found nothing are not claimed."""
    monkeypatch.chdir(tmp_path)
    drives = tmp_path / "tests"
    drives.mkdir()
    shutil.copy(ROOT / "examples" / "catalogue" / "tests" / "drives" / "braking.json", drives)
    settings = {"among": "1,4", "classes": False, "drivers": (), "jobs": 1}
    rp.catalogue(drives, out="catalogue", **settings)
    rp.witness("4", "v_lon(SV) > 20 m/s and v_lon(SV) < 10 m/s", out="drives", pictures=False, jobs=1)
    text = fill_template("catalogue-coverage", [Path("catalogue"), Path("drives")], Path())
    Path("case.toml").write_text(text, "utf-8")
    assert 'goal = "The tests show 1 scenario of set base and are what they claim"' in text
    assert 'goal = "Still to be shown, of catalogue: no test shows scenario_1"' in text
    assert 'goal = "1 formula can happen"' in text
    assert "Still to be shown, of drives: " in text
    found = rp.assurance("case.toml", jobs=1)
    assert {found.states[x.id] for x in read_case(Path("case.toml")).solutions} == {ElementState.HOLDS}
    assert found.states["G1"] is ElementState.UNDEVELOPED
    shutil.copy(ROOT / "examples" / "catalogue" / "tests" / "drives" / "torn.json", drives)
    rp.catalogue(drives, out="faulty", **settings)
    faulty = fill_template("catalogue-coverage", [Path("faulty")], Path())
    assert "are what they claim" not in faulty
    assert "1 fault of tests that are not what they claim; no test shows scenario_1" in faulty


@pytest.mark.parametrize(
    ("index", "select", "expected"),
    [
        ({"not_tested": [], "faults": []}, (), ("COVERED", "")),
        ({"not_tested": ["class_1", "scenario_2"], "faults": []}, ("scenario_1",), ("COVERED", "")),
        ({"not_tested": ["a", "s_2"], "faults": []}, ("s*",), ("GAPS", "not tested: s_2")),
        ({"not_tested": [], "faults": [{}]}, (), ("GAPS", "1 not what they claim")),
        ({"verdict": "COVERED"}, (), ("COVERED", "")),
        ({"verdicts": []}, (), ("", "")),
    ],
)  # fmt: skip
def test_the_verdict_of_a_whole_answer(
    index: dict[str, object], select: tuple[str, ...], expected: tuple[str, str], tmp_path: Path
) -> None:
    (tmp_path / "answer.json").write_text(json.dumps(index), "utf-8")
    assert whole_verdict(tmp_path / "answer.json", select) == expected
    assert whole_verdict(tmp_path / "missing") == ("", "")
