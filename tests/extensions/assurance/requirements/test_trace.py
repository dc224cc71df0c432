"""Requirements: which evidence shows which link, each state, and what makes a link stale."""

import json
import shutil
import xml.etree.ElementTree as xml
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.extensions.assurance.answers.trace import LinkState
from roadproof.extensions.assurance.requirements.requirement import Link
from roadproof.extensions.assurance.tracing import Traced
from roadproof.frontends.cli.main import main

ROOT = Path(__file__).parents[4]
PROOFS = ("P4-scenario-03-base.json", "P4-scenario-11-base.json")
DRIVES = ROOT / "examples" / "traffic" / "drives"
SPEC = """\
param lookAhead = 30 m where lookAhead > 0 "how far the vehicle looks"
param unused = 2 s where unused > 0 "no definition uses it"
def near(SV, POV: vehicle) "closer than it looks" := s(POV) - s(SV) < lookAhead
def slow(SV: vehicle) "slower than a bicycle" := v_lon(SV) < 5 m/s
"""
FILE = """\
[trace]
evidence = ["proofs", "drives"]
specs = ["ours.spec"]
vehicles = { SV = "car", POV = "models/van.toml" }

[[requirement]]
id = "ALL"
text = "All of it."

[[requirement]]
id = "LEAD"
parent = "ALL"
text = "Braking ahead and acceleration behind are the same danger."
claims = ["P4 scenario 3 base"]

[[requirement]]
id = "BRAKE"
derived_from = ["ALL"]
text = "A vehicle ahead brakes."
scenarios = [4]

[[requirement]]
id = "NEAR"
text = "A vehicle comes near."
scenarios = ["F near(SV,POV)"]
"""


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """Requirements, with proofs, drives, definitions and a vehicle model of the user's."""
    for name in PROOFS:
        (tmp_path / "proofs").mkdir(exist_ok=True)
        shutil.copy(ROOT / "proofs" / name, tmp_path / "proofs" / name)
    (tmp_path / "drives").mkdir()
    shutil.copy(DRIVES / "scenario-04-base.json", tmp_path / "drives" / "brake.json")
    drive = json.loads((DRIVES / "scenario-04-base.json").read_text("utf-8"))
    drive |= {"scenario": None, "formula": "F near(SV,POV)", "lane": None}
    drive["parameters"] |= {"lookAhead": "30"}
    drive["verdict"] = {"verdict": "WITNESSED", "view": "dense"}
    write(tmp_path / "drives" / "near.json", drive)
    (tmp_path / "models").mkdir()
    shutil.copy(ROOT / "models" / "vehicles" / "car.toml", tmp_path / "models" / "van.toml")
    (tmp_path / "ours.spec").write_text(SPEC, "utf-8")
    (tmp_path / "requirements.toml").write_text(FILE, "utf-8")
    return tmp_path


def write(path: Path, content: object) -> None:
    path.write_text(json.dumps(content), "utf-8")


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")


def ask(home: Path, accept: bool = False) -> Traced:
    return rp.requirements(home / "requirements.toml", accept=accept, jobs=1)


def link_of(found: Traced, name: str) -> tuple[str, str, tuple[str, ...]]:
    """State, reason and changes of the one link of a requirement."""
    [x] = [x for x in found.answer.requirements if x.id == name]
    [link] = x.links
    return str(link.state), link.reason, link.changes


def states(found: Traced) -> dict[str, str]:
    return {name: str(state) for name, state in found.states.items()}


def test_claims_need_a_proof_and_scenarios_a_drive(home: Path) -> None:
    found = ask(home)
    assert states(found) == {"ALL": "witnessed", "LEAD": "proved", "BRAKE": "witnessed", "NEAR": "witnessed"}
    assert found.exit_code == 0
    assert [x.label for x in found.answer.unlinked] == ["P4 scenario 11 base"]
    assert "3 of 4" not in str(found)
    assert "4 of 4 requirements shown" in str(found)
    assert "no link was ever accepted" in str(found)


