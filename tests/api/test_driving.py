"""Drives out of given pieces: what comes out of the judge is what any evidence is."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from fractions import Fraction
from fractions import Fraction as F
from pathlib import Path

import polars as pl
import pytest

import roadproof as rp
from extensions.exchange.exporting.shipped_drives import motion as motion_from
from extensions.exchange.exporting.shipped_drives import shipped_drives, subject
from planting import plant
from roadproof.engines.prove.motion import prove_for_motions
from roadproof.engines.search import minimal
from roadproof.engines.search.minimal import simplest
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, drive_data
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.catalogue.reading import is_test
from roadproof.extensions.exchange.export.registry import FORMATS
from roadproof.extensions.kernel.derivation import rational
from roadproof.extensions.kernel.derivations.prepare import prepare
from roadproof.extensions.pages.studio.dropping import drop
from roadproof.extensions.pages.studio.requests import read_question
from roadproof.extensions.pages.viewer_data import viewer_data
from roadproof.extensions.traffic.evaluate.one_trace import sample_drive
from roadproof.frontends.api.driving import drive, motion
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import motion as schemas
from roadproof.logic import terms as t
from roadproof.runtime.budget import Effort
from roadproof.runtime.files import write_json
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import state_at
from roadproof.world.signals import SIGNALS

BRAKING = [(1, 0, -4), (2, -4, 0), (1, -4, 4)]
"""Braking that builds up to 4 m/s², is held for 2 s and goes away again, which takes 12 m/s."""


def pair() -> dict[str, Motion]:
    return {"SV": motion(0, 2.6, 29), "POV": motion(80, 2.8, 28, along=BRAKING)}


def test_a_given_drive_is_judged_and_can_be_checked(tmp_path: Path) -> None:
    made = drive(4, pair(), using=rp.load("ext", params={"minDanger": 1}))
    assert (made.file.scenario, made.file.set_name, made.file.lanes) == (4, "ext", {"L": "main-1"})
    assert made.file.values["minDanger"] == 1
    assert made.judgement.holds
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(made.as_data()), "utf-8")
    assert json.loads(path.read_text("utf-8"))["schema"] == "roadproof/drive/2"
    assert rp.check(path).accepted
    assert rp.monitor("F[4 s, 4 s] (v_lon(POV) = 16 m/s and a_lon(POV) = 0)", path).verdict == "true"
    assert rp.monitor("decelerates(POV)", path, rp.load("ext")).observed.strips[0].true == ((0.0, 4.0),)


def test_numbers_are_exact_and_may_have_units() -> None:
    made = motion("1/3", 2.6, "108 km/h", 0.1, [("500 ms", 0.1, -0.3)], [(1, "1/10")], kind="truck")
    assert (made.s, made.d, made.v_lon, made.v_lat, made.kind) == (F(1, 3), F(13, 5), 30, F(1, 10), "truck")
    assert [(x.duration, x.a_lon, x.a_lat, x.j_lon) for x in made.pieces] == [
        (F(1, 2), F(1, 10), F(1, 10), F(-3, 10)),
        (F(1, 2), 0, F(1, 10), 0),
        (None, 0, 0, 0),
    ]


def test_the_first_lane_on_which_it_holds_is_taken() -> None:
    left = {"SV": motion(0, 6, 29), "POV": motion(80, 6.2, 28, along=BRAKING)}
    assert drive(4, left).file.lanes == {"L": "main-2"}
    with pytest.raises(rp.InputError, match="the formula does not hold on the drive: scenario_4"):
        drive(4, left, lanes={"L": "main-1"})


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: motion(0, 3, 30, along=[(0, 1, 1)]), "duration=0 s: every duration is above 0"),
        (lambda: motion(0, 3, 30, along=[(1, 1)]), r"along: \(1, 1\) is not an entry: each has 3 numbers"),
        (lambda: motion(0, 3, 30, across=["12"]), "across: '12' is not an entry: each has 2 numbers"),
        (lambda: motion(0, 3, 30, along=[(1, 1, "2 m")]), "along=2 m"),
        (lambda: motion(0, 3, 30, length=0), "a box needs length=0 > 0"),
        (lambda: motion(0, 3, 30, kind="lorry"), "kind='lorry': write car, truck"),
        (lambda: drive("v_lon(SV) > 30 m/s", {"SV": motion(0, 3, 30)}), "does not hold on the drive"),
        (lambda: drive(4, {"SV": motion(0, 3, 30)}), "has no vehicle POV"),
        (lambda: drive(4, pair(), lanes={"L": "main-9"}), "lane L=main-9"),
        (lambda: drive("true", pair(), horizon=0), "horizon=0"),
        (lambda: drive("true", pair() | {"POV": motion(4, 3, 30)}), "overlap from 0 s on"),
    ],
)
def test_mistakes_are_told(ask: object, message: str) -> None:
    with pytest.raises(rp.RoadproofError, match=message):
        ask()  # type: ignore[operator]


def test_boxes_may_overlap_where_that_is_said() -> None:
    made = drive("true", pair() | {"POV": motion(4, 3, 30)}, collisions=True)
    assert isinstance(made, JudgedDrive)
    assert made.file.overlaps_allowed


# --- A drive with jerk, put to what reads drives: each is right, or refuses it by name --------------

LIBRARY = bundled_library()
VEHICLES = {
    "SV": motion(0, 2.6, 29, along=[(1, 0, -1), (1, -1, 1)]),
    "POV": motion(70, 2.8, 28, along=BRAKING, across=[(1, 0.1), (1, -0.1)]),
}
FILE = drive(4, VEHICLES, rp.load("ext")).file
VIEWER = Path(__file__).parents[2] / "src/roadproof/extensions/pages/viewer/drive.js"


# --- monitor ---------------------------------------------------------------------------------------


def test_jerk_is_a_column_of_the_samples_of_a_drive() -> None:
    trace = sample_drive(FILE.drive, FILE.road, F(6), F(1, 4), "drive")
    for name, moving in VEHICLES.items():
        for signal in SIGNALS:
            for k in range(25):
                exact = getattr(state_at(moving, F(k, 4)), signal)
                assert trace.batch.signals[signal, name][k, 0] == float(exact)
    asked = "j_lon(POV) = -4 m/s^3 and F[1 s, 1 s] j_lon(POV) = 0 and F[3 s, 3 s] j_lon(POV) = 4 m/s^3"
    for view in ("dense", "recorded"):
        seen = rp.monitor(f"{asked} and G j_lon(SV) <= 1 m/s^3", FILE, view=view)  # type: ignore[arg-type]
        assert seen.verdict == ("true" if view == "dense" else "undecided")
        assert rp.monitor(asked, FILE, view=view).verdict == "true"  # type: ignore[arg-type]
        assert rp.monitor(f"not ({asked})", FILE, view=view).verdict == "false"  # type: ignore[arg-type]


def test_samples_of_files_have_none_and_say_so(tmp_path: Path) -> None:
    """A column of that name is none either: of recordings nobody knows what it was computed from."""
    rp.export(FILE, "csv", tmp_path)
    path = tmp_path / "scenario-04-ext.csv"
    assert rp.monitor(4, path, rp.load("ext")).verdict == "true"
    pl.read_csv(path).with_columns(j_lon=pl.lit(5.0)).write_csv(path)
    for source in (path, pl.read_csv(path), f"{path}:1,2"):
        with pytest.raises(InputError, match="no recording has the signal j_lon"):
            rp.monitor("F j_lon(SV) > 1 m/s^3", source)
        assert rp.monitor("F v_lon(SV) > 1 m/s", source).verdict == "true"


# --- files -----------------------------------------------------------------------------------------


def test_what_looks_for_drives_among_files_finds_it(tmp_path: Path) -> None:
    path = tmp_path / "drives" / "smooth.json"
    path.parent.mkdir()
    path.write_text(json.dumps(JudgedDrive(FILE, LIBRARY).as_data()), "utf-8")
    assert rp.check(path.parent).accepted
    assert [x.name for x in rp.export(path.parent, "csv", tmp_path / "csv").drives] == ["smooth"]
    assert is_test(path)
    found = rp.catalogue(path.parent, among="4", using=rp.load("ext"), classes=False, jobs=1)
    assert "scenario_4" in [x.what for x in found.concrete[0].shown]
    made = rp.page(path.parent, out=tmp_path / "page.html", jobs=1)
    assert (made.results, made.drives) == (1, 1)
    files = [{"name": "smooth.json", "content": path.read_text("utf-8")}]
    draft = {"base": "ext", "text": "", "before": None, "options": {}, "params": {}}
    dropped = drop(read_question({"files": files, "draft": draft, "set": "ext"}))
    assert dropped["drive"]["schema"] == "roadproof/drive/2"
    assert dropped["view"]["formulas"][0]["holds"] is True
    [finding] = rp.check(path, kernel="coq").findings if shutil.which("coqc") else [None]
    assert finding is None or finding.kernel == "accepted"


# --- pictures --------------------------------------------------------------------------------------


def test_the_viewer_is_where_the_drive_is() -> None:
    document = viewer_data(FILE, LIBRARY).as_json()["drive"]
    for name, moving in VEHICLES.items():
        knots = document["vehicles"][name]["knots"]
        assert [x[0] for x in knots] == ([0, 1, 2] if name == "SV" else [0, 1, 2, 3, 4])
        assert [x[7] for x in knots] == [float(x.j_lon) for x in moving.pieces]
    if (node := shutil.which("node")) is None:
        pytest.skip("no node to run the viewer's arithmetic in")
    script = VIEWER.read_text("utf-8").replace("export function", "function") + (
        "const [vehicle, times] = JSON.parse(require('fs').readFileSync(0, 'utf8'));"
        "console.log(JSON.stringify(times.map((x) => stateAt(vehicle, x))));"
    )
    times = [0, 0.5, 1, 1.25, 3, 3.75, 5.5]
    for name, moving in VEHICLES.items():
        given = json.dumps([document["vehicles"][name], times])
        done = subprocess.run([node, "-e", script], input=given, text=True, capture_output=True, check=True)
        for time, found in zip(times, json.loads(done.stdout), strict=True):
            exact = state_at(moving, F(time))
            expected = (exact.s, exact.d, exact.v_lon, exact.v_lat, exact.a_lon, exact.a_lat)
            assert [*found.values()] == pytest.approx([float(x) for x in expected])


# --- searches and proofs ---------------------------------------------------------------------------


def test_a_no_says_that_there_was_no_jerk_where_a_formula_speaks_of_it() -> None:
    for formula, told in (("F j_lon(SV) > 0", True), ("v_lon(SV) > 41 m/s", False)):
        outcome = rp.witness(formula, horizon=2, dt=1, jobs=1).outcomes[0]
        assert outcome.verdict is Verdict.NONE_WITHIN
        assert ("accelerations constant between them, so that jerk is 0," in outcome.reason) == told
        assert outcome.limits is not None
        limits = outcome.limits["accelerations"]
        assert limits == "constant between samples, none after the last" + (", no jerk" if told else "")
    assert rp.witness("F j_lon(SV) = 0", horizon=2, dt=1, jobs=1).verdict is Verdict.WITNESSED


def test_acceleration_is_not_the_integral_of_jerk(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may jump, so what would follow from an integral is no fact about motion: a jump refutes it."""
    assert "a_lon" not in schemas.RATES
    assert not schemas.is_continuous(t.Signal("j_lon", "SV"))
    for term in (t.Signal("a_lon", "SV"), t.Signal("j_lon", "SV")):
        with pytest.raises(ValueError, match="have a rate"):
            schemas.rate(term)
    claim = "a_lon(SV) <= 0 and G j_lon(SV) <= 0 -> G a_lon(SV) <= 0"
    assert rp.prove(claim, assume="motion", jobs=1).verdict is Verdict.REFUTED
    with monkeypatch.context() as patch:  # planted: it would be proved
        patch.setattr(schemas, "RATES", {**schemas.RATES, "a_lon": "j_lon"})
        query = read_claim(LIBRARY.select("base"), claim)
        found = prove_for_motions(LIBRARY.select("base"), query, ("motion",), Effort(5))
        assert found.verdict is Verdict.PROVED
    assert rp.prove("j_lon(SV) > 2 m/s^3 -> not j_lon(SV) <= 1 m/s^3", jobs=1).verdict is Verdict.PROVED


