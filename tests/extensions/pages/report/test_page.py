"""The page about results: what sections show, that all text stays text, and that a browser opens it alone."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import jinja2
import pytest

import roadproof as rp
from evidence.folders import some_proofs
from roadproof.extensions.pages.page.summary import Overview
from roadproof.extensions.pages.page.templates import page as page_of
from roadproof.extensions.pages.page.templates import render
from roadproof.frontends.cli.main import main
from roadproof.runtime.package_data import shipped_folder

HEADED = {"roadproof": "1.0.0", "library": "0123456789abcdef"}
HOSTILE = "<img src=x onerror=alert(1)>"
CLOSED = "</script><script>alert(1)</script>"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
NO_BROWSER = "there is no chromium here: install it, for instance apt-get install chromium"

_LABELS = ("preventable", "undecided", "not_covered")


@pytest.fixture(scope="module")
def drives(tmp_path_factory) -> Path:
    """One drive, as witness writes it."""
    folder = tmp_path_factory.mktemp("drives")
    rp.witness("danger(SV,POV)", jobs=1, out=folder, pictures=False)
    return folder


def drive_in(folder: Path) -> dict:
    [path] = [x for x in folder.glob("*.json") if x.name != "question.json"]
    return json.loads(path.read_text("utf-8"))


def made(*results: object, out: Path, **more: object):
    found = rp.page(*map(str, results), out=out, jobs=1, **more)
    assert out.read_text("utf-8") == found.text
    return found, found.text


def body_of(text: str) -> str:
    """What is seen: without scripts, styles and the data of viewers."""
    return re.sub(r"<(script|style)\b.*?</\1>", "", text, flags=re.DOTALL)


def test_every_text_is_escaped_wherever_it_is_put():
    page = page_of(HOSTILE, "<p>summary</p>", ["<p>made</p>"], [])
    assert "<h1>&lt;img src=x onerror=alert(1)&gt;</h1>" in page
    assert "<img" not in page
    assert page.count("<script") == page.count("</script") == 2
    assert "<main>\n<p>summary</p>\n<p>made</p>\n</main>" in page
    finding = {"outcome": '"><i>', "label": HOSTILE, "where": HOSTILE, "reason": "a & b"}
    shown = render("evidence.html", **EVIDENCE | {"wrong": [finding]})
    assert "<td>&#34;&gt;&lt;i&gt;</td>" in shown
    assert "<td>a &amp; b</td>" in shown
    assert "<img" not in shown


HEAD = Overview("Evidence", "", "evidence")
EVIDENCE = {"page": None, "checkers": "z3", "count": 1, "head": HEAD, "accepted": [], "wrong": []}


def test_a_value_that_a_template_lacks_is_an_error():
    """A name that is misspelt in a template is found by the first page that is made with it."""
    with pytest.raises(jinja2.UndefinedError, match="'checkers' is undefined"):
        render("evidence.html", **{name: x for name, x in EVIDENCE.items() if name != "checkers"})


def test_only_a_page_imports_the_engine_of_templates():
    code = "import sys, roadproof, roadproof.frontends.cli.main; print('jinja2' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


def test_proofs_and_drives_with_what_was_found_of_them(tmp_path, drives):
    found, text = made(some_proofs(tmp_path / "proofs"), drives, out=tmp_path / "page.html")
    seen = body_of(text)
    assert '5 claims: <span class="count">3 <span class="verdict-word proof">✓ PROVED</span>' in seen
    assert "scenario_4(SV,POV,L) -&gt; dangerArises(SV,POV)" in seen
    assert "6 of 6 accepted by z3 and the exact judge" in seen
    assert '<p class="faint">dense, unbounded time; declared parameters; boxes apart ' in seen
    assert (found.results, found.drives, found.exit_code) == (2, 2, 0)
    assert len(re.findall(r'<script type="application/gzip" id="document-\d+">', text)) == 2
    assert not re.search(r"""(?:src|href|action)\s*=\s*["']?\s*(?:https?:|//)""", text)


def test_plates_are_drawn_with_all_their_models_and_drives(tmp_path):
    at = {"Ve0": "60 km/h", "Vy": [1, 2]}
    rp.preventable("cut-in", ["r157"], at=at, lines=5, lemmas=False, jobs=1, out=tmp_path / "p")
    found, text = made(tmp_path / "p", out=tmp_path / "page.html")
    seen = body_of(text)
    assert seen.count('<svg viewBox="0 0 300 204" class="plate"') == 2
    assert seen.count("<polyline") == 4
    assert "Ve0 = 60 km/h, Vy = 2 m/s" in seen
    assert "dV0: how much faster SV is than POV, Ve0-Vo0 (km/h); Vy: the lateral speed of POV (m/s)" in seen
    assert (found.drives, found.exit_code) == (4, 0)
    row = seen.partition("25/3</td>")[2]  # dV0 = 30 km/h
    assert row.startswith(f"<td>{line_of(tmp_path / 'p')}</td>")


