"""Links to tests name what these show, links to driver models their margin, as the catalogue has them."""

import re
import shutil
from html import unescape
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.extensions.assurance.answers.trace import LinkState
from roadproof.extensions.assurance.tracing import Traced
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer

DRIVES = Path(__file__).parents[4] / "examples" / "catalogue" / "tests" / "drives"
MODELS = ("careful", "rss")


@pytest.fixture
def traced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Traced, CatalogueAnswer]:
    """Requirements with a link to each test and to each driver model on it, right and wrong."""
    monkeypatch.chdir(tmp_path)
    Path("tests").mkdir()
    for name in ("braking", "cut-in"):
        shutil.copy(DRIVES / f"{name}.json", "tests")
    answer = rp.catalogue("tests", among="1,4", classes=False, drivers=MODELS, out="rep", jobs=1)
    answer.add_files(True)
    text = '[trace]\nevidence = ["rep"]\n'
    for k, (test, model, side) in enumerate(
        (x, y, z) for x in ("braking", "cut-in") for y in MODELS for z in ("preventable", "unpreventable")
    ):
        text += f'[[requirement]]\nid = "R{k}"\ntext = "Yes."\ntests = ["{test}"]\n'
        text += f'drivers = ["{test}: {model} {side}"]\n'
    Path("req.toml").write_text(text, "utf-8")
    return rp.requirements("req.toml", jobs=1), answer


def test_links_say_rows_and_margins(traced: tuple[Traced, CatalogueAnswer], tmp_path: Path) -> None:
    found, answer = traced
    data = answer.as_data()
    shown = {x["id"]: {y["what"] for y in x["shown"]} for x in data["tests"]}
    decided = {(x["test"], x["driver"]): x for x in data["decisions"]}
    for requirement in found.answer.requirements:
        test, driver = requirement.links
        [row] = test.shows
        assert {*row.removeprefix("shows ").split(", ")} == shown[test.target]
        name, model, side = re.fullmatch(r"(.*): (\w+) (\w+)", driver.target).groups()
        decision = decided[name, model]
        assert decision["gap"] is not None, "the example is preventable"
        assert driver.shows == (f"{decision['scenario']}: least gap {decision['gap']:g} m",)
        assert (driver.state is LinkState.WITNESSED) == (decision["side"] == side)


def test_the_page_leads_to_the_row_of_the_test(
    traced: tuple[Traced, CatalogueAnswer], tmp_path: Path
) -> None:
    found, _ = traced
    home = found.save(tmp_path / "trace")
    page = unescape((home / "trace.html").read_text("utf-8"))
    links = {*re.findall(r'href="([^"#]*page\.html)#([^"]+)"', page)}
    assert len(links) == 2
    for path, row in links:
        assert f'<tr id="{row}">' in (home / path).read_text("utf-8")
    assert '<th scope="col">edition</th><th scope="col">clause</th>' in page
    Path("rep/page.html").unlink()
    found.save(tmp_path / "without")
    assert "page.html#" not in Path("without/trace.html").read_text("utf-8")
