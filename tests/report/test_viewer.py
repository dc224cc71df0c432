"""The document of the viewer says what the judge says; its files are whole, and its page asks nobody."""

import json
import re
from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.evidence.drive_file import load_drive, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.frontends.report.viewer_data import ShownFormula, viewer_data
from roadproof.frontends.report.viewer_files import viewer_modules, viewer_style
from roadproof.frontends.report.viewer_page import json_in_html, viewer_page
from roadproof.frontends.report.viewer_recorded import recorded_data
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.library.uses import nearest, places_of
from roadproof.recordings.evaluate.one_trace import sample_drive
from roadproof.world.motion import state_at

VIEWER = Path(__file__).parents[2] / "src" / "roadproof" / "frontends" / "report" / "viewer"
DRIVES = Path(__file__).parents[2] / "examples" / "traffic" / "drives"
LIBRARY = bundled_library()
FILE = load_drive(next(DRIVES.glob("*04-base.json")))


def moved(knots: list[list[float]], time: float) -> tuple[float, float]:
    """Where a vehicle is, as the viewer computes it."""
    begun, s, d, v_lon, v_lat, a_lon, a_lat, j_lon = [x for x in knots if x[0] <= time][-1]
    t = time - begun
    return s + t * (v_lon + t * (a_lon / 2 + j_lon * t / 6)), d + t * (v_lat + a_lat * t / 2)


def test_places_between_knots_and_truth_are_those_of_the_judge() -> None:
    document = viewer_data(FILE, LIBRARY)
    for name, vehicle in document["drive"]["vehicles"].items():
        for tenth in range(0, 61, 7):
            state = state_at(FILE.drive.vehicles[name], Fraction(tenth, 10))
            assert moved(vehicle["knots"], tenth / 10) == pytest.approx((float(state.s), float(state.d)))
    judgement = judge_file(FILE, LIBRARY).judgement
    assert judgement is not None
    [shown] = document["formulas"]
    told = {x["text"]: x["exact"] for x in shown["parts"] if x["op"] == "name"}
    assert told == {f"{x.name}({', '.join(x.arguments)})": str(truth) for x, truth in judgement.named()}
    assert shown["holds"] is True
    assert shown["parts"][0]["margins"][0] > 0
    json.dumps(document, allow_nan=False)
    assert read_drive({**document["file"], "verdict": {}}, "document") == FILE


def test_every_part_is_in_the_tree_once() -> None:
    parts = viewer_data(FILE, LIBRARY)["formulas"][0]["parts"]
    reached, waiting = set(), [0]
    while waiting:
        place = waiting.pop()
        reached.add(place)
        waiting += [x for x in parts[place]["children"] if x not in reached]
    assert reached == set(range(len(parts)))


def test_a_formula_that_cannot_be_judged_says_why_and_leaves_the_others() -> None:
    asked = [
        ShownFormula("question", "danger(SV,POV2)"),
        ShownFormula("watch", "v_lon(SV) > 1 m/s"),
        ShownFormula("watch", "("),
    ]
    wrong, right, broken = viewer_data(FILE, LIBRARY, asked)["formulas"]
    assert "mentions POV2" in wrong["error"]
    assert right["holds"] is True
    assert "ends too early" in broken["error"]


def test_margins_are_left_out_where_bounds_are_too_fine() -> None:
    [shown] = viewer_data(FILE, LIBRARY, [ShownFormula("question", "F[0, 0.123 s] v_lon(SV) > 1 m/s")])[
        "formulas"
    ]
    assert shown["step"] == 0
    assert "margins" not in shown["parts"][0]
    assert shown["parts"][0]["true"]


def test_reasons_are_told_in_the_tree_and_in_the_texts_of_the_user() -> None:
    mine = Source(
        "mine", "set mine extends base {\n def danger(a, b: vehicle) := G[0, 1 s] v_lon(a) < 1 m/s\n}\n"
    )
    home = load_library([mine]).select("mine")
    asked = ShownFormula("question", "F danger(SV,POV)", home, explain=(0, Fraction(0)))
    [shown] = viewer_data(FILE, LIBRARY, [asked])["formulas"]
    assert shown["holds"] is False
    because = [shown["parts"][int(k)]["text"] for k in shown["because"]]
    assert because == [
        "F danger(SV, POV)",
        "danger(SV, POV)",
        "G[0, 1 s] v_lon(SV) < 1 m/s",
        "v_lon(SV) < 1 m/s",
    ]
    said = {(x["source"], *x["from"], *x["to"]) for x in shown["said"]}
    assert said == {("formula", 1, 3, 1, 17), ("mine", 2, 41, 2, 57)}
    [refused] = viewer_data(
        FILE, LIBRARY, [ShownFormula("question", "v_lon(SV) > 0", explain=(99, Fraction(0)))]
    )["formulas"]
    assert "part=99" in refused["error"]


