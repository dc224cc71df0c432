"""All JSON that commands print and write is what docs/schema says, and the schemas refuse what is not."""

import json
import re
from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from referencing import Registry, Resource

import roadproof as rp
from cli.test_coverage import components
from engine_calls import search_for
from roadproof.engines.search.none_within import refute_with_trees
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.heading import heading
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.none_within_file import none_within_data
from roadproof.extensions.surveys.coverage import claims as coverage_claims
from roadproof.extensions.surveys.coverage import question as coverage_question
from roadproof.extensions.surveys.coverage.classes import GapClasses
from roadproof.extensions.surveys.coverage.gap_drives import SimpleDrives
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import COMMANDS, main
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Query, Specification

pytestmark = pytest.mark.usefixtures("searched_once")

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "schema"
SCHEMAS: Mapping[str, Any] = {x.name: json.loads(x.read_text("utf-8")) for x in sorted(FOLDER.glob("*.json"))}
NAMES = {
    version: name
    for name, schema in SCHEMAS.items()
    if (said := schema.get("properties", {}).get("schema"))
    for version in said.get("enum", [said.get("const")])
}
DRIVE = ROOT / "examples" / "traffic" / "drives" / "scenario-04-base.json"
# What evaluate keeps of one recording, and convert, and what a page gives to the viewer in it: for this very
# version, which alone reads it.
INTERNAL = {
    "roadproof/recording-findings/5",
    "roadproof/recording/3",
    "roadproof/viewer/1",
}
NOT_HEADED = {
    *(
        "road.json",
        "drive.json",
        "certificate.json",
        "none-within.json",
        "undecided.json",
        "refutation.json",
        "judged.json",
        "boundary.json",
        "simulations.json",
        "common.json",
    ),
    "trace-lock.json",
}

STRANGE = {"stranger": [[7]]}  # is nowhere what is wanted
OPTIONAL = {
    "assurance.json": {"solution", "limits"},
    "check.json": {"subject", "name", "shows", "set", "drivers", "kernel"},
    "classify.json": {"doubts"},
    "coverage.json": {"in_traffic", "trace"},
    "drive.json": {"lanes", "overlaps_allowed", "natural", "kind", "signals"},
    "monitor.json": {"exact", "robust_signal", "sampled", "pieces"},
    "refutation.json": {"assuming", "drive_sought"},
    "undecided.json": {"assuming", "doubt", "limits", "work"},
    "preventable.json": {"boundary"},
    "redundancy.json": {"road"},
    "traffic-results.json": {"drivers"},
    "verdicts.json": {"limits", "road", "doubt"},
    "witness.json": {"limits", "wishes"},
}
# What is read as its question, judge or road says.
OPEN = {"question.json": ("asked",), "judged.json": ("shows",), "refutation.json": ("trace",)}
# Objects that hold something for each of some names.
MAPS = {
    *("options", "parameters", "values", "vehicles", "lanes", "seconds", "sizes", "detectors", "scenarios"),
    *("together", "notes", "failed", "elsewhere", "situations", "begins", "covered", "start"),
    "open",
    *("fixed", "at"),
    *("not_checked", "sets", "parts", "counts", "wishes", "driven"),
}
Place = tuple[str | int, ...]
Run = Callable[..., Any]


def validator(name: str, schemas: Mapping[str, Any] = SCHEMAS) -> Draft202012Validator:
    known = Registry().with_resources((n, Resource.from_contents(x)) for n, x in schemas.items())
    return Draft202012Validator(schemas[name], registry=known)


def accept(name: str, data: Any) -> None:
    """Raises ``AssertionError`` with place and rule where the data is not what the schema says."""
    faults = [
        f"{'.'.join(map(str, x.absolute_path))}: {x.message[:300]}" for x in validator(name).iter_errors(data)
    ]
    assert not faults, f"{name}: {faults[:3]}"


def places(data: Any, at: Place = ()) -> Iterator[Place]:
    """Every field, of lists the first entry and the last; evidence inside is left to its own schema."""
    yield at
    if isinstance(data, dict) and not (at and "schema" in data):
        for key in data:
            yield from places(data[key], (*at, key))
    elif isinstance(data, list) and data:
        for k in sorted({0, len(data) - 1}):
            yield from places(data[k], (*at, k))