def line_of(folder: Path) -> str:
    """The third line of the first plate, as its file has it."""
    content = json.loads((folder / "r157-Ve0-50_3-Vy-1.json").read_text("utf-8"))
    [[begin, end]] = content["lines"][2]["unpreventable"]
    return f"{begin['near']:g} to {end['near']:g}"


def test_what_does_not_stand_is_said_on_the_page(tmp_path, drives):
    wrong = drive_in(drives) | {"formula": "not danger(SV,POV)"}
    (tmp_path / "wrong.json").write_text(json.dumps(wrong), "utf-8")
    found, text = made(tmp_path / "wrong.json", out=tmp_path / "page.html")
    assert "0 of 1 accepted" in body_of(text)
    assert found.exit_code == 10
    inline = {"schema": "roadproof/witness/1", **HEADED, "verdicts": [outcome("danger(SV,POV)", wrong)]}
    (tmp_path / "inline.json").write_text(json.dumps(inline), "utf-8")
    assert "the formula is false on this drive" in made(tmp_path / "inline.json", out=tmp_path / "b.html")[1]


def outcome(formula: str, drive: dict) -> dict:
    said = {"scenario": 1, "set": "base", "formula": formula, "road": "main-2", "verdict": "WITNESSED"}
    said |= {"view": "dense", "reason": "", "natural": False, "drives": [drive]}
    return said | {"seconds": {}, "sizes": {}}


SAID = {"options": {HOSTILE: CLOSED}, "parameters": {HOSTILE: "1"}, "specs": [HOSTILE]}


def hostile_overlap() -> dict:
    said = {"set": HOSTILE, "lanes": "same", "roles": "any", "start": "same", **SAID}
    said |= {"view": "dense", "seconds": 1}
    pair = {"set_a": HOSTILE, "set_b": CLOSED, "formula": HOSTILE, "reason": CLOSED, "evidence": [HOSTILE]}
    pair |= {"cores": [{"formula": CLOSED, "parts": [HOSTILE]}]}
    verdicts = [
        {"a": 1, "b": 5, "verdict": "UNKNOWN", "core": [HOSTILE], **pair},
        {"a": 1, "b": 4, "verdict": "IMPOSSIBLE", "core": [CLOSED], **pair},
    ]
    return {"schema": "roadproof/overlap/2", **HEADED, **said, "verdicts": verdicts}


def hostile_classes() -> dict:
    one = {"name": "class_4", "vehicles": [HOSTILE, CLOSED], "scenarios": [4], "happens": [4]}
    one |= {"where": HOSTILE, "description": CLOSED, "formula": HOSTILE, "verdict": "WITNESSED"}
    claim = {"name": HOSTILE, "kind": "empty", "claim": CLOSED, "verdict": "UNKNOWN"}
    classes = {"classes": [one | {"reason": HOSTILE, "situations": 1}], "claims": [claim], "text": CLOSED}
    return {"set": HOSTILE, **SAID, "scenarios": [4], "view": "dense", "seconds": 1, **classes}


def hostile_gaps() -> dict:
    one = {"scenario": 1, "component": HOSTILE, "description": CLOSED, "condition": CLOSED}
    one |= {"verdict": "WITNESSED", "gaps": [1], "reason": HOSTILE}
    gap = {"number": 1, "road": HOSTILE, "formula": CLOSED, "first": HOSTILE, "caught_by": [[HOSTILE]]}
    gap |= {"classes": [CLOSED], "drive": CLOSED, "elsewhere": {HOSTILE: None}}
    claim = {"claim": HOSTILE, "verdict": "REFUTED", "certificate": None, "reason": CLOSED}
    empty = one | {"condition": HOSTILE, "verdict": "IMPOSSIBLE", "gaps": [], "claim": CLOSED}
    said = {"set": HOSTILE, "wider": [CLOSED], **SAID, "view": "dense", "seconds": 1, "verdict": "GAPS"}
    return {**said, "claims": [claim], "classes": [one, empty], "gaps": [gap]}


