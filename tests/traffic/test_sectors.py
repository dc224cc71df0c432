"""Road sectors: which scenarios are asked of which recording, and what is counted where."""

from collections import Counter
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from roadproof.frontends.report.traffic import results_tables
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.recordings.evaluate.evaluate import Findings, evaluate_recording
from roadproof.recordings.evaluate.questions import Settings, ask, askable, default_settings
from roadproof.recordings.evaluate.recheck import recheck
from roadproof.recordings.evaluate.sectors import ANYWHERE, is_possible, sectors_of
from roadproof.recordings.evaluate.totals import add_findings, begin_totals
from roadproof.recordings.formats.recording import ZONES, Recording
from traffic.test_evaluate import planted_traffic

BASE = bundled_library().select("base")
SETTINGS = replace(default_settings(), scenarios=askable(BASE), sets=("base", "ext"))
MAIN, MERGE, DEPART = (np.uint32(1 << k) for k in range(len(ZONES)))
Found = Counter[tuple[object, ...]]


@pytest.fixture(scope="module")
def recording() -> Recording:
    """Cut-ins, braking, cut-outs and swerves on a main road of one direction."""
    return planted_traffic(2)[0]


def everywhere(recording: Recording, zone: np.uint32) -> Recording:
    return replace(recording, zones=np.full(len(recording.zones), zone, np.uint32))


def findings_of(recording: Recording, settings: Settings = SETTINGS) -> Findings:
    questions = ask(settings, recording.rate, recording.zone_names)
    findings = evaluate_recording(recording, questions)
    assert [*recheck(recording, questions, findings)] == []
    return findings


def matches(findings: Findings, less: int = 0) -> Found:
    """All matches, the scenarios' numbers less so many."""
    return Counter(
        (m.sv, m.pov, m.pov2, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario - less)
        for m in findings.matches
    )


def test_the_three_sectors() -> None:
    found = {x.name: (x.scenarios, x.of_three) for x in sectors_of(BASE, SETTINGS.scenarios)}
    assert found == {
        "main road": ((1, 2, 3, 4, 5, 6, 7, 8), (2,)),
        "merge zone": ((9, 10, 11, 12, 13, 14, 15, 16), (10,)),
        "departure zone": ((17, 18, 19, 20, 21, 22, 23, 24), (18,)),
    }


@pytest.mark.parametrize(
    ("zones", "names"),
    [
        (("main",), ["main road"]),
        (("merge",), ["merge zone"]),
        (("main", "depart"), ["main road", "departure zone"]),
        (ZONES, ["main road", "merge zone", "departure zone"]),
        ((), []),
    ],
)
def test_what_a_road_allows(zones: tuple[str, ...], names: list[str]) -> None:
    assert [x.name for x in sectors_of(BASE, SETTINGS.scenarios) if is_possible(x, zones)] == names


def test_what_is_not_understood_is_asked() -> None:
    text = """
    def roadSector_25(SV, POV: vehicle) "beside a merge zone"
      := not inMergeZone(SV) and G not inDepartZone(POV)
    def disturb_25(SV, POV: vehicle, L: lane) := atLane(SV, L)
    def scenario_25(SV, POV: vehicle, L: lane) := roadSector_25(SV, POV) and disturb_25(SV, POV, L)
    def scenario_26(SV, POV: vehicle, L: lane) := atLane(SV, L) and F danger(SV, POV)
    """
    bundled = bundled_library()
    library = build_library([*bundled.sources.values(), Source("mine.spec", text)])
    chosen = library.select("base")
    beside, free = sectors_of(chosen, (25, 26))
    assert (beside.name, free.name, free.where) == ("beside a merge zone", ANYWHERE, None)
    assert all(is_possible(x, zones) for x in (beside, free) for zones in (("main",), ("merge",), ()))
    assert askable(chosen)[-2:] == (25, 26)


def test_the_same_traffic_in_a_zone_shows_the_scenarios_of_that_zone(recording: Recording) -> None:
    """Behaviour does not ask where it happens, so matches are the same with numbers 8 and 16 higher."""
    on_main = findings_of(everywhere(recording, MAIN))
    assert on_main.sectors == ("main road",)
    assert {number for *_, number in matches(on_main)} >= {1, 2, 4, 8}
    for zone, more, name in ((MERGE, 8, "merge zone"), (DEPART, 16, "departure zone")):
        found = findings_of(everywhere(recording, zone))
        assert found.sectors == (name,)
        assert matches(found, more) == matches(on_main)
        assert {x.sectors for x in found.traces} == {(name,)}
    both = findings_of(everywhere(recording, MERGE | DEPART))
    assert {x.sectors for x in both.traces} == {("merge zone", "departure zone")}
    assert len(both.matches) == 2 * len(on_main.matches)


def test_traces_are_counted_where_they_begin(recording: Recording) -> None:
    """The right half of the road is a merge zone: each trace is in one table, and none is in two."""
    middle = float(np.median(recording.s))
    zones = np.where(recording.s > middle, MERGE, MAIN).astype(np.uint32)
    found = findings_of(replace(recording, zones=zones))
    totals = begin_totals(SETTINGS)
    add_findings(totals, found)
    assert [*totals.shown] == ["main road", "merge zone"]
    main, merge = (rows[0] for rows in totals.shown.values())
    assert main.traces > 0
    assert merge.traces > 0
    assert main.traces + merge.traces == sum(x.min_danger == 0 for x in found.traces)
    for row in (main, merge):
        assert 0 < row.matching <= row.traces
    tables = results_tables(totals)
    assert [*tables] == ["results", "results-merge-zone"]
    assert tables["results-merge-zone"].columns[-1] == "s16"
    assert not any("paper*" in row for row in tables["results-merge-zone"].rows)
    assert any("s17 to s24 were not asked" in note for note in tables["results"].notes)


def test_a_recording_without_the_zone_has_no_table_of_it(recording: Recording) -> None:
    totals = begin_totals(replace(SETTINGS, min_danger=(Fraction(0),)))
    add_findings(
        totals, findings_of(everywhere(recording, MAIN), replace(SETTINGS, min_danger=(Fraction(0),)))
    )
    (table,) = results_tables(totals).values()
    assert table.title == "Disturbance traces that match a scenario"
    assert any("No recording has a merge zone or a departure zone, so s9 to s24" in x for x in table.notes)
