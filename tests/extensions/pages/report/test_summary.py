"""The head of a page: what was asked with which answer, what is open, and in which order sections follow."""

import json
import re
from pathlib import Path

import pytest

import roadproof as rp
from evidence.folders import some_proofs
from extensions.pages.report.test_page import HEADED, body_of, drive_in, hostile_overlap, made
from roadproof.engines.prove.properties import template_properties
from roadproof.extensions.pages.page.results import PageResult
from roadproof.extensions.pages.page.summary import overview


def claims_of(*names: str, **verdicts: str) -> dict:
    """Answers about template properties, without evidence; ``verdicts`` other than expected, by property."""
    plain = {"assuming": [], "beyond_limits": None, "view": "dense", "seconds": 1, "reason": ""}
    plain |= {"refuted_by": None, "assumptions": [], "premises": [], "evidence": None, "counterexample": None}
    claims = [
        {
            **{"property": x.id, "part": x.part, "scenario": x.scenario, "set": x.set_name, **plain},
            **{"claim": x.claim, "expected": x.expected, "verdict": verdicts.get(x.id, x.expected)},
        }
        for x in template_properties()
        if x.id in names
    ]
    return {"schema": "roadproof/verdicts/1", **HEADED, "verdicts": claims}


def written(folder: Path, **answers: dict) -> list[Path]:
    for name, data in answers.items():
        (folder / f"{name}.json").write_text(json.dumps(data), "utf-8")
    return [folder / f"{name}.json" for name in answers]


def test_claims_about_scenarios_are_a_grid_that_leads_to_each_claim(tmp_path):
    _, text = made(*written(tmp_path, claims=claims_of("P1", "P2")), out=tmp_path / "page.html")
    seen = body_of(text)
    [grid] = re.findall(r'<table class="matrix">.*?</table>', seen, re.DOTALL)
    assert grid.count("<tr>") == 2 + 24
    assert '<th scope="colgroup" colspan="3">P1</th>' in grid
    assert "cut-in, lane keep, main road" in grid
    led = re.findall(
        r'<td class="proof"><a href="#([^"]+)" title="P1 \d+ in (?:base|extA|ext): PROVED"', grid
    )
    assert len(set(led)) == 24 * 3
    assert all(seen.count(f' id="{x}"') == 1 for x in led)
    assert "every scenario leads from safety to danger" in seen
    assert "<details>\n<summary><b>All claims</b>" in seen  # folded, since there are more than 30


def test_what_is_refuted_or_open_is_said_first_and_leads_to_its_place(tmp_path):
    answers = {"fine": claims_of("P2"), "overlap": hostile_overlap() | {"set": "base"}}
    found, text = made(*written(tmp_path, **answers), out=tmp_path / "page.html")
    seen = body_of(text)
    assert "Open points" in seen
    assert '<a href="#pair-1-0">scenarios 1 and 5' in seen
    assert "No open points" not in seen
    assert seen.index('id="summary"') < seen.index('id="result-1"') < seen.index('id="result-0"')
    assert found.results == 2


def test_controls_are_refuted_as_expected_and_a_refuted_property_is_not(tmp_path):
    expected = body_of(made(*written(tmp_path, a=claims_of("P2", "C3")), out=tmp_path / "a.html")[1])
    assert "1 claim refuted, as expected" in expected
    assert "No open points" in expected
    wrong = claims_of("P2", "C3", P2="REFUTED")
    surprising = body_of(made(*written(tmp_path, b=wrong), out=tmp_path / "b.html")[1])
    assert "<h3>Refuted <" in surprising
    assert "No open points" not in surprising


def test_rejected_evidence_comes_before_everything_else(tmp_path):
    rp.witness("danger(SV,POV)", jobs=1, out=tmp_path / "drives", pictures=False)
    wrong = drive_in(tmp_path / "drives") | {"formula": "not danger(SV,POV)"}
    (tmp_path / "wrong.json").write_text(json.dumps(wrong), "utf-8")
    seen = body_of(made(tmp_path / "wrong.json", out=tmp_path / "page.html")[1])
    assert "Evidence that is not accepted" in seen.partition('id="evidence"')[0]
    assert "No open points" not in seen


def test_versions_definitions_and_digests_are_told(tmp_path):
    _, text = made(*written(tmp_path, claims=claims_of("P2")), out=tmp_path / "page.html")
    seen = body_of(text)
    assert "<dt>definitions</dt><dd>0123456789abcdef</dd>" in seen
    assert re.search(r"<dt>SHA-256 of claims</dt><dd><code>[0-9a-f]{64}</code></dd>", seen)


@pytest.mark.parametrize(
    ("kind", "data", "verdicts", "subject"),
    [
        ("redundancy", {"set": "ext", "verdicts": [{"verdict": "UNKNOWN", "scenario": 3}]}, ["UNKNOWN"], "3"),
        (
            "compare",
            {"forward": {"verdict": "PROVED"}, "backward": {"verdict": "REFUTED"}},
            ["PROVED", "REFUTED"],
            "",
        ),
        ("explore", {"explored": [{"scenario": 2, "values": [{"verdict": "WITNESSED"}]}]}, ["WITNESSED"], ""),
        ("order", {"proved": [{"from": "1@base", "to": "2@base"}], "doubts": []}, ["PROVED"], ""),
        ("monitor", {"verdict": "undecided", "set": "base"}, ["undecided"], "set base"),
    ],
)
def test_verdicts_are_found_in_results_of_each_kind(kind, data, verdicts, subject):
    found = overview(PageResult("x", f"roadproof/{kind}/1", data), "", "")
    assert found.verdicts == verdicts
    assert subject in found.subject
    assert found.rank == (1 if {"UNKNOWN", "undecided"} & {*verdicts} else 2)


def test_drives_are_a_gallery_of_moving_pictures(tmp_path):
    rp.witness("danger(SV,POV)", jobs=1, out=tmp_path / "drives", pictures=False)
    found, text = made(tmp_path / "drives", out=tmp_path / "page.html")
    seen = body_of(text)
    assert found.drives == 1
    [card] = re.findall(
        r'<article class="place card" id="sought-0-0" data-document="0">.*?</article>', seen, re.DOTALL
    )
    assert '<button type="button" class="open" aria-expanded="false"><svg' in card
    assert "@keyframes m0" in text
    assert "■ WITNESSED" in card


def test_an_open_part_leads_to_its_place_though_needed_parts_are_shown_last():
    entries = [{"verdict": "REFUTED", "redundant": False}, {"verdict": "UNKNOWN", "redundant": None}]
    found = overview(PageResult("x", "roadproof/redundancy/1", {"verdicts": entries}), "", "")
    assert [(x.verdict, x.target) for x in found.statements] == [
        ("UNKNOWN", "change-0-0"),
        ("REFUTED", "change-0-1"),
    ]


def test_a_section_with_a_rejected_certificate_comes_first(tmp_path):
    folder = some_proofs(tmp_path / "proofs")
    path = folder / "P2-base.json"
    path.write_text(path.read_text("utf-8").replace("danger(POV,SV)", "danger(SV,SV)"), "utf-8")
    open_pairs = hostile_overlap() | {"set": "base"}
    found, text = made(*written(tmp_path, overlap=open_pairs), folder, out=tmp_path / "page.html")
    seen = body_of(text)
    assert found.exit_code != 0
    assert seen.index('<section id="result-1">') < seen.index('<section id="result-0">')
    assert "evidence rejected" in seen.partition("</table>")[0]