def hostile_monitor() -> dict:
    said = {
        "formula": CLOSED,
        "view": "dense",
        "end": "clip",
        "verdict": "undecided",
        "seconds": 3,
        "dt": "1",
    }
    said |= {
        "under_the_other_end": None,
        "decides": True,
        "robustness": [None, 1],
        "trace": CLOSED,
        "start": HOSTILE,
    }
    said |= {"set": HOSTILE, "road": HOSTILE, "lanes": {HOSTILE: CLOSED}}
    part = {"formula": HOSTILE, "true": [[0, None]], "undecided": [[1, 2]]}
    overruled = {"what": f"option {HOSTILE}", "asked": HOSTILE, "said": CLOSED}
    return {**said, "parts": [part], "overruled": [overruled]}


def hostile_traffic() -> dict:
    settings = {"sets": [HOSTILE], "min_danger": ["0"], "scenarios": [1], "classes": [HOSTILE]}
    settings |= {"convention": "clip", "detectors": [HOSTILE], "options": {HOSTILE: CLOSED}, "parameters": {}}
    counts = ("recordings", "vehicles", "samples", "violating", "asked", "undecided", "differing")
    row = {"sector": HOSTILE, "min_danger": "0", "set": CLOSED, "recall": 0.5, "scenarios": {"1": 3}}
    row |= dict.fromkeys(("traces", "matching", "matching_uncertain", "matching_possible"), 1)
    row["matching_with_three_cars"] = 1
    row["matching_several"] = 1
    row |= {"recall_interval": [0.25, 0.75], "recall_without_init_safe": None, "together": {}}
    row["recall_without_init_safe_interval"] = None
    model = {"min_danger": "3/5", "set": HOSTILE, "scenario": 1, "driver": "rss", "unpreventable": 2}
    return {
        **dict.fromkeys(counts, 1),
        **{"settings": settings, "table": [row], "words": [], "detectors": {HOSTILE: 3}, "repeats": []},
        **{"checks": {"broken": [HOSTILE], "unequal_3_4": []}, "notes": {HOSTILE: [CLOSED]}},
        **{"failed": {HOSTILE: CLOSED}, "drivers": [model | dict.fromkeys(_LABELS, 0)]},
    }


def catalogue_of(**more: object) -> dict:
    """The answer of a catalogue without tests, with ``more`` in it."""
    gaps = {"asked": False, "classes_in_all": 0, "targets": [], "empty": [], "open": {}}
    nothing = ("tests", "targets", "not_tested", "figures", "ranges", "facts", "notes")
    nothing += ("faults", "doubts", "alike", "contradictions")
    return {
        **{"set": "base", "scenarios": [4], **SAID, "view": "dense", "seconds": 1},
        **{name: [] for name in nothing},
        "gaps": gaps | {"claims": [], "classes": []},
        **more,
    }


def concrete(**more: object) -> dict:
    """A test of a catalogue that is a drive, with ``more`` in it."""
    plain = {"title": "", "copy_of": "", "roles": {}, "claims": [], "dense": True, "begins": {}, "fault": ""}
    return plain | more


def a_fact(**more: object) -> dict:
    """A fact of a catalogue, with ``more`` in it."""
    plain = {"premise": "true", "conclusion": None, "formula": "true", "reason": "", "certificate": None}
    return plain | {"drive": None, "also": []} | more


def hostile_catalogue() -> dict:
    shown = {"what": CLOSED, "vehicles": [HOSTILE], "lane": HOSTILE, "at": 0}
    target = {"name": HOSTILE, "words": CLOSED, "sector": HOSTILE, "tested": [HOSTILE], "possible": [CLOSED]}
    spread = {"target": HOSTILE, "term": CLOSED, "tested": [0, 1], "reached": [0, 2], "untested": [[1, 2]]}
    fact = a_fact(test=HOSTILE, other=CLOSED, relation="shows", verdict="WITNESSED", reason=HOSTILE)
    empty = {"scenario": 1, "component": HOSTILE, "description": CLOSED, "condition": CLOSED, "gaps": []}
    said = catalogue_of(set=HOSTILE)
    return said | {
        "targets": [target | {"covered": {HOSTILE: [0, 1]}}],
        "tests": [
            {"id": HOSTILE, "title": CLOSED, "formula": CLOSED, "claims": [HOSTILE]},
            concrete(id=CLOSED, title=HOSTILE, file=HOSTILE, shown=[shown]),
        ],
        "notes": [CLOSED],
        "alike": [{"tests": [HOSTILE], "told": CLOSED}],
        "ranges": [spread | {"share": 0.5, "beyond": [HOSTILE, CLOSED]}],
        "facts": [fact],
        "gaps": said["gaps"] | {"classes": [empty | {"verdict": "IMPOSSIBLE", "claim": HOSTILE}]},
    }


