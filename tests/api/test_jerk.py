"""A drive with jerk, put to what reads drives: each is right, or refuses it by name."""

import json
import shutil
import subprocess
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import polars as pl
import pytest

import roadproof as rp
from planting import plant
from roadproof.analysis.catalogue.reading import is_test
from roadproof.analysis.coverage import minimal
from roadproof.analysis.coverage.minimal import simplest
from roadproof.engines.prove.motion import prove_of_motions
from roadproof.errors import InputError
from roadproof.evidence.derivations.prepare import prepare
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.evidence.kernel.accept import Word
from roadproof.evidence.kernel.drive import drive_lines, shown
from roadproof.frontends.api.driving import drive, motion
from roadproof.frontends.report.viewer_data import viewer_data
from roadproof.frontends.studio.dropping import drop
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import motion as schemas
from roadproof.logic import terms as t
from roadproof.recordings.evaluate.one_trace import sample_drive
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from roadproof.world.drive import Motion, Piece
from roadproof.world.motion import state_at
from roadproof.world.signals import SIGNALS

LIBRARY = bundled_library()
BRAKING = [(1, 0, -4), (2, -4, 0), (1, -4, 4)]
"""Braking that builds up to 4 m/s² within a second, is held for 2 s and goes away again."""
VEHICLES = {
    "SV": motion(0, 2.6, 29, along=[(1, 0, -1), (1, -1, 1)]),
    "POV": motion(70, 2.8, 28, along=BRAKING, across=[(1, 0.1), (1, -0.1)]),
}
FILE = drive(4, VEHICLES, rp.load("ext")).file
VIEWER = Path(__file__).parents[2] / "src" / "roadproof" / "frontends" / "report" / "viewer" / "drive.js"


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
    dropped = drop({"files": files, "draft": draft, "set": "ext"}, lambda _: None)
    assert dropped["drive"]["schema"] == "roadproof/drive/2"
    assert dropped["view"]["formulas"][0]["holds"] is True
    [finding] = rp.check(path, kernel="coq").findings if shutil.which("coqc") else [None]
    assert finding is None or finding.kernel == str(Word.UNKNOWN)


# --- pictures --------------------------------------------------------------------------------------


def test_the_viewer_is_where_the_drive_is() -> None:
    document = viewer_data(FILE, LIBRARY)["drive"]
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
        limits = outcome.limits.as_json()["accelerations"]
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
        found = prove_of_motions(LIBRARY.select("base"), query, ("motion",), Effort(5))
        assert found.verdict is Verdict.PROVED
    assert rp.prove("j_lon(SV) > 2 m/s^3 -> not j_lon(SV) <= 1 m/s^3", jobs=1).verdict is Verdict.PROVED


def test_the_kernel_says_that_it_does_not_know() -> None:
    prepared = prepare("drive", FILE, LIBRARY)
    assert prepared.module is None
    assert prepared.refusal is not None
    assert prepared.refusal.word is Word.UNKNOWN
    assert "jerk: the acceleration of SV is not constant on every piece" in prepared.refusal.reason
    with pytest.raises(InputError, match="jerk: the acceleration of SV"):
        list(drive_lines(shown(FILE, LIBRARY)))


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