def test_the_kernel_is_told_of_jerk() -> None:
    prepared = prepare("drive", FILE, LIBRARY)
    assert prepared.module is not None
    jerks = [piece.j_lon for piece in FILE.drive.vehicles["SV"].pieces[:-1]]
    [told] = re.findall(r'\("SV".*?pieces := \[(.*?)\]', prepared.module.text, re.DOTALL)
    assert any(jerks)
    assert re.findall(r", (\S+|\(-?\S+\)|\([^()]* # [^()]*\))\)(?:;|$)", told) == [rational(x) for x in jerks]


# --- drives made simpler ---------------------------------------------------------------------------


def laboured(formula: str) -> DriveFile:
    """With jerk that comes to nothing in SV, and that the formula may need in POV."""
    mine = motion(0, 2.6, 30, along=[(1, 0, 1), (1, 1, -1), (1, 0, -2), (1, -2, 2)])
    return replace(FILE, scenario=None, formula=formula, drive=rp.drive("true", {"SV": mine}).file.drive)


def simple(formula: str) -> Motion:
    file = laboured(formula)
    found = simplest(file, read_claim(LIBRARY.select("base"), formula), LIBRARY)
    assert judge_file(found, LIBRARY).accepted
    return found.drive.vehicles["SV"]


def test_jerk_that_is_not_needed_goes() -> None:
    assert simple("G v_lon(SV) > 20 m/s").pieces == (Piece(None, F(0), F(0)),)
    assert any(x.j_lon for x in simple("F j_lon(SV) < 0 and F v_lon(SV) > 30.9 m/s").pieces)