def test_parts_of_the_library_are_said_where_the_text_calls_them() -> None:
    query = read_claim(LIBRARY.select(), "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    seen = [x for x in places_of(LIBRARY.select(), query) if x.source == "formula"]
    part = read_claim(LIBRARY.select(), "behaviourSV_4(SV,POV,L)").formula
    assert [x.at.column for x in nearest(seen, part)] == [26]


def test_texts_cannot_leave_the_document_of_a_page() -> None:
    hostile = "</script><img src=x onerror=alert(1)>\u2028<!--"
    text = json_in_html({"formula": hostile})
    assert json.loads(text) == {"formula": hostile}
    assert not re.search("[<>&\u2028\u2029]", text)
    page = viewer_page([viewer_data(FILE, LIBRARY)], hostile)
    assert "<img" not in page
    assert page.count("</script>") == 3


def test_a_page_names_no_other_place() -> None:
    page = viewer_page([viewer_data(FILE, LIBRARY)], "A drive")
    assert "default-src 'none'" in page
    above = page.partition('<script type="importmap">')[0]
    assert not re.search(r"\b(?:src|href)\s*=|url\(\s*['\"]?(?!data:)|@import|https?:", above)


def test_every_import_of_the_viewer_is_a_file_of_the_viewer() -> None:
    modules = viewer_modules()
    for name, text in modules.items():
        if name.startswith("viewer/"):
            assert set(re.findall(r'from "([^"]+)"', text)) <= set(modules)
    assert "--one" in viewer_style()


def test_the_bundles_have_licences_of_the_pinned_packages() -> None:
    """The list is made with the bundles (vendor/build.mjs); what is pinned is in it, in that version."""
    pinned = json.loads((VIEWER / "vendor" / "package.json").read_text("utf-8"))["devDependencies"]
    locked = json.loads((VIEWER / "vendor" / "package-lock.json").read_text("utf-8"))["packages"]
    told = (VIEWER / "vendor" / "LICENSES.txt").read_text("utf-8")
    for name, version in pinned.items():
        assert locked[f"node_modules/{name}"]["version"] == version
        if name != "esbuild":
            assert f"{name} {version} (" in told
    assert all("resolved" not in entry for entry in locked.values())


def test_all_that_the_page_loads_is_at_most_600_kilobytes() -> None:
    studio = VIEWER.parents[1] / "studio" / "page"
    files = [*VIEWER.glob("*"), *VIEWER.glob("vendor/*.js"), VIEWER / "vendor/uPlot.css", *studio.glob("*")]
    total = sum(
        x.stat().st_size for x in files if x.suffix in (".js", ".css", ".html") and "entry" not in x.name
    )
    assert 400_000 < total <= 600_000


def test_samples_of_a_drive_are_shown_with_the_distances_and_margins_of_the_drive() -> None:
    trace = sample_drive(FILE.drive, FILE.road, FILE.horizon, Fraction(1, 10), "samples")
    home = rp.load()
    observed = rp.monitor("danger(SV,POV)", trace, using=home, lanes={}).observed
    recorded = recorded_data(trace, [("question", observed)], home.specification, home.all_values())
    document = viewer_data(FILE, LIBRARY, [ShownFormula("question", "danger(SV,POV)")])
    assert recorded["drive"]["distances"] == document["drive"]["distances"] != []
    margins = [
        {x["text"]: x["margins"] for x in one["formulas"][0]["parts"] if "margins" in x}
        for one in (recorded, document)
    ]
    name = "rssViolation(SV, POV)"
    assert margins[0][name] == margins[1][name]
    assert len(margins[0]["danger(SV,POV)"]) == 61
    assert margins[0]["danger(SV,POV)"][-1] is None  # what comes after the samples decides
    assert recorded["formulas"][0]["step"] == 0.1
