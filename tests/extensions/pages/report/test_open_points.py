"""The summary of a page lists all that results leave open, and counts no more than is listed."""

import re
from html import unescape

from hypothesis import given
from hypothesis import strategies as st

from extensions.pages.report.test_page import HEADED, body_of, catalogue_of, concrete, made
from extensions.pages.report.test_summary import written
from roadproof.extensions.pages.page.open_points import catalogue_points, parts_left_out
from roadproof.extensions.pages.page.results import PageResult
from roadproof.extensions.pages.page.summary import overview

IDS = ("A-1", "A-2", "cut/in")
REASONS = ("shows no scenario", "cannot be read: the samples are no motion: SV jumps", "a < b & c")
REMARKS = st.lists(st.tuples(st.sampled_from(IDS), st.sampled_from(REASONS)), max_size=3)
NAMES = st.lists(st.sampled_from(["scenario_1", "class_4", "class_3_6"]), unique=True)


@st.composite
def catalogues(draw) -> dict:
    """Answers about catalogues with random remarks, untested situations, sides and parts left out."""
    targets = draw(NAMES)
    missing = [x for x in targets if draw(st.booleans())]
    remarks = {
        x: [{"tests": [test], "told": told} for test, told in draw(REMARKS)]
        for x in ("faults", "doubts", "contradictions")
    }
    sides = draw(st.lists(st.sampled_from(["preventable", "undecided", "unpreventable"]), max_size=3))
    outcome = {"vehicles": ["SV", "POV"], "at": 0, "gap": None, "instant": None, "speed": None, "start": {}}
    decisions = [
        {**outcome, "test": IDS[k], "scenario": "scenario_4", "driver": "careful", "side": x, "reason": ""}
        for k, x in enumerate(sides)
    ]
    lacking = draw(st.integers(0, 2))
    figure = {"set_name": "ext", "kind": "scenarios", "sector": "", "tested": 8 - lacking, "total": 8}
    gaps = catalogue_of()["gaps"] | {"open": draw(st.sampled_from([{}, {"gap_1": "the search ended"}]))}
    plain = {"words": "", "sector": "", "tested": [], "possible": [], "covered": {}}
    return {"schema": "roadproof/catalogue/1", **HEADED} | catalogue_of(
        tests=[concrete(id=x, file=x, shown=[]) for x in IDS],
        targets=[{"name": x, **plain} for x in targets],
        not_tested=missing,
        figures=[figure],
        decisions=decisions,
        gaps=gaps,
        left_out=draw(st.lists(st.sampled_from(["1 of 3 vehicles: bicycle", "signals of map"]), unique=True)),
        **remarks,
    )


def expected(data: dict) -> list[tuple[str, str]]:
    """The words and texts of open points, read from the answer alone."""
    words = {"faults": "fault", "doubts": "in doubt", "contradictions": "contradiction"}
    points = [("not tested", x) for x in data["not_tested"]]
    points += [
        ("not tested", f"{x['total'] - x['tested']} of {x['total']}")
        for x in data["figures"]
        if x["tested"] != x["total"]
    ]
    points += [(word, x["told"]) for name, word in words.items() for x in data[name]]
    points += [("in doubt", x) for x in data["gaps"]["open"]]
    points += [("undecided", x["test"]) for x in data["decisions"] if x["side"] == "undecided"]
    return points + [("left out", x) for x in data["left_out"]]


@given(catalogues())
def test_each_open_point_is_listed_once(data):
    result = PageResult("x", data["schema"], data)
    points = [*catalogue_points(result), *parts_left_out(result)]
    left = list(points)
    for word, text in expected(data):
        found = next((x for x in left if x[0] == word and text in x[1]), None)
        assert found is not None, (word, text, points)
        left.remove(found)
    assert left == []
    ids = {f"test-0-{k}" for k in range(len(IDS))} | {"result-0"}
    assert {target for _, _, target in points} <= ids
    assert overview(result, "", "", 0, catalogue_points(result)).rank == (1 if points else 2)


def test_the_page_lists_open_points_and_counts_them(tmp_path):
    """Negative control: without open points the page says that there are none."""
    answer = {"schema": "roadproof/catalogue/1", **HEADED} | catalogue_of(
        tests=[concrete(id="A-1", file="a.csv", shown=[], fault="the samples are no motion: SV jumps")],
        faults=[{"tests": ["A-1"], "told": "cannot be read: the samples are no motion: SV jumps"}],
        not_tested=["class_4"],
        left_out=["1 of 3 vehicles: bicycle"],
    )
    seen = unescape(body_of(made(*written(tmp_path, a=answer), out=tmp_path / "a.html")[1]))
    begin = seen.partition("Versions and fingerprints")[0]
    assert "No open points" not in begin
    assert 'Open points <span class="faint">(3)</span>' in begin
    for text in ("class_4", "samples are no motion", "1 of 3 vehicles: bicycle"):
        assert text in begin
    link = re.search(r'href="#(test-0-0)">A-1: cannot be read', begin)
    assert link is not None
    assert f'id="{link[1]}"' in seen
    nothing = answer | {"faults": [], "not_tested": [], "left_out": []}
    whole = body_of(made(*written(tmp_path, b=nothing), out=tmp_path / "b.html")[1])
    assert "No open points" in whole