@pytest.mark.parametrize(
    ("field", "state", "reason"),
    [
        ('claims = ["scenario_3(SV,POV,L)  <->  scenario_4(POV,SV,L)"]', "proved", ""),
        ('claims = ["scenario_3(SV,POV,L) <-> scenario_4(POV,SV,L)"]', "proved", ""),
        ('claims = ["P4 scenario 3 ext"]', "missing", "there is no evidence"),
        ('claims = ["scenario_3@ext(SV,POV,L) <-> scenario_4(POV,SV,L)"]', "missing", "there is no evidence"),
        ('claims = ["scenario_4(SV,POV,L)"]', "unknown", "a drive shows it once"),
        ('claims = ["not scenario_4(SV,POV,L)"]', "refuted", "a judged drive refutes it"),
        ('scenarios = ["scenario_4(SV, POV, L)"]', "witnessed", ""),
        ('scenarios = ["deceleration ahead, lane keep, main road"]', "witnessed", ""),
        ("scenarios = [5]", "missing", "there is no evidence"),
        ('scenarios = ["4@ext"]', "missing", "there is no evidence"),
        ('scenarios = ["not (scenario_3(SV,POV,L) <-> scenario_4(POV,SV,L))"]', "refuted", "no drive"),
        ('tests = ["brake"]', "witnessed", ""),
        ('tests = ["deleted"]', "missing", "there is no evidence"),
        ('plates = ["careful-Vy-1"]', "missing", "there is no evidence"),
        ('evidence = ["proofs/P4-scenario-11-base.json"]', "proved", ""),
        ('evidence = ["proofs"]', "proved", ""),
        ('evidence = ["drives/none.json"]', "missing", "there is no evidence"),
        ("", "missing", ""),
    ],
)
def test_each_way_to_name_a_link(home: Path, field: str, state: str, reason: str) -> None:
    change(home / "requirements.toml", 'claims = ["P4 scenario 3 base"]', field)
    found = ask(home)
    [x] = [x for x in found.answer.requirements if x.id == "LEAD"]
    assert str(x.state) == state
    assert all(reason in link.reason for link in x.links)
    assert found.exit_code == {"missing": 10, "refuted": 10, "unknown": 20}.get(state, 0)


def test_damaged_evidence_is_rejected_up_to_the_top(home: Path) -> None:
    path = home / "proofs" / PROOFS[0]
    content = json.loads(path.read_text("utf-8"))
    content["queries"][0]["smtlib"].insert(1, "(assert false)")
    write(path, content)
    found = ask(home)
    assert states(found) | {"ALL": "", "LEAD": ""} == {
        "ALL": "",
        "LEAD": "",
        "BRAKE": "witnessed",
        "NEAR": "witnessed",
    }
    assert (found.states["LEAD"], found.states["ALL"]) == (LinkState.REJECTED, LinkState.REJECTED)
    assert found.exit_code == 10


def test_damaged_evidence_that_nobody_names_counts_too(home: Path) -> None:
    (home / "proofs" / PROOFS[1]).write_text("{", "utf-8")
    found = ask(home)
    assert [str(x.outcome) for x in found.answer.unlinked] == ["unreadable"]
    assert found.exit_code == 10


def test_evidence_that_is_not_made_yet_leaves_links_missing(home: Path) -> None:
    shutil.rmtree(home / "drives")
    found = ask(home)
    assert states(found) == {"ALL": "missing", "LEAD": "proved", "BRAKE": "missing", "NEAR": "missing"}
    assert found.answer.notes == (f"{home / 'drives'} holds no evidence yet",)


def test_a_drive_with_other_values_of_parameters_is_stale_without_a_lock(home: Path) -> None:
    change(
        home / "requirements.toml",
        'specs = ["ours.spec"]',
        'specs = ["ours.spec"]\nparameters = { lookAhead = 25 }',
    )
    found = ask(home)
    assert link_of(found, "NEAR") == ("stale", "judged with lookAhead = 30 (now 25)", ())
    assert states(found) | {"NEAR": ""} == {
        "ALL": "witnessed",
        "LEAD": "proved",
        "BRAKE": "witnessed",
        "NEAR": "",
    }


def test_after_acceptance_nothing_is_stale(home: Path) -> None:
    assert ask(home, accept=True).exit_code == 0
    again = ask(home)
    assert again.answer.locked
    assert again.exit_code == 0
    assert all(not link.changes for x in again.answer.requirements for link in x.links)