def test_pieces_with_one_mean_change_the_speed_as_before() -> None:
    mine = laboured("true").drive.vehicles["SV"]
    for place in range(3):
        shorter = minimal._with_mean(mine, place)
        assert len(shorter.pieces) == len(mine.pieces) - 1
        assert state_at(shorter, F(4)).v_lon == state_at(mine, F(4)).v_lon


def test_pieces_with_jerk_are_not_merged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two pieces that begin alike are not one piece: each begins with its own acceleration."""
    twice = motion(0, 2.6, 30, along=[(1, 0, 1), (1, 0, 1), (1, 2, 0), (1, 2, 0)])
    assert [x.duration for x in minimal._merged(twice).pieces] == [1, 1, 2, None]
    plant(monkeypatch, minimal, "_constant", "None if piece.j_lon else ", "")
    assert [x.duration for x in minimal._merged(twice).pieces] == [2, 2, None]


# --- rp.export: what is taken, what is refused, and that a folder is written whole or not at all ----


@pytest.fixture
def drives(tmp_path: Path) -> Path:
    """Two drive files, and beside them evidence of another kind."""
    folder = tmp_path / "drives"
    for name in ("scenario-04-base", "scenario-12-ext"):
        write_json(folder / f"{name}.json", drive_data(shipped_drives()[name], {}))
    write_json(folder / "index.json", {"schema": "roadproof/index/1"})
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {str(x.relative_to(folder)): x.read_bytes() for x in sorted(folder.rglob("*.*"))}


def test_a_folder_of_drives_in_every_format(drives: Path, tmp_path: Path) -> None:
    made = rp.export(drives, FORMATS, tmp_path / "out")
    assert {x.relative_to(made.folder).parts[0] for x in made.files} == {*FORMATS}
    assert {*made.files} == {x for x in made.folder.rglob("*.*") if x.is_file()}
    assert str(made) == f"2 drives as {', '.join(FORMATS)}: {len(made.files)} files in {made.folder}"
    frame = made.to_frame()
    assert frame.filter(format="highd")["files"].to_list()[0].startswith("highd/01_recordingMeta.csv")
    assert frame["vehicles"].unique().to_list() == ["SV=1 POV=2"]


def test_values_paths_and_files_are_the_same(drives: Path, tmp_path: Path) -> None:
    file = shipped_drives()["scenario-04-base"]
    given = (drives / "scenario-04-base.json", file, JudgedDrive(file, bundled_library()))
    each = [rp.export(x, "openscenario", tmp_path / f"{k}") for k, x in enumerate(given)]
    found = [contents(x.folder) for x in each]
    assert [*found[0]] == ["scenario-04-base.xodr", "scenario-04-base.xosc"]
    assert found[0] == found[1] == found[2]


def test_values_of_one_name_are_counted(tmp_path: Path) -> None:
    file = shipped_drives()["scenario-04-base"]
    made = rp.export([file, file], "csv", tmp_path / "out")
    assert [x.name for x in made.drives] == ["scenario-04-base", "scenario-04-base-2"]


def test_more_samples(tmp_path: Path) -> None:
    made = rp.export(shipped_drives()["scenario-04-base"], "csv", tmp_path / "out", rate=50)
    lines = made.files[0].read_text().splitlines()
    assert (len(lines), lines[3][:8]) == (1 + 2 * 301, "0.02,SV,")


def spoiled(**changes: object) -> DriveFile:
    return replace(shipped_drives()["scenario-04-base"], **changes)  # type: ignore[arg-type]


NAMED = Drive(
    {"SV": motion_from((None, "0", "0")), "a b": motion_from((None, "0", "0"), start=("90", "2", "30", "0"))}
)

ALONE = Drive({"SV": motion_from((None, "0", "0"))})


@pytest.mark.parametrize(
    ("ask", "error", "message"),
    [
        (lambda: rp.export([], "csv", "no"), rp.UsageError, "no drive to export"),
        (lambda: rp.export("nowhere.json", "csv", "no"), rp.InputError, "cannot read nowhere.json"),
        (lambda: rp.export(spoiled(), "cvs", "no"), rp.UsageError, "did you mean 'csv'"),
        (lambda: rp.export(spoiled(), (), "no"), rp.UsageError, "name a format: openscenario"),
        (lambda: rp.export(spoiled(), "csv", "no", rate=7), rp.UsageError, "rate=7: write samples"),
        (
            lambda: rp.export(spoiled(formula="false"), "csv", "no"),
            rp.InputError,
            "drive: the drive fails its check and is not exported: the formula does not hold",
        ),
        (
            lambda: rp.export(spoiled(formula="true", horizon=Fraction(1, 100)), "csv", "no"),
            rp.UsageError,
            "less than a step; write a greater rate",
        ),
        (
            lambda: rp.export(spoiled(formula="true", drive=ALONE, horizon=Fraction(10**12)), "csv", "no"),
            rp.UsageError,
            "rate=25: scenario-04-base lasts 1000000000000 s, which makes more than 1,000,000 samples",
        ),
        (
            lambda: rp.monitor("true", spoiled(formula="true", horizon=Fraction(10**12))),
            rp.InputError,
            "lasts 1000000000000 s, which makes more than 1,000,000 samples",
        ),
        (
            lambda: rp.export(spoiled(formula="true", drive=Drive({})), "csv", "no"),
            rp.InputError,
            "the drive has no vehicle",
        ),
        (
            lambda: rp.export(spoiled(formula="true", drive=NAMED), "csv", "no"),
            rp.InputError,
            "vehicle 'a b': other tools want letters",
        ),
    ],
)
def test_what_cannot_be_exported_is_told(ask, error, message, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=message):
        ask()
    assert not (tmp_path / "no").exists()


def test_nothing_is_written_where_one_of_several_is_refused(tmp_path: Path) -> None:
    turns = Drive({"SV": motion_from((None, "-10", "0"))})
    back = replace(subject().file, drive=turns, formula="true")
    with pytest.raises(rp.InputError, match="v_lon=-"):
        rp.export([shipped_drives()["scenario-04-base"], back], ["csv", "openscenario"], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_drive_prints_in_a_few_lines_and_is_saved_as_evidence(tmp_path: Path) -> None:
    made = drive("v_lon(SV) > 1 m/s and v_lon(POV) > 1 m/s", pair())
    assert str(made).splitlines() == [
        "v_lon(SV) > 1 m/s and v_lon(POV) > 1 m/s  base  WITNESSED  road main-2",
        "SV s=0 m d=2.6 m v_lon=29 m/s v_lat=0 m/s 1 piece",
        "POV s=80 m d=2.8 m v_lon=28 m/s v_lat=0 m/s 4 pieces",
    ]
    assert len(repr(made)) < 100
    assert made._repr_html_().count("<tr>") == 3
    assert "<b>v_lon(SV) &gt; 1 m/s" in made._repr_html_()
    path = made.save(tmp_path / "made.json")
    assert rp.check(path, jobs=1).accepted
    with pytest.raises(InputError, match="made"):
        made.save(path / "made.json")  # a file is no folder