def hostile_answers(drive: dict) -> dict[str, dict]:
    named = drive | {"formula": f"danger(SV,POV) {HOSTILE} {CLOSED}"}
    claim = {"property": HOSTILE, "part": CLOSED, "scenario": None, "set": HOSTILE, "claim": HOSTILE}
    claim |= {"assuming": [CLOSED], "expected": "PROVED", "verdict": "PROVED", "refuted_by": None}
    claim |= {"beyond_limits": None, "view": "dense", "seconds": 1, "reason": HOSTILE, "assumptions": []}
    claim |= {"premises": [CLOSED], "evidence": HOSTILE, "counterexample": None}
    direction = {"claim": HOSTILE, "verdict": "UNKNOWN", "reason": CLOSED, "certificate": None, "drive": None}
    implied = {"from": "1@base", "to": "3@base", "claim": HOSTILE, "certificate": CLOSED}
    change = {"scenario": 1, "where": [CLOSED], "part": HOSTILE, "as": True, "changed": HOSTILE}
    change |= {
        "redundant": None,
        "verdict": "UNKNOWN",
        "assuming": HOSTILE,
        "claim": CLOSED,
        "evidence": None,
    }
    return {
        "overlap": hostile_overlap(),
        "witness": {"verdicts": [outcome(HOSTILE, named) | {"reason": CLOSED, "road": HOSTILE}]},
        "verdicts": {"verdicts": [claim]},
        "compare": {
            **{"first": {"formula": HOSTILE, "set": CLOSED}, "second": {"formula": CLOSED, "set": HOSTILE}},
            "relation": "weaker",
            "forward": direction | {"drive": named},
            "backward": direction,
        },
        "classify": hostile_classes(),
        "coverage": hostile_gaps(),
        "catalogue": hostile_catalogue(),
        "traffic-results": hostile_traffic(),
        "preventable": hostile_plates(named),
        "explore": {**SAID, "view": "dense", "seconds": 1, "explored": [explored(named)]},
        "order": {
            **{"sets": ["base"], **SAID, "view": "dense", "seconds": 1},
            "kinds": [["1@base", "2@base"], ["3@base"]],
            "proved": [implied],
            "edges": [implied],
            "missing": [{"from": "3@base", "to": "1@base", "drives": [1]}],
            "drives": [{"number": 1, "holds": "3@base", "fails": ["1@base"], "drive": named}],
            "doubts": [{"from": "1@base", "to": "2@base", "reason": HOSTILE}],
        },
        "redundancy": {**{"set": HOSTILE, **SAID, "view": "dense", "seconds": 1}, "verdicts": [change]},
        "monitor": hostile_monitor(),
        "other": {"things": [{"formula": HOSTILE, CLOSED: [HOSTILE]}], "note": CLOSED},
    }


def hostile_plates(drive: dict) -> dict:
    ends = [{"near": 1, "exact": HOSTILE}, {"near": 2.5, "exact": CLOSED}]
    lines = [{"at": "0", "unpreventable": []}, {"at": "1/2", "unpreventable": [ends]}]
    shown = {"side": "preventable", "at": {HOSTILE: "1"}, "verdict": "WITNESSED", "formula": HOSTILE}
    shown |= {"scenario": CLOSED, "reason": CLOSED, "drive": drive}
    plate = {"name": HOSTILE, "model": "careful", "fixed": {HOSTILE: "1"}, "verdict": "UNKNOWN"}
    plate |= {"stepped": HOSTILE, "motion": CLOSED, "reason": HOSTILE}
    lemma = {"name": HOSTILE, "title": CLOSED, "claim": HOSTILE, "verdict": "PROVED", "assuming": [CLOSED]}
    lemma |= {"certificate": None, "reason": CLOSED}
    return {
        **{"set": HOSTILE, **SAID, "scenario": None, "view": "dense", "seconds": 1},
        **{"manoeuvre": "cut-in", "along": ["dx0", "0", "3"], "across": ["dV0", "0", "1/2", "2"]},
        "plates": [plate | {"formula": CLOSED, "lines": lines, "shown": [shown]}],
        "lemmas": [lemma],
    }