def value_at(data: Any, place: Place) -> Any:
    for step in place:
        data = data[step]
    return data


def spoiled(name: str, data: Any) -> Iterator[tuple[str, Any]]:
    """The data with another type, without a field or with one more, each at every place."""
    for place in places(data):
        if place[:1] == OPEN.get(name):
            continue
        if place:
            *above, step = place
            made = deepcopy(data)
            value_at(made, tuple(above))[step] = STRANGE
            yield f"another type at {place}", made
            free = bool(above) and above[-1] in MAPS
            if isinstance(step, str) and not free and step not in (*OPTIONAL.get(name, ()), "seconds"):
                made = deepcopy(data)
                del value_at(made, tuple(above))[step]
                yield f"nothing at {place}", made
        if isinstance(value_at(data, place), dict):
            made = deepcopy(data)
            value_at(made, place).update(STRANGE)
            yield f"one more at {place}", made


def refuse_spoiled(name: str, data: Any, schemas: Mapping[str, Any] = SCHEMAS) -> None:
    """Raises ``AssertionError`` where data is taken that is spoiled."""
    checking = validator(name, schemas)
    taken = [what for what, made in spoiled(name, data) if checking.is_valid(made)]
    assert not taken, f"{name}: {taken[:5]}"


def examine(*documents: Any, folder: Path | None = None) -> None:
    """Documents, and all that is in a folder: each is what its schema says, and is refused once spoiled."""
    named = [(NAMES[data["schema"]], data) for data in documents]
    for path in sorted(folder.rglob("*.json")) if folder is not None else ():
        data = json.loads(path.read_text("utf-8"))
        named.append((NAMES[data["schema"]], data))
    seen: set[str] = set()
    for name, data in named:
        accept(name, data)
        if name not in NOT_HEADED:
            assert [*data][:3] == [*heading("", bundled_library())]
        if name not in seen:
            refuse_spoiled(name, data)
        seen.add(name)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """What a command prints with ``--json -``, under whatever verdict."""

    def asked(command: str, *words: object, js: tuple[str, ...] = ("--json", "-")) -> Any:
        capsys.readouterr()
        assert main([command, *map(str, words), *js]) in (0, 3, 10, 20)
        return json.loads(capsys.readouterr().out)

    return asked


