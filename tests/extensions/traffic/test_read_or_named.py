"""Every part of the published formats is read, harmless by a listed rule, named as left out, or refused."""

import random
import xml.etree.ElementTree as ElementTree
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from extensions.traffic.planar_exid import SAMPLES
from extensions.traffic.schema_parts import Schema, Way, is_read, schema
from extensions.traffic.test_exid import drawn
from extensions.traffic.tiny_commonroad import document
from extensions.traffic.tiny_osi import number
from roadproof.errors import InputError
from roadproof.extensions.exchange import commonroad, osi
from roadproof.extensions.maps import harmless, lanelet2, opendrive
from roadproof.extensions.maps.opendrive import read_map
from roadproof.extensions.maps.xml_element import parse
from roadproof.extensions.traffic.formats import (
    harmless_columns,
    highd,
    highd_columns,
    levelx,
    ngsim,
    samples,
)
from roadproof.extensions.traffic.formats.content import columns_not_read_note
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.world.not_read import left_out_in

LANE = (
    '<lane id="{}" type="driving" level="false"><link/><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>'
)
ROAD = (
    '<OpenDRIVE><header/><road id="1" length="100" junction="-1"><link/><planView>'
    '<geometry s="0" x="0" y="0" hdg="0" length="100"><line/></geometry></planView><lanes>'
    f'<laneSection s="0"><left>{LANE.format(1)}</left><center><lane id="0" type="none"/></center>'
    f"<right>{LANE.format(-1)}</right></laneSection></lanes></road></OpenDRIVE>"
)
Read = Callable[[Path], Sequence[str]]
"""Reads a file and returns the notes on what was left out."""


def read_traffic(path: Path) -> Sequence[str]:
    return left_out_in(commonroad.read_commonroad(path, strict=False).notes)


def read_road(path: Path) -> Sequence[str]:
    found = read_map(path)
    return (*found.unread, *found.roads[0].unread)


FORMATS: Mapping[str, tuple[str, str, Read, Any, Mapping[str, str]]] = {
    "commonRoad": (document(), "a.xml", read_traffic, commonroad, harmless.COMMONROAD),
    "OpenDRIVE": (
        ROAD,
        "a.xodr",
        read_road,
        opendrive,
        {x: y for x, y in {**harmless.OPENDRIVE, **harmless.OPENDRIVE_FILE}.items() if x != "road"},
    ),
}
KINDS = [(root, kind) for root in FORMATS for kind in sorted(schema(root).types)]