def explored(drive: dict) -> dict:
    """A map of two parameters, a boundary and an extreme."""
    found = {
        "at": ["0", "1/3"],
        "verdict": "WITNESSED",
        "formula": HOSTILE,
        "reason": CLOSED,
        "evidence": drive,
    }
    none = {**found, "verdict": "IMPOSSIBLE", "at": ["1", "1/3"], "evidence": HOSTILE}
    limits = {
        "best": {**found, "at": ["3"]},
        "missed": None,
        "surely": None,
        "point": ["0", "1"],
        "endless": True,
    }
    return {
        **{"scenario": 1, "set": HOSTILE, "formula": HOSTILE, "searches": 1, "drives": 1},
        "vary": [
            {"name": HOSTILE, "unit": "s", "low": "0", "high": "1"},
            {"name": CLOSED, "unit": "unitless", "low": "0", "high": "1"},
        ],
        "values": [found, none],
        "boundaries": [{"held": found, "missed": none, "surely": {**none, "at": ["2", "1/3"]}}],
        "extremes": [{"sense": "least", "measure": HOSTILE, "when": CLOSED, "unit": HOSTILE, **limits}],
    }


SECOND = ("classify", "compare", "coverage", "explore", "monitor", "order", "overlap", "redundancy")
VERSIONS = {**dict.fromkeys(SECOND, 2), "traffic-results": 5}
"""Of the schemas of answers that are not the first."""


def test_a_hostile_text_stays_text_in_every_section(tmp_path, drives):
    files = []
    for kind, data in hostile_answers(drive_in(drives)).items():
        files.append(tmp_path / f"{kind}.json")
        version = VERSIONS.get(kind, 1)
        files[-1].write_text(json.dumps({"schema": f"roadproof/{kind}/{version}", **HEADED, **data}), "utf-8")
    found, text = made(*files, out=tmp_path / "page.html", title=f"{HOSTILE} {CLOSED}")
    assert found.results == len(files)
    assert "<img" not in text
    assert text.count("<script") == text.count("</script") == 2 + found.drives
    assert body_of(text).count("&lt;img src=x onerror=alert(1)&gt;") > 15
    assert "Which pairs can one drive show?" in text
    led = re.findall(r'href="#([^"]*)"', body_of(text))
    assert {x.partition("-")[0] for x in led} >= {
        "pair",
        "gap",
        "value",
        "best",
        "implied",
        "against",
        "change",
    }
    assert all(text.count(f' id="{x}"') == 1 for x in led)


@pytest.mark.parametrize(
    ("content", "wrong"),
    [
        (None, "does not exist"),
        ("{", "is no JSON"),
        ("[]", ""),
        ('{"schema": "other/1"}', "its schema does not begin with roadproof/"),
        ('{"schema": "roadproof/overlap/2", "verdicts": [{"a": []}]}', "'roadproof' is missing"),
        ('{"schema": "roadproof/classify/2", "classes": 3}', "'roadproof' is missing"),
        ('{"schema": "roadproof/traffic-results/5", "table": 3}', "'roadproof' is missing"),
        ('{"schema": "roadproof/catalogue/1", "tests": 3}', "'roadproof' is missing"),
    ],
)
def test_mistakes_are_named(tmp_path, capsys, content, wrong):
    path = tmp_path / "x.json"
    if content is not None:
        path.write_text(content, "utf-8")
    assert main(["report", str(path), "-o", str(tmp_path / "page.html"), "--quiet"]) == 3
    assert wrong in capsys.readouterr().err
    assert not (tmp_path / "page.html").exists()


def test_the_command_line(tmp_path, capsys, drives):
    assert main(["report", str(drives), "-o", str(tmp_path / "page.txt"), "--quiet"]) == 2
    assert "name a file that ends with .html" in capsys.readouterr().err
    assert main(["report", str(drives), "-o", str(tmp_path / "no/page.html"), "--quiet"]) == 3
    assert main(["report", str(tmp_path), "-o", str(tmp_path / "page.html"), "--quiet"]) == 3
    capsys.readouterr()
    assert main(["report", str(drives), "-o", str(tmp_path / "page.html"), "--quiet"]) == 0
    assert "1 result, 1 drive" in capsys.readouterr().out