@pytest.fixture(scope="module")
def traffic(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    write_highd(simulate(TrafficSettings(seconds=20), 1), path)
    return path


# --- commands -------------------------------------------------------------------------------------


def of_road(run: Run, out: Path, traffic: Path) -> None:
    motorway = ROOT / "examples/maps/motorway.xodr"
    examine(run("road", str(motorway)), run("road", f"{motorway}#lanes=left,from=100"))


def of_list(run: Run, out: Path, traffic: Path) -> None:
    examine(run("list"), run("list", "--set", "ext"))


def of_show(run: Run, out: Path, traffic: Path) -> None:
    for what in (
        "fasterThan(SV, POV)",
        "every l in lanelets(L): occ(SV, l)",
        "some x in {SV, POV}: v_lon(x) > 1 m/s",
        "true U[0, 2 s] (G false or false)",
        *("-v_lon(SV) > 2 m/s", "v_lon(SV) + rho * 2 m/s^2 > 2 m/s", "1/2 * rho > 2 s"),
        *("true -> not false", "F[1 s, inf] true", "v_lon(SV) ^ 2 != v_lat(SV) ^ 2"),
    ):
        examine(run("show", what, js=("--format", "json")))
    for what in ("7", "cutIn"):
        accept("show.json", run("show", what, js=("--format", "json")))


def of_prove(run: Run, out: Path, traffic: Path) -> None:
    own = (
        "danger(SV,POV) -> danger(SV,POV)",
        "v_lon(SV) > 0 m/s -> F danger(SV,POV)",
        "false -> danger(SV,POV)",
    )
    jump = "aheadOf(SV,POV) -> G aheadOf(SV,POV)"
    examine(run("prove", *own, "--jobs", 1), run("prove", *own, "--jobs", 1, "--out", out / "own"))
    examine(run("prove", jump, "--no-drive", "--jobs", 1, "--out", out / "jump"), folder=out)
    within = ("--engine", "smt", "--horizon", "6/5", "--dt", "3/5")
    bounded = run("prove", "G v_lon(SV) < 200 m/s", *within, "--jobs", 1)
    assert "limits" in bounded["verdicts"][0]
    examine(bounded)
    moved = (
        "G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) < s(POV)",
        "assuming motion, a_lon(SV) <= 2 m/s^2: v_lon(SV) <= 20 m/s -> G[0, 2 s] v_lon(SV) <= 24 m/s",
        "atLane(SV,L) -> G atLane(SV,L) or (atLane(SV,L) U not atLane(SV,L))",
        "s(SV) < s(POV) -> G s(SV) < s(POV)",
    )
    told = run("prove", *moved, "--assume", "motion", "--jobs", 1, "--out", out / "motion")
    assert [x["refuted_by"] for x in told["verdicts"]] == [None, None, None, "drive"]
    examine(told, folder=out / "motion")


def of_check(run: Run, out: Path, traffic: Path) -> None:
    run(
        "prove", "false -> danger(SV,POV)", "not (false -> danger(SV,POV))", "--jobs", 1, "--out", out / "own"
    )
    (out / "broken.json").write_text("{", "utf-8")
    (out / "own" / "more.json").write_bytes(DRIVE.read_bytes())
    told = run("check", out, DRIVE, "--jobs", 1)
    assert {x["outcome"] for x in told["findings"]} == {"accepted", "rejected", "unreadable"}
    examine(told)


def of_assurance(run: Run, out: Path, traffic: Path) -> None:
    run("prove", "false -> danger(SV,POV)", "--jobs", 1, "--out", out / "own")
    goal = "goal = 'It holds'\nsupported-by = 'Sn1'\n"
    for name, verdict in (("good", "PROVED"), ("bad", "REFUTED")):
        solution = f"solution = 'A proof'\nevidence = 'own'\nexpect = '{verdict}'\n"
        (out / f"{name}.toml").write_text(f"[G1]\n{goal}[Sn1]\n{solution}", "utf-8")
    told = [run(command, out / "bad.toml", "--jobs", 1) for command in ("assurance", "check")]
    assert told[0] == told[1]
    assert told[0]["open_points"]
    examine(told[0], run("assurance", out / "good.toml", "--jobs", 1))


def of_witness(run: Run, out: Path, traffic: Path) -> None:
    none = ("v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s", "F[0, 1 s] v_lon(SV) > 200 m/s")
    told = run("witness", 4, *none, "--jobs", 1, "--no-pictures", "--out", out)
    assert [x["verdict"] for x in told["verdicts"]] == ["WITNESSED", "IMPOSSIBLE", "NONE-WITHIN"]
    examine(told, folder=out)


def of_compare(run: Run, out: Path, traffic: Path) -> None:
    told = run("compare", "danger(SV,POV)", "F danger(SV,POV)", "--out", out)
    assert told["relation"] == "stronger"
    examine(told, folder=out)


def of_monitor(run: Run, out: Path, traffic: Path) -> None:
    dense = run("monitor", 4, DRIVE)
    other = run("monitor", 4, DRIVE, "--set", "ext", "--param", "rho=1", "--option", "speed=total")
    assert {x["what"].split()[0] for x in other["overruled"]} == {"set", "parameter", "option"}
    examine(dense, other, run("monitor", "F v_lon(SV) > 90 m/s", DRIVE, "--view", "recorded"))
    for line in (["F v_lon(SV) > 90 m/s"], ["v_lon(SV) > 20 m/s"], [4, "--view", "recorded"]):
        examine(run("monitor", line[0], DRIVE, *line[1:], "--robust-signal"))


def of_evaluate(run: Run, out: Path, traffic: Path) -> None:
    told = run("evaluate", traffic, "--out", out, "--no-pictures", "--jobs", 1)
    assert json.loads((out / "results.json").read_text("utf-8")) == told
    asked = ("--among", "1,4", "--drivers", "careful,r157", "--no-pictures", "--jobs", 1)
    examine(told, run("evaluate", traffic, "--out", out / "drivers", *asked))


def of_preventable(run: Run, out: Path, traffic: Path) -> None:
    asked = ("cut-out", "--at", "Ve0=60km/h", "--lines", 3, "--jobs", 1)
    told = run("preventable", *asked, "--no-pictures", "--out", out)
    assert {x["verdict"] for x in (*told["plates"], *told["lemmas"])} == {"WITNESSED", "PROVED"}
    examine(told, folder=out)
    examine(run("preventable", *asked, "--no-lemmas"))


def of_falsify(run: Run, out: Path, traffic: Path) -> None:
    vehicles = Path(__file__).parents[1] / "extensions" / "closed_loop" / "vehicles.py"
    asked = ("--among", 4, "--drivers", "careful", "--simulations", 100, "--jobs", 1, "--no-classes")
    told = run("falsify", f"{vehicles}:LateBrake", *asked, "--no-pictures", "--out", out)
    assert [x["finding"] for x in told["targets"]] == ["FAILS"]
    examine(told, folder=out)
    examine(run("falsify", f"{vehicles}:LateBrake", *asked))


def of_resimulate(run: Run, out: Path, traffic: Path) -> None:
    vehicles = Path(__file__).parents[1] / "extensions" / "closed_loop" / "vehicles.py"
    asked = (f"{vehicles}:Speeding", traffic, "--drivers", "careful", "--jobs", 1)
    told = run("resimulate", *asked, "--no-pictures", "--out", out)
    assert {x["finding"] for x in told["occurrences"]} == {"FAILS", "KEPT"}
    examine(told, folder=out)
    examine(run("resimulate", *asked))


def of_overlap(run: Run, out: Path, traffic: Path) -> None:
    asked = ("--among", "4,5,8", "--jobs", 1)
    told = run("overlap", *asked, "--no-pictures", "--out", out)
    assert {x["verdict"] for x in told["verdicts"]} == {"WITNESSED", "IMPOSSIBLE"}
    examine(told, folder=out)
    examine(run("overlap", "--among", "4,5", "--jobs", 1))


def of_order(run: Run, out: Path, traffic: Path) -> None:
    asked = ("--among", "3-4", "--set", "base", "--set", "extA", "--jobs", 1)
    told = run("order", *asked, "--no-pictures", "--out", out)
    assert told["proved"]
    assert told["missing"]
    examine(told, folder=out)


def of_redundancy(run: Run, out: Path, traffic: Path) -> None:
    fast = "v_lon(SV) > 3 m/s and v_lon(SV) > 2 m/s"
    (out / "mine.spec").write_text(
        f'def scenario_90(SV, POV: vehicle, L: lane) "SV is fast" := {fast}\n', "utf-8"
    )
    asked = ("--spec", out / "mine.spec", "--among", 90, "--whole", "--effort", 2, "--jobs", 1)
    told = run("redundancy", *asked, "--out", out / "out")
    files = [json.loads((out / "out" / x["evidence"]).read_text("utf-8")) for x in told["verdicts"]]
    kinds = {x["schema"].split("/")[1] for x in files}
    assert kinds == {"certificate", "drive", "refutation"}
    examine(told, folder=out / "out")


def of_coverage(run: Run, out: Path, traffic: Path) -> None:
    asked = ("--road", "main-2", "--effort", 0.2, "--no-pictures", "--jobs", 1)
    with pytest.MonkeyPatch.context() as patch:
        few_classes(patch)
        told = run("coverage", "--set", "ext", *asked, "--on", traffic, "--out", out / "gaps")
        assert {x["verdict"] for x in told["classes"]} == {"WITNESSED"}
        examine(told, folder=out / "gaps")
        patch.setattr(coverage_claims, "claims_of", claims("danger(SV,POV) -> danger(SV,POV)"))
        patch.setattr(coverage_question, "own_definitions", lambda _: ("cutIn",))
        told = run("coverage", "--set", "complete", "--needed", *asked, "--out", out / "needs")
        assert told["needs"]
        examine(told, folder=out / "needs")


def few_classes(patch: pytest.MonkeyPatch) -> None:
    """One class, some of the simple drives."""
    best = SimpleDrives.best
    patch.setattr(GapClasses, "groups", components("behaviourPOV_4"))
    patch.setattr(SimpleDrives, "best", lambda self, start, _: best(self, 0, 98) if start == 0 else {})


def claims(text: str) -> Callable[[Specification], tuple[Query, ...]]:
    return lambda specification: (read_claim(specification, text),)


def of_classify(run: Run, out: Path, traffic: Path) -> None:
    told = run("classify", "--among", 4, "--on", traffic, "--no-pictures", "--jobs", 1, "--out", out)
    assert told["shares"]
    examine(told, folder=out)


def of_catalogue(run: Run, out: Path, traffic: Path) -> None:
    tests = out / "tests"
    tests.mkdir()
    (tests / "one.json").write_bytes(DRIVE.read_bytes())
    (tests / "torn.json").write_bytes(DRIVE.read_bytes()[:300])
    (tests / "catalogue.toml").write_text(
        "[[test]]\nid = 'slow'\nformula = 'scenario_4(SV,POV,L)'\nclaims = [4]\n"
        "at_start = { 'v_lon(SV)' = '10 m/s .. 20 m/s' }\n"
        "[[test]]\nid = 'never'\nformula = 'v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s'\n",
        "utf-8",
    )
    asked = ("--among", 4, "--jobs", 1)
    told = run("catalogue", tests, *asked, "--no-pictures", "--out", out / "report")
    assert {x["relation"] for x in told["facts"]} >= {"runs", "implies", "empty"}
    assert told["faults"]
    examine(told, folder=out / "report")
    checked = run("check", out / "report", "--jobs", 1)
    assert "test" in {x["kind"] for x in checked["findings"]}
    examine(checked)
    examine(run("catalogue", tests, *asked, "--no-classes"))


def of_explore(run: Run, out: Path, traffic: Path) -> None:
    slower = "v_lon(SV) > 29 m/s and F[0, 1 s] v_lon(SV) < 29 m/s"
    vary = ("--vary", "SV.a_lon.min=-3:0", "--steps", 3, "--precision", 1)
    varied = run("explore", slower, *vary, "--jobs", 1, "--no-pictures", "--out", out / "varied")
    least = run("explore", "v_lon(SV) > 30 m/s", "--least", "v_lon(SV)", "--precision", 1, "--jobs", 1)
    assert varied["explored"][0]["boundaries"]
    assert least["explored"][0]["extremes"]
    examine(varied, least, folder=out)


def of_trace(run: Run, out: Path, traffic: Path) -> None:
    (out / "brake.json").write_bytes(DRIVE.read_bytes())
    text = '[trace]\nevidence = ["brake.json"]\n[[requirement]]\nid = "A"\ntext = "B"\nscenarios = [{}]\n'
    file = out / "requirements.toml"
    for number in (4, 5):
        file.write_text(text.format(number), "utf-8")
        told = run("trace", file, "--accept", "--out", out / str(number), "--jobs", 1)
        examine(told, json.loads((out / "requirements.lock.json").read_text("utf-8")))
        assert [x["state"] for x in told["requirements"]] == [{4: "witnessed", 5: "missing"}[number]]
    changes = run("trace", "--baseline", out / "4" / "trace.json", out / "5" / "trace.json")
    assert {x["how"] for x in changes["changes"]} == {"added", "removed", "worse"}
    examine(changes)


ASKED: Mapping[str, Callable[[Run, Path, Path], None]] = {
    name.removeprefix("of_"): function for name, function in globals().items() if name.startswith("of_")
}


@pytest.mark.parametrize("command", ASKED)
def test_what_a_command_says_is_what_its_schema_says(
    command: str, run: Run, tmp_path: Path, traffic: Path
) -> None:
    (tmp_path / "out").mkdir()
    ASKED[command](run, tmp_path / "out", traffic)


def test_every_command_is_asked() -> None:
    assert {*COMMANDS} - {*ASKED} == {
        *(
            "simulate",
            "compile",
            "export",
            "convert",
            "report",
            "studio",
            "completion",
            "cache",
            "atlas",
            "bundle",  # tests/extensions/assurance/bundling
            "extensions",  # tests/core
        )  # which have no JSON, or are asked elsewhere
    }


# --- files that are shipped -----------------------------------------------------------------------


def test_shipped_evidence_is_what_its_schema_says() -> None:
    folders = (ROOT / "proofs", DRIVE.parent, ROOT / "tests/extensions/traffic/planted")
    paths = [path for folder in folders for path in sorted(folder.glob("*.json"))]
    assert len(paths) > 150
    for path in paths:
        data = json.loads(path.read_text("utf-8"))
        accept(NAMES[data["schema"]], data)


def with_jerk() -> dict[str, Any]:
    """A judged drive of the second version."""
    data: dict[str, Any] = json.loads(DRIVE.read_text("utf-8")) | {"schema": "roadproof/drive/2"}
    for motion in data["vehicles"].values():
        for piece in motion["pieces"]:
            piece["j_lon"] = "0"
        motion["pieces"][0]["j_lon"] = "1/1000"
    return JudgedDrive(read_drive(data, "test"), bundled_library()).as_data()


def test_spoiled_evidence_is_refused() -> None:
    refuse_spoiled("drive.json", json.loads(DRIVE.read_text("utf-8")))
    accept("drive.json", with_jerk())
    assert with_jerk()["schema"] == "roadproof/drive/2"
    refuse_spoiled("drive.json", with_jerk())
    proof = ROOT / "proofs" / "P1-scenario-04-base.json"
    refuse_spoiled("certificate.json", json.loads(proof.read_text("utf-8")))
    search = search_for("v_lon(SV) > 41 m/s and atLane(SV, L)", horizon=Fraction(3, 5))
    found = refute_with_trees(search)
    assert found is not None
    accept("none-within.json", none_within_data(found))
    refuse_spoiled("none-within.json", none_within_data(found))


# --- the schemas ----------------------------------------------------------------------------------


def parts_of(schema: Any) -> Iterator[Mapping[str, Any]]:
    if isinstance(schema, dict):
        yield schema
    for inside in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        yield from parts_of(inside)


@pytest.mark.parametrize("name", SCHEMAS)
def test_schemas_are_schemas_and_leave_nothing_open(name: str) -> None:
    schema = SCHEMAS[name]
    Draft202012Validator.check_schema(schema)
    assert (schema["$id"], schema["$schema"].rpartition("/")[2]) == (name, "schema")
    for part in parts_of(schema):
        if part.get("type") == "object":
            closed = part.get("additionalProperties", part.get("unevaluatedProperties"))
            by_kind = "allOf" in part  # each alternative is closed
            assert by_kind or closed is False or isinstance(closed, dict), part
        if part.get("type") == "array":
            assert "items" in part or "prefixItems" in part, part
        if "$ref" in part and isinstance(part["$ref"], str):
            file, _, inside = part["$ref"].partition("#/")
            value_at(SCHEMAS[file or name], tuple(inside.split("/")) if inside else ())


def test_every_schema_of_the_source_is_written_down() -> None:
    texts = (path.read_text("utf-8") for path in (ROOT / "src" / "roadproof").rglob("*.py"))
    named = {
        found
        for text in texts
        for found in re.findall(r'[A-Z]+(?:: Final)? = "(roadproof/[a-z-]+/[0-9]+)"', text)
    }
    assert named == {*NAMES} | INTERNAL


def test_the_page_lists_every_schema() -> None:
    page = (FOLDER / "README.md").read_text("utf-8")
    assert {*re.findall(r"\]\(([a-z-]+\.json)\)", page)} == {*SCHEMAS}
    assert {*re.findall(r"`(roadproof/[a-z-]+/[0-9]+)`", page)} == {*NAMES}


def loosened(change: str) -> dict[str, Any]:
    """The schemas with one hole in that of ``list``."""
    schemas = deepcopy(dict(SCHEMAS))
    option = schemas["list.json"]["$defs"]["option_data"]
    match change:
        case "a field is not required":
            option["required"].remove("chosen")
        case "a field may be anything":
            option["properties"]["doc"] = {}
        case _:
            del option["additionalProperties"]
    return schemas


@pytest.mark.parametrize(
    "change", ["a field is not required", "a field may be anything", "there may be more"]
)
def test_planted_holes_in_a_schema_are_noticed(change: str) -> None:
    told = {
        **heading("roadproof/list/1", bundled_library()),
        "set": "base",
        "scenarios": [],
        "definitions": [],
    }
    told |= {"sets": [], "parameters": []}
    told |= {"options": [{"name": "x", "values": ["a"], "chosen": "a", "doc": ""}]}
    accept("list.json", told)
    refuse_spoiled("list.json", told)
    with pytest.raises(AssertionError):
        refuse_spoiled("list.json", told, loosened(change))


def test_the_answers_of_python_are_those_of_the_command_line() -> None:
    told = rp.witness("v_lon(SV) > 3 m/s", jobs=1).as_data()
    accept("witness.json", json.loads(json.dumps(told)))
