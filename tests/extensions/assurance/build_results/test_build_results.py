"""JUnit XML and SARIF of answers, and the example for build servers."""

import json
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import roadproof as rp
from console import environment
from roadproof.extensions.assurance.build_results.junit import as_junit
from roadproof.extensions.assurance.build_results.meanings import MEANINGS
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.cases import Case, Location
from roadproof.verdict import ExitCode, Verdict

ROOT = Path(__file__).parents[4]
EXAMPLE = ROOT / "examples" / "ci"
SCHEMAS = os.environ.get("ROADPROOF_SCHEMAS", "")

CLAIMS = """\
# three claims
scenario_4(SV,POV,L) -> dangerArises(SV,POV)

  fast(SV)
  -> fast(POV)   # not true

true U[0, 5] v_lon(SV) > 3 m/s -> v_lon(SV) > 3 m/s
"""
SPEC = 'param most = 30 m/s where most > 0 "limit"\n\n  def fast(a: vehicle) := v_lon(a) > most\n'


@pytest.fixture(scope="module")
def proved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Claims that are proved and refuted, with what is written for build servers."""
    folder = tmp_path_factory.mktemp("proved")
    (folder / "my claims.txt").write_text(CLAIMS, "utf-8")
    (folder / "own.spec").write_text(SPEC, "utf-8")
    before = Path.cwd()
    os.chdir(folder)
    try:
        files = ["--junit", "claims.xml", "--sarif", "claims.sarif", "--out", "out"]
        more = ["--claims", "my claims.txt", "--spec", "own.spec", "--no-drive", "--jobs", "1"]
        assert main(["prove", *more, *files]) == ExitCode.UNEXPECTED
    finally:
        os.chdir(before)
    return folder


def cases_of(path: Path) -> dict[str, xml.Element]:
    return {str(x.get("name")): x for x in xml.parse(path).iter("testcase")}


def results_of(path: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(path.read_text("utf-8"))["runs"][0]["results"]
    return found


def test_junit_tells_where_each_claim_is_written(proved: Path) -> None:
    found = cases_of(proved / "claims.xml")
    failures = {name: x.find("failure") for name, x in found.items()}
    wrong = failures.pop("fast(SV) -> fast(POV)")
    assert wrong is not None
    assert (wrong.get("type"), str(wrong.text).splitlines()[0]) == ("REFUTED", "my claims.txt:4:3")
    assert str(wrong.get("message")).startswith("REFUTED by a trace, expected PROVED: fast(SV) -> fast(POV)")
    late = failures.pop("true U[0, 5] v_lon(SV) > 3 m/s -> v_lon(SV) > 3 m/s")
    assert late is not None
    assert str(late.text).startswith("my claims.txt:7:1")
    assert failures == {"scenario_4(SV,POV,L) -> dangerArises(SV,POV)": None}
    passed = found["scenario_4(SV,POV,L) -> dangerArises(SV,POV)"].find("system-out")
    assert passed is not None
    place, attachment = str(passed.text).splitlines()
    assert place == "my claims.txt:2:1"
    named = re.fullmatch(r"\[\[ATTACHMENT\|(.*)\]\]", attachment)
    assert named is not None
    assert (proved / named[1]).is_file()
    suites = xml.parse(proved / "claims.xml").getroot()
    assert (suites.get("tests"), suites.get("failures"), suites.get("errors")) == ("3", "2", "0")


def test_sarif_tells_file_line_and_column(proved: Path) -> None:
    first, second = results_of(proved / "claims.sarif")
    where = first["locations"][0]["physicalLocation"]
    assert where["artifactLocation"] == {"uri": "my%20claims.txt", "uriBaseId": "SRCROOT"}
    assert where["region"] == {"startLine": 4, "startColumn": 3}
    assert (first["ruleId"], first["level"]) == ("REFUTED", "error")
    named = {x["message"]["text"]: x["physicalLocation"] for x in first["relatedLocations"]}
    assert named["fast"]["artifactLocation"]["uri"] == "own.spec"
    assert named["fast"]["region"] == {"startLine": 3, "startColumn": 7}
    assert first["partialFingerprints"] != second["partialFingerprints"]
    run = json.loads((proved / "claims.sarif").read_text("utf-8"))["runs"][0]
    assert [x["id"] for x in run["tool"]["driver"]["rules"]] == ["REFUTED"]
    assert run["invocations"][0]["exitCode"] == ExitCode.UNEXPECTED


def test_a_refuting_drive_is_linked(tmp_path: Path) -> None:
    found = rp.prove("v_lon(SV) > 3 m/s -> v_lon(SV) > 4 m/s", out=tmp_path / "out", jobs=1)
    result = json.loads(found.to_sarif())["runs"][0]["results"][0]
    link = next(x for x in result["relatedLocations"] if x.get("id") == 1)
    drive = Path(link["physicalLocation"]["artifactLocation"]["uri"].removeprefix("file://"))
    assert "[Evidence](1)" in result["message"]["text"]
    assert rp.check(drive).findings[0].claim == "not (v_lon(SV) > 3 m/s -> v_lon(SV) > 4 m/s)"


NEVER = "v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s"


def answers(folder: Path) -> dict[str, BuildResult]:
    """An answer of each question that has the options, with something that did not pass in most."""
    traffic = folder / "traffic"
    rp.simulate(traffic, seconds=20, lanes=2, flow=1200, section=200)
    (traffic / "02_tracks.csv").write_text("id\n", "utf-8")
    tests = folder / "tests"
    shutil.copytree(ROOT / "examples" / "catalogue" / "tests" / "drives", tests / "drives")
    (tests / "catalogue.toml").write_text('[[test]]\nid = "WRONG"\nformula = "true and"\n', "utf-8")
    damaged = folder / "damaged.json"
    damaged.write_text('{"schema": "roadproof/drive/3"}', "utf-8")
    return {
        "witness": rp.witness("scenario_4(SV,POV,L)", NEVER, jobs=1, out=folder / "drives"),
        "check": rp.check(damaged, tests / "drives" / "braking.json", jobs=1),
        "catalogue": rp.catalogue(tests, among="4", classes=False, drivers=(), jobs=1),
        "preventable": rp.preventable("cut-in", ["careful"], lines=2, lemmas=False, jobs=1),
        "evaluate": rp.evaluate(traffic, keep_going=True, pictures=False, jobs=1),
    }


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> dict[str, BuildResult]:
    return answers(tmp_path_factory.mktemp("answered"))


def test_states_agree_with_exit_codes(answered: dict[str, BuildResult]) -> None:
    """0 where all passed or were skipped, 10 or 3 where one failed, else 20 where one is undecided."""
    for name, answer in answered.items():
        states = {x.state for x in answer.cases()}
        assert (answer.exit_code == ExitCode.AS_EXPECTED) == (states <= {"passed", "skipped"}), name
    wrong = {name: [x.name for x in each.cases() if x.state != "passed"] for name, each in answered.items()}
    assert wrong["witness"] == [NEVER]
    assert wrong["evaluate"] == ["02"]
    assert {"WRONG"} <= {*wrong["catalogue"]}
    assert len(wrong["check"]) == 1


def test_each_case_that_did_not_pass_has_a_rule_and_a_meaning(answered: dict[str, BuildResult]) -> None:
    told = [x for answer in answered.values() for x in answer.cases() if x.state != "passed"]
    assert len(told) >= 4
    for case in told:
        assert case.rule in MEANINGS
        assert case.message


def test_files_that_are_named_exist(answered: dict[str, BuildResult]) -> None:
    for answer in answered.values():
        for case in answer.cases():
            places = [case.place, *(x for _, x in case.related)]
            for place in (x for x in places if x is not None):
                lines = Path(place.file).read_text("utf-8", "replace").splitlines()
                assert place.line <= max(1, len(lines))
            assert case.evidence is None or case.evidence.is_file()


@pytest.mark.skipif(
    not SCHEMAS, reason="ROADPROOF_SCHEMAS names no folder with junit-10.xsd and sarif-schema"
)
def test_schemas_accept_all(answered: dict[str, BuildResult], proved: Path, tmp_path: Path) -> None:
    xmlschema = pytest.importorskip("xmlschema")
    sarif = json.loads((Path(SCHEMAS) / "sarif-schema-2.1.0.json").read_text("utf-8"))
    validator = jsonschema.validators.validator_for(sarif)(sarif)
    junit = xmlschema.XMLSchema(str(Path(SCHEMAS) / "junit-10.xsd"))
    junit.validate(str(proved / "claims.xml"))
    validator.validate(json.loads((proved / "claims.sarif").read_text("utf-8")))
    for answer in answered.values():
        junit.validate(answer.to_junit())
        validator.validate(json.loads(answer.to_sarif()))


def test_characters_that_xml_cannot_hold_are_replaced() -> None:
    case = Case(suite="claims", name="a\x00b", state="undecided", rule=Verdict.UNKNOWN, message="\x1b[1m<&")
    found = next(xml.fromstring(as_junit("roadproof prove", [case])).iter("testcase"))
    assert (found.get("name"), found[0].tag, found[0].get("message")) == ("a\ufffdb", "error", "\ufffd[1m<&")


def test_a_file_that_cannot_be_written_is_told_before_the_work(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "true", "--sarif", "/nowhere/x.sarif"]) == ExitCode.BAD_INPUT
    assert "/nowhere/x.sarif" in capsys.readouterr().err


def steps(file: str, key: str) -> list[str]:
    """The commands of roadproof in a file of YAML, each in a line."""
    lines = (EXAMPLE / file).read_text("utf-8").splitlines()
    found = [line.partition(f"{key}: ")[2] for line in lines]
    return [x for x in found if x.startswith("roadproof ")]


def run(command: str, folder: Path, cache: Path) -> str:
    variables = environment() | {"XDG_CACHE_HOME": str(cache), "ROADPROOF_KNOWN": "on"}
    done = subprocess.run(command, shell=True, cwd=folder, env=variables, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def test_the_workflow_runs(tmp_path: Path) -> None:
    shutil.copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    commands = steps("workflow.yml", "run")
    assert len(commands) == 2
    for command in commands:
        run(command, tmp_path, tmp_path / "cache")
    assert len(cases_of(tmp_path / "claims.xml")) == 3
    assert results_of(tmp_path / "claims.sarif") == []
    assert len(cases_of(tmp_path / "check.xml")) == 3


def test_a_commit_proves_only_what_it_affects(tmp_path: Path) -> None:
    shutil.copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    (command,) = steps(".pre-commit-config.yaml", "entry")
    run(command, tmp_path, tmp_path / "cache")
    spec = tmp_path / "ours.spec"
    spec.write_text(spec.read_text("utf-8").replace("farTime = 9 s", "farTime = 8 s"), "utf-8")
    told = run(command, tmp_path, tmp_path / "cache")
    assert "2 of 3 answers were known" in told
    assert "3 of 3 answers were known" in run(command, tmp_path, tmp_path / "cache")


def test_places_in_text() -> None:
    assert str(Location("a.spec", 3, 5)) == "a.spec:3:5"