def opened(page: Path, more: str = "") -> tuple[str, str]:
    """The document after its scripts have run, and what the browser said on its console."""
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
    options += ["--enable-logging=stderr", "--virtual-time-budget=4000", "--dump-dom"]
    done = subprocess.run(
        [str(CHROMIUM), *options, page.as_uri() + more],
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    return done.stdout, "\n".join(x for x in done.stderr.splitlines() if "CONSOLE" in x)


@pytest.mark.skipif(CHROMIUM is None, reason=NO_BROWSER)
def test_a_browser_opens_it_without_a_word_and_asks_nobody(tmp_path, drives):
    """A policy of the page forbids every request, and the browser complains of each that is tried."""
    overlap = hostile_overlap() | {"set": "base"}
    overlap["verdicts"][0] |= {"verdict": "WITNESSED", "evidence": [drive_in(drives)]}
    (tmp_path / "overlap.json").write_text(json.dumps(overlap), "utf-8")
    _, text = made(tmp_path / "overlap.json", drives, out=tmp_path / "page.html")
    document, said = opened(tmp_path / "page.html", "#pair-0-0")
    assert said == ""
    assert re.search(r'<html[^>]* data-ready="\d+"', document)
    assert 'class="viewer"' in document  # the drive behind the cell that the address names
    assert document.count('class="viewer"') == 1
    assert "<img" not in document
    wrong = text.replace("<main>", '<main><img src="http://127.0.0.1:9/x.png">')
    (tmp_path / "wrong.html").write_text(wrong, "utf-8")
    assert "Content Security Policy" in opened(tmp_path / "wrong.html")[1]


def test_a_cell_of_a_catalogue_leads_to_the_judged_drive_of_its_test(tmp_path):
    """Of one that does not show what is said, the page says so; of one that is not there, where it was."""
    drive = next((Path(__file__).parents[4] / "examples" / "traffic" / "drives").glob("*04-base.json"))

    def test(name: str, what: str, file: object) -> dict:
        shown = [{"what": what, "vehicles": ["SV", "POV"], "lane": "main-1", "at": 0.0}]
        return concrete(id=name, file=str(file), claims=[what], shown=shown)

    def target(number: int, words: str, *tested: str) -> dict:
        plain = {"sector": "", "possible": [], "covered": {}}
        return plain | {"name": f"scenario_{number}", "words": words, "tested": tested}

    answer = {"schema": "roadproof/catalogue/1", **HEADED} | catalogue_of(
        **{"options": {}, "parameters": {}, "specs": []},
        tests=[
            test("right", "scenario_4", drive),
            test("wrong", "scenario_1", drive),
            test("away", "scenario_4", tmp_path / "away.json"),
            {
                "id": "all",
                "title": "",
                "formula": "scenario_4(SV,POV,L)",
                "claims": ["scenario_1", "scenario_5"],
            },
        ],
        targets=[target(1, "one", "wrong"), target(5, "five"), target(4, "four", "right", "away", "all")],
        facts=[a_fact(test="all", other="scenario_1", relation="excludes", verdict="PROVED")],
        alike=[{"tests": ["right", "away"], "told": "the same verdicts and the same start"}],
    )
    (tmp_path / "tests.json").write_text(json.dumps(answer), "utf-8")
    found, text = made(tmp_path / "tests.json", out=tmp_path / "page.html")
    seen = body_of(text)
    right, wrong, away, means = re.findall(r'<details id="test-0-\d">.*?</details>', seen, re.DOTALL)
    assert found.drives == 2
    assert "is false" not in right
    assert "the formula is false on this drive, judged for this page" in wrong
    assert "away.json, which is not there" in away
    assert 'href="#test-0-3" title="all drives of all show scenario_4: that is proved"' in seen
    assert 'title="all claims scenario_1, and does not show it"' in seen
    assert 'title="all claims scenario_5: undecided"' in seen
    assert "<li>right and away: the same verdicts and the same start</li>" in seen
    assert "scenario_4(SV,POV,L)" in means


def test_the_shipped_proofs_are_a_page(tmp_path):
    folder = tmp_path / "some"
    folder.mkdir()
    for name in ("P2-base", "P8-rear-base"):
        shutil.copy(shipped_folder("proofs") / f"{name}.json", folder)
    assert "2 of 2 accepted" in made(folder, out=tmp_path / "page.html")[1]


def test_a_none_within_is_checked_and_its_tree_is_not_listed(tmp_path: Path) -> None:
    out = tmp_path / "out"
    rp.witness("v_lon(SV) > 41 m/s", horizon="1.8 s", out=out, pictures=False, jobs=1)
    page = rp.page(out, out=tmp_path / "page.html", jobs=1)
    assert page.checked is not None
    assert [x.verdict for x in page.checked.findings] == ["NONE-WITHIN"]
    assert "sum node" not in page.text  # it is evidence, and no answer whose fields are listed