@pytest.mark.parametrize(
    ("file", "old", "new", "stale", "told"),
    [
        ("ours.spec", "lookAhead = 30 m", "lookAhead = 29 m", {"NEAR"}, "parameter lookAhead: 30 -> 29"),
        ("ours.spec", "unused = 2 s", "unused = 3 s", set(), ""),
        ("ours.spec", "v_lon(SV) < 5 m/s", "v_lon(SV) < 6 m/s", set(), ""),
        ("ours.spec", "s(POV) - s(SV) <", "s(POV) - s(SV) <=", {"NEAR"}, "definition near changed"),
        ("ours.spec", "lookAhead > 0", "lookAhead >= 0", {"NEAR"}, "parameter lookAhead changed"),
        ("ours.spec", '"closer than it looks"', '"close"', set(), ""),
        ("requirements.toml", "ahead brakes", "ahead stops", {"BRAKE", "ALL"}, "text of BRAKE changed"),
        ("requirements.toml", "same danger.", "same.", {"LEAD", "ALL"}, "text of LEAD changed"),
        ("drives/near.json", '"horizon": "6"', '"horizon": "5"', {"NEAR"}, "file drives/near.json changed"),
        (
            "models/van.toml",
            "a_lon = [-6, 3]",
            "a_lon = [-7, 3]",
            {"NEAR", "BRAKE", "ALL"},
            "vehicle model of POV changed",
        ),
    ],
)
def test_each_kind_of_change_makes_exactly_its_links_stale(
    home: Path, file: str, old: str, new: str, stale: set[str], told: str
) -> None:
    ask(home, accept=True)
    change(home / file, old, new)
    found = ask(home)
    assert {name for name, state in states(found).items() if state == "stale"} == stale
    changes = {y for x in found.answer.requirements for link in x.links for y in link.changes}
    assert changes == ({told} if told else set())


def test_a_definition_that_two_sets_share_makes_links_stale(home: Path) -> None:
    shared = """
def leaf(SV, POV: vehicle) := near(SV, POV)
def reach(SV, POV: vehicle) := leaf(SV, POV)
def both(SV, POV: vehicle) := reach@mine(SV, POV) and reach(SV, POV)
set mine extends base "mine" { def leaf(SV, POV: vehicle) := true }
"""
    (home / "ours.spec").write_text(SPEC + shared, "utf-8")
    change(home / "requirements.toml", "F near(SV,POV)", "F both(SV,POV)")
    change(home / "drives" / "near.json", "F near(SV,POV)", "F both(SV,POV)")
    assert ask(home, accept=True).exit_code == 0
    change(home / "ours.spec", "leaf(SV, POV: vehicle) := near", "leaf(SV, POV: vehicle) := not not near")
    assert link_of(ask(home), "NEAR")[::2] == ("stale", ("definition leaf changed",))


def test_a_claim_that_means_something_else_is_stale_though_no_definition_tells_why(home: Path) -> None:
    shared = """
def leaf(SV, POV: vehicle) := near(SV, POV)
set mine extends base "mine" { def leaf(SV, POV: vehicle) := true }
"""
    (home / "ours.spec").write_text(SPEC + shared, "utf-8")
    for file in ("requirements.toml", "drives/near.json"):
        change(home / file, "F near(SV,POV)", "F leaf@mine(SV,POV)")
    assert ask(home, accept=True).exit_code == 0
    change(home / "ours.spec", "{ def leaf(SV, POV: vehicle) := true }", "{}")
    state, _, changes = link_of(ask(home), "NEAR")
    assert (state, changes) == ("stale", ("meaning of F leaf@mine(SV,POV) changed",))


def test_another_version_makes_every_link_stale(home: Path) -> None:
    ask(home, accept=True)
    change(home / "requirements.lock.json", f'"roadproof": "{rp.__version__}"', '"roadproof": "0.0.1"')
    found = ask(home)
    assert {*states(found).values()} == {"stale"}
    assert link_of(found, "LEAD")[2] == (f"roadproof: 0.0.1 -> {rp.__version__}",)