def outcome(
    root_tag: str, way: Way, attribute: str | None, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> str:
    """What becomes of a part of a file: refused, left out (with what is around it), harmless, or read.

    Empty for a part that is passed over without a word.
    """
    text, name, read, module, rules = FORMATS[root_tag]
    known: Schema = schema(root_tag)
    root = ElementTree.fromstring(text)
    node = known.put(root, way, attribute)
    part = node.tag if attribute is None else f"{node.tag}@{attribute}"
    path = folder / name
    path.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
    roots: list[Any] = []
    read_xml = module.read_xml
    with monkeypatch.context() as patch:
        patch.setattr(module, "read_xml", lambda *given: roots.append(read_xml(*given)) or roots[-1])
        try:
            told = " ".join(read(path))
        except InputError:
            return "refused"
    around = {tag for tag, _ in way}
    if any(f"{x}, " in f"{told}, " for x in (part, *around)) or "more kinds" in told or " obstacle" in told:
        return "left out"
    if " vehicles (7)" in told:
        return "left out"
    if {*around, part, f"@{attribute}"} & {*rules}:
        return "harmless"
    found = [x for x in roots[0].iter() if x.tag == node.tag and (attribute is None or attribute in x.attrib)]
    return "read" if all(is_read(roots[0], x, attribute, rules) for x in found) else ""


@pytest.mark.parametrize("root_tag", sorted(FORMATS))
def test_nothing_is_left_out_of_a_plain_file(root_tag: str, tmp_path: Path) -> None:
    text, name, read, _, _ = FORMATS[root_tag]
    path = tmp_path / name
    path.write_text(text, "utf-8")
    assert not read(path)


@pytest.mark.parametrize(("root_tag", "kind"), KINDS)
def test_each_part_of_a_schema_is_read_or_named_or_refused(
    root_tag: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for way, attribute in schema(root_tag).parts(kind):
        assert outcome(root_tag, way, attribute, tmp_path, monkeypatch), (way, attribute)


@pytest.mark.parametrize("root_tag", sorted(FORMATS))
def test_all_outcomes_occur(root_tag: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    parts = [x for kind in schema(root_tag).types for x in schema(root_tag).parts(kind)]
    chosen = random.Random(39).sample(parts, 120)
    counts = Counter(outcome(root_tag, *x, tmp_path, monkeypatch) for x in chosen)
    assert {"read", "left out", "harmless"} <= {*counts}, counts


@pytest.mark.parametrize("root_tag", sorted(FORMATS))
def test_a_reader_that_names_nothing_is_noticed(
    root_tag: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The negative control: without the list of unread parts, some part is passed over without a word."""
    module = FORMATS[root_tag][3]
    monkeypatch.setattr(module, "parts_not_read", lambda *given: ())
    kind = "state" if root_tag == "commonRoad" else "lane"
    assert "" in {outcome(root_tag, *x, tmp_path, monkeypatch) for x in schema(root_tag).parts(kind)}


# --- Lanelet2 ------------------------------------------------------------------------------------

TAGS = {
    "relation": "speed_limit turn_direction location region road_name one_way=yes one_way=no "
    "participant:vehicle=yes participant:vehicle=no participant:pedestrian=yes participant:bicycle=no "
    "dynamic=no dynamic=yes fallback=1 road_surface strange",
    "way": "type subtype width height color temporary lane_change strange",
    "node": "ele type name strange",
}
"""Tags of lanelets, lines and points, with a value where it counts."""
NAMED = {"one_way=no", "participant:vehicle=no", "dynamic=yes", "fallback=1", "strange"}
"""Those that may have an effect and are not read."""


@pytest.mark.parametrize(("tag", "text"), [(tag, x) for tag, texts in TAGS.items() for x in texts.split()])
def test_each_tag_of_lanelet2_is_read_harmless_or_named(tag: str, text: str, tmp_path: Path) -> None:
    root = ElementTree.fromstring(drawn())
    key, _, value = text.partition("=")
    node = next(x for x in root.iter(tag))
    for old in [x for x in node if x.get("k") == key]:
        node.remove(old)
    node.append(ElementTree.Element("tag", k=key, v=value or "1"))
    path = tmp_path / "a.osm"
    path.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
    told = " ".join(lanelet2.read_map(path).unread)
    assert (f"tag[k={key}]" in told) == (text in NAMED), told


@pytest.mark.parametrize("tag", ["node", "way", "relation", "member", "nd", "osm"])
def test_unknown_attributes_and_elements_of_lanelet2_are_named(tag: str, tmp_path: Path) -> None:
    root = ElementTree.fromstring(drawn())
    node = next(x for x in root.iter(tag))
    node.set("strange", "1")
    node.append(ElementTree.Element("stranger"))
    path = tmp_path / "a.osm"
    path.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
    told = " ".join(lanelet2.read_map(path).unread)
    assert f"{tag}@strange" in told
    assert "stranger" in told


# --- tables --------------------------------------------------------------------------------------


def test_each_published_column_is_read_or_harmless() -> None:
    kinds = (highd._RECORDING_KINDS, highd._VEHICLE_KINDS, highd.SAMPLE_KINDS)
    compared = ("frontSightDistance", "backSightDistance")
    columns = (*highd_columns.RECORDING_COLUMNS, *highd_columns.VEHICLE_COLUMNS, *highd.SAMPLE_COLUMNS)
    read = {x for kind in kinds for x in kind} | {*compared}
    assert {*columns} <= read | {*harmless_columns.HIGHD}
    assert not read & {*harmless_columns.HIGHD}


PUBLISHED = {
    "recordingMeta": "recordingId,locationId,frameRate,speedLimit,weekday,startTime,duration,numTracks,"
    "numVehicles,numVRUs,latLocation,lonLocation,xUtmOrigin,yUtmOrigin,orthoPxToMeter",
    "tracksMeta": "recordingId,trackId,initialFrame,finalFrame,numFrames,width,length,class",
    "tracks": SAMPLES,
}
"""Columns of exiD; those of inD, rounD and uniD are some of them."""


@pytest.mark.parametrize("ending", sorted(PUBLISHED))
def test_an_unknown_column_of_exid_is_named_and_refused_where_reading_is_strict(
    ending: str, tmp_path: Path
) -> None:
    for name, columns in PUBLISHED.items():
        (tmp_path / f"07_{name}.csv").write_text(f"{columns}\n", "utf-8")
    assert levelx.ignored_column_notes(tmp_path, "07", strict=True) == ()
    (tmp_path / f"07_{ending}.csv").write_text(f"{PUBLISHED[ending]},mood\n", "utf-8")
    (told,) = levelx.ignored_column_notes(tmp_path, "07", strict=False)
    assert told == f"left out of 07_{ending}.csv, as it is not supported: column mood"
    with pytest.raises(InputError, match="column mood"):
        levelx.ignored_column_notes(tmp_path, "07", strict=True)


def test_columns_of_ngsim_are_read_or_harmless(tmp_path: Path) -> None:
    columns = (
        "Vehicle_ID,Frame_ID,Total_Frames,Global_Time,Local_X,Local_Y,Global_X,Global_Y,v_Length,v_Width,"
        "v_Class,v_Vel,v_Acc,Lane_ID,O_Zone,D_Zone,Int_ID,Section_ID,Direction,Movement,Preceding,Following,"
        "Space_Headway,Time_Headway,Location"
    )
    path = tmp_path / "a.csv"
    for text in (columns, columns.lower()):
        path.write_text(f"{text}\n", "utf-8")
        assert columns_not_read_note(path, *ngsim._names(path), strict=True) == ()
    path.write_text(f"{columns},mood\n", "utf-8")
    with pytest.raises(InputError, match="column mood"):
        columns_not_read_note(path, *ngsim._names(path), strict=True)


def test_a_column_of_jerk_is_named_in_own_tables() -> None:
    columns = dict.fromkeys((*samples.HEADER, "kind", "gear"), np.zeros(1))
    assert samples.ignored_column_notes(ColumnTable(Path("a.csv"), columns, 1), strict=True) == ()
    jerky = ColumnTable(Path("a.csv"), {**columns, "j_lon": np.zeros(1)}, 1)
    (told,) = samples.ignored_column_notes(jerky, strict=False)
    assert told == "left out of a.csv, as it is not supported: column j_lon"
    with pytest.raises(InputError, match="column j_lon"):
        samples.ignored_column_notes(jerky, strict=True)


# --- OSI -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("message", ["GroundTruth", "MovingObject", "BaseMoving"])
@pytest.mark.parametrize("field", range(1, 30))
def test_each_field_of_osi_is_read_harmless_or_named(message: str, field: int) -> None:
    samples = osi._Samples()
    samples.note_unread_fields(message, number(field, 1))
    known = field in osi._READ[message] or field in osi._HARMLESS[message]
    assert bool(samples.unread) != known
    assert all(x.startswith(f"{message}.") for x in samples.unread)


# --- adjacency of CommonRoad ---------------------------------------------------------------------


@pytest.mark.parametrize("dropped", range(3))
def test_adjacency_that_a_file_leaves_out_is_that_of_common_bounds(dropped: int, tmp_path: Path) -> None:
    """Though the file states other adjacencies."""
    stated = commonroad.lanelets_of(Path("a"), parse(document().encode()))
    root = ElementTree.fromstring(document())
    nodes = [(x, y) for x in root.findall("lanelet") for y in x if y.tag.startswith("adjacent")]
    owner, node = nodes[dropped]
    pair = owner.get("id"), node.get("ref")
    owner.remove(node)
    found = commonroad.lanelets_of(Path("a"), parse(ElementTree.tostring(root)))
    assert {frozenset((x.id, y)) for x in found.values() for y in x.beside} == {
        frozenset((x.id, y)) for x in stated.values() for y in x.beside
    }
    assert pair[1] in found[str(pair[0])].by_bound


def test_a_lanelet_that_states_a_neighbour_has_that_of_a_common_bound_too(tmp_path: Path) -> None:
    text = document().replace(
        '<adjacentLeft ref="3" drivingDir="same"/>', '<adjacentRight ref="5" drivingDir="same"/>'
    )
    found = commonroad.lanelets_of(Path("a"), parse(text.encode()))
    assert {*found["1"].beside} == {"3", "5"}
    assert found["1"].by_bound == ("3",)


@pytest.mark.parametrize(
    ("users", "named"),
    [
        ("<userOneWay>vehicle</userOneWay>", ""),
        ("<userOneWay>car</userOneWay><userOneWay>bicycle</userOneWay>", ""),
        ("<userOneWay>bicycle</userOneWay>", "userOneWay"),
        ("<userBidirectional>vehicle</userBidirectional>", "userBidirectional"),
        ("<userBidirectional>pedestrian</userBidirectional>", ""),
    ],
)
def test_users_that_drive_otherwise_than_a_lanelet_goes_are_named(
    users: str, named: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.xml"
    path.write_text(document().replace("<laneletType>", f"{users}<laneletType>", 1), "utf-8")
    told = " ".join(read_traffic(path))
    assert (named in told) if named else not told


def test_an_unknown_element_of_opendrive_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.xodr"
    path.write_text(ROAD.replace("</OpenDRIVE>", "<stranger/></OpenDRIVE>"), "utf-8")
    assert any("stranger" in x for x in read_road(path))
    path.write_text(ROAD.replace("</road>", "<stranger/></road>"), "utf-8")
    assert any("stranger" in x for x in read_road(path))
