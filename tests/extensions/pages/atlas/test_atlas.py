"""The atlas: its pages agree with the answers, lead to evidence that check accepts, and need no network."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import RejectedError
from roadproof.extensions.pages.atlas.notation import text_as_html
from roadproof.extensions.pages.atlas.pictures import _draw, _PictureJob
from roadproof.extensions.pages.atlas.traffic import frequencies
from roadproof.extensions.pages.miniature import miniature, small_scene
from roadproof.frontends.cli.main import main

AMONG = "1,2,4"  # in conftest.py


class Links(HTMLParser):
    """The links, sources and ids of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.ids: set[str] = set()
        self.tags: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        for name, value in attrs:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            if name == "id" and value is not None:
                self.ids.add(value)


def pages_of(made) -> dict[str, Links]:
    return {name: Links((made.folder / name).read_text("utf-8")) for name in made.pages}


def test_the_pages_are_there(made):
    numbers = [f"scenario-0{n}.html" for n in (1, 2, 4)]
    assert [*made.pages] == ["index.html", "overlaps.html", *numbers]
    assert made.path == made.folder / "index.html"
    assert "5 pages" in str(made)


def test_every_link_leads_to_a_file_or_a_part_of_a_page(made):
    pages = pages_of(made)
    for name, page in pages.items():
        assert page.links
        for link in page.links:
            file, _, part = link.partition("#")
            assert (made.folder / (file or name)).is_file(), f"{name}: {link}"
            assert not part or part in pages[file or name].ids, f"{name}: {link}"


def test_the_pages_need_no_network_and_no_scripts(made):
    for name, page in pages_of(made).items():
        assert "script" not in page.tags, name
        assert not re.search(r"https?://(?!www\.w3\.org)", (made.folder / name).read_text("utf-8")), name
    assert "http" not in (made.folder / "atlas.css").read_text("utf-8")
    assert "@import" not in (made.folder / "atlas.css").read_text("utf-8")


def test_check_accepts_the_evidence(made):
    found = rp.check(made.folder / "evidence", jobs=1)
    assert found.exit_code == 0
    linked = {x for page in pages_of(made).values() for x in page.links if x.startswith("evidence/")}
    checked = {str(Path(x.where).relative_to(made.folder)) for x in found.findings if Path(x.where).is_file()}
    assert {x for x in linked if not x.endswith("index.json")} <= checked


def test_pairs_and_claims_are_as_in_the_answers(made):
    pairs = rp.overlap(AMONG, jobs=1).pairs
    page = (made.folder / "overlaps.html").read_text("utf-8")
    for x in pairs:
        assert f"{x.a.number} and {x.b.number}: {x.verdict}" in page
    text = (made.folder / "scenario-04.html").read_text("utf-8")
    assert '<div id="with-2"><figure' in text  # a drive of both
    assert re.search(r'<li id="with-1">\s*<span class="verdict-word none">· IMPOSSIBLE', text)
    for claim in rp.prove("4", jobs=1).answers:
        assert claim.task.id in text
        assert text_as_html(claim.task.claim) in text


def test_a_scenario_s_page_has_its_words_formula_and_definitions(made):
    text = (made.folder / "scenario-04.html").read_text("utf-8")
    words = rp.load().words(4)
    assert words.title in text
    assert words.sentence in text
    assert 'id="d-disturb_4"' in text
    assert 'href="#d-rssViolation"' in text
    assert "roadproof overlap --among 1,4" in text
    assert "roadproof witness 4 --objective severe" in text


def test_small_pictures_are_small_and_stand_still_at_the_danger(made):
    path = made.folder / "evidence/drives-typical/scenario-04-base.json"
    picture = miniature(small_scene(load_drive(path), rp.load().library), "x", "<a drive>")
    assert len(picture) < 30_000
    assert "&lt;a drive&gt;" in picture
    assert re.search(r"--d:7s;--s:-[1-9]", picture)
    frames = re.findall(r"@keyframes (\w+)", picture)
    assert len(frames) == len({*frames}) == picture.count('style="--a:')


def test_a_drive_that_the_judge_rejects_is_not_drawn(made, tmp_path):
    path = tmp_path / "drive.json"
    content = json.loads((made.folder / "evidence/drives-typical/scenario-04-base.json").read_text())
    path.write_text(json.dumps({**content, "formula": f"not {content['formula']}"}))
    with pytest.raises(RejectedError, match="does not hold on the drive"):
        _draw(rp.load().library, _PictureJob(path, "m0", ""))


def test_formulas_are_in_the_notation_of_the_paper():
    assert text_as_html("G[0, minSafe] not p(a_1)") == (
        "𝓖<sub>[0, <i>minSafe</i>]</sub> ¬ <i>p</i>(<i>a</i><sub>1</sub>)"
    )
    assert text_as_html("rho <= 2 -> q@ext", {"q@ext"}, "d-") == (
        '<i>ρ</i> ≤ 2 ⇒ <a href="#d-q@ext"><i>q</i><sup>ext</sup></a>'
    )
    assert text_as_html("atLane(SV, main-1) < 3") == "<i>atLane</i>(<i>SV</i>, <i>main-1</i>) &lt; 3"


def test_frequencies_are_those_of_the_table():
    found = frequencies(1, "main road")
    assert [(x.set, x.min_danger, x.matches, x.disturbances) for x in found][:3] == [
        ("base", "0", 18, 156),
        ("extA", "0", 18, 156),
        ("ext", "0", 39, 156),
    ]
    assert frequencies(99, "main road") == []


def test_a_topic_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(UsageError, match="topics=drive: write some of proofs, drives, overlaps"):
        rp.atlas(out=tmp_path, topics=("drive",))


def test_the_command_writes_the_pages(tmp_path, capsys, monkeypatch):
    monkeypatch.delenv("ROADPROOF_KNOWN")
    out = tmp_path / "atlas"
    assert main(["atlas", "--out", str(out), "--among", "1,4", "--topics", "overlaps", "--set", "ext"]) == 0
    assert "index.html: 4 pages" in capsys.readouterr().out
    text = (out / "overlaps.html").read_text("utf-8")
    assert "roadproof overlap --among 1,4 --set ext" in text