def test_baseline_tells_better_worse_added_and_removed(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ask(home).save(home / "old")
    (home / "drives" / "near.json").unlink()
    change(home / "requirements.toml", 'id = "BRAKE"', 'id = "STOP"')
    change(
        home / "requirements.toml",
        "[trace]",
        '[[requirement]]\nid = "NEW"\ntext = "More."\nparent = "LEAD"\n[trace]',
    )
    ask(home).save(home / "new")
    capsys.readouterr()
    assert (
        main(["trace", "--baseline", str(home / "old" / "trace.json"), str(home / "new" / "trace.json")])
        == 10
    )
    told = capsys.readouterr().out
    assert "got worse  NEAR  scenario F near(SV,POV): witnessed -> missing" in told
    assert "removed  BRAKE: witnessed" in told
    assert "added  STOP: witnessed" in told
    assert (
        main(["trace", "--baseline", str(home / "new" / "trace.json"), str(home / "old" / "trace.json")])
        == 10
    )
    told = capsys.readouterr().out
    assert "got better  NEAR  scenario F near(SV,POV): missing -> witnessed" in told
    same = str(home / "new" / "trace.json")
    assert main(["trace", "--baseline", same, same]) == 0
    assert "nothing changed" in capsys.readouterr().out


def test_files_of_out_say_the_same(home: Path) -> None:
    found = ask(home)
    found.save(home / "out")
    assert json.loads((home / "out" / "trace.json").read_text("utf-8")) == found.as_data()
    rows = (home / "out" / "trace.csv").read_text("utf-8").splitlines()
    assert rows[0] == "requirement,title,edition,clause,kind,target,state,shows,reason,evidence,line"
    assert len(rows) == 1 + len(found.rows()) == 5
    for name in ("trace.md", "trace.html"):
        text = (home / "out" / name).read_text("utf-8")
        assert all(x in text for x in ("LEAD", "BRAKE", "P4 scenario 3 base", "4 of 4 requirements shown"))


def test_build_servers_are_told_line_and_evidence(home: Path) -> None:
    ask(home, accept=True)
    change(home / "ours.spec", "lookAhead = 30 m", "lookAhead = 29 m")
    change(home / "requirements.toml", 'claims = ["P4 scenario 3 base"]', "")
    (home / "proofs" / PROOFS[0]).write_text("{", "utf-8")
    files = ["--junit", str(home / "trace.xml"), "--sarif", str(home / "trace.sarif")]
    assert main(["trace", str(home / "requirements.toml"), "--jobs", "1", *files]) == 10
    [run] = json.loads((home / "trace.sarif").read_text("utf-8"))["runs"]
    told = {x["ruleId"]: x for x in run["results"]}
    assert {*told} == {"STALE", "MISSING", "UNREADABLE"}
    places = {name: x["locations"][0]["physicalLocation"]["region"] for name, x in told.items()}
    assert places["STALE"] == {"startLine": 22, "startColumn": 1}
    assert places["MISSING"]["startLine"] == 10
    assert "parameter lookAhead: 30 -> 29" in told["STALE"]["message"]["text"]
    assert any("near.json" in str(x) for x in told["STALE"]["relatedLocations"])
    cases = {str(x.get("name")): x for x in xml.parse(home / "trace.xml").iter("testcase")}
    assert {name for name, x in cases.items() if x.find("failure") is None} == {"BRAKE: scenario 4"}
    assert len(cases) == 4


def test_the_page_begins_with_requirements_that_are_not_shown(home: Path) -> None:
    good = ask(home).save(home / "good") / "trace.html"
    assert "evidence was accepted when the requirements were traced" in good.read_text("utf-8")
    (home / "drives" / "near.json").unlink()
    (home / "proofs" / PROOFS[0]).write_text("{", "utf-8")
    text = (ask(home).save(home / "bad") / "trace.html").read_text("utf-8")
    begin, _, rest = text.partition("Requirements that are not shown")
    assert "No open points" not in begin + rest
    listed = rest.partition("</ul>")[0]
    assert [name for name in ("ALL", "LEAD", "NEAR", "BRAKE") if f"{name}: " in listed] == [
        "ALL",
        "LEAD",
        "NEAR",
    ]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('id = "BRAKE"', 'id = "LEAD"', "line 16: two requirements are called 'LEAD'"),
        ('parent = "ALL"', 'parent = "NONE"', "requirement LEAD: there is no requirement 'NONE'"),
        ('text = "All of it."', 'text = "All."\nparent = "LEAD"', "is derived from itself"),
        ("scenarios = [4]", "scenario = [4]", "there is no field 'scenario'; did you mean 'scenarios'?"),
        ("scenarios = [4]", "scenarios = [true]", "True is no text"),
        ("scenarios = [4]", "scenarios = [400]", "400"),
        ("scenarios = [4]", 'claims = ["v_lon(SV) <"]', "requirement BRAKE, claim, line 1"),
        ("[trace]", "[tracing]", "there is no table 'tracing'; did you mean 'trace'?"),
        ('text = "All of it."', "", "requirement ALL has no text"),
        ("[[requirement]]", "[requirement]", "requirement"),
    ],
)
def test_mistakes_are_named_with_their_place(
    home: Path, old: str, new: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (home / "requirements.toml").read_text("utf-8")
    (home / "requirements.toml").write_text(text.replace(old, new, 1), "utf-8")
    assert main(["trace", str(home / "requirements.toml")]) == 3
    assert told in capsys.readouterr().err


def test_a_damaged_lock_file_is_refused(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ask(home, accept=True)
    path = home / "requirements.lock.json"
    lock = json.loads(path.read_text("utf-8"))
    del lock["parts"]["text of LEAD"]
    write(path, lock)
    assert main(["trace", str(home / "requirements.toml")]) == 3
    assert "LEAD rests on 'text of LEAD', which is not among the parts" in capsys.readouterr().err


def test_links_are_told_by_kind() -> None:
    assert str(Link("test", "CUT-1")) == "test CUT-1"
