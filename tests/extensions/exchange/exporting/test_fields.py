"""Exported files field by field: every element and attribute, against the files in ``expected``.

Three vehicles: SV is a motorcycle that drifts to the left, POV1 a truck on the merge lane that brakes, POV2
is behind SV and speeds up; POV1 and POV2 follow by name. Two samples a second, from 0 to 2 s.
"""

import csv
import io
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from extensions.exchange.exporting.shipped_drives import TURN, motion, subject
from roadproof.errors import UsageError
from roadproof.extensions.exchange.export.openscenario import polyline_of
from roadproof.extensions.exchange.export.registry import FORMATS
from roadproof.extensions.exchange.export.subject import ExportSubject, subject_of
from roadproof.world.road import Lanelet, Road

EXPECTED = Path(__file__).parent / "expected"
"""Files of the drive below; formulas that share nothing with the exporter gave the same numbers."""


@pytest.fixture(scope="module")
def made() -> ExportSubject:
    drifts = motion((None, "0", "0"), start=("10", "2.6", "30", "1"), size=("2.5", "1.8"))
    brakes = motion((None, "-12", "0"), start=("60", "-0.9", "40", "0"), size=("12.5", "2.4"))
    speeds_up = ("0.5", "12", "0"), (None, "0", "0")
    motions = {
        "SV": replace(drifts, kind="motorcycle"),
        "POV1": brakes,
        "POV2": motion(*speeds_up, start=("-20", "2.9", "20", "0"), size=("4", "1.6")),
    }
    return replace(subject("merge", "2", **motions), number=3, rate=2)


def file_of(made: ExportSubject, format_: str, name: str) -> str:
    return FORMATS[format_](made)[name].decode("utf-8")


def rows_of(text: str) -> list[dict[str, str]]:
    return [*csv.DictReader(io.StringIO(text))]


def rounded(text: str) -> str:
    return re.sub(r"-?\d+\.\d+(e-?\d+)?", lambda x: f"{round(float(x[0]), 8) + 0.0:.12g}", text)


@pytest.mark.parametrize("format_", FORMATS)
def test_each_file_has_every_element_and_column(format_: str, made: ExportSubject) -> None:
    for name, content in FORMATS[format_](made).items():
        assert rounded(content.decode("utf-8")) == rounded((EXPECTED / name).read_text("utf-8")), name


def test_each_expected_file_is_written(made: ExportSubject) -> None:
    written = {name for write in FORMATS.values() for name in write(made)}
    assert written == {path.name for path in EXPECTED.iterdir()}


@pytest.mark.parametrize(
    ("kind", "size", "type_"),
    [
        (None, ("4.5", "1.8"), "car"),
        (None, ("7", "2"), "car"),
        (None, ("7.1", "2"), "truck"),
        (None, ("2.2", "1.2"), "motorcycle"),
        (None, ("2.2", "1.21"), "car"),
        ("car", ("2.2", "1"), "car"),
        ("car", ("9", "2"), "car"),
        ("truck", ("4", "2"), "truck"),
        ("bus", ("4", "2"), "bus"),
        ("motorcycle", ("4", "2"), "motorcycle"),
        ("other", ("4", "2"), "unknown"),
    ],
)
def test_types_follow_kinds_and_sizes(kind: str | None, size: tuple[str, str], type_: str) -> None:
    car = replace(motion((None, "0", "0"), size=size), kind=kind)
    text = file_of(subject(SV=car), "commonroad", "made.xml")
    assert ElementTree.fromstring(text).findtext("dynamicObstacle/type") == type_
    told = {"motorcycle": "motorbike", "unknown": "van"}
    text = file_of(subject(SV=car), "openscenario", "made.xosc")
    found = ElementTree.fromstring(text).find(".//Vehicle")
    assert found is not None
    if (kind, type_) != (None, "motorcycle"):  # sizes alone say that in CommonRoad only
        assert found.get("vehicleCategory") == told.get(type_, type_)
    rows = [*csv.DictReader(io.StringIO(file_of(subject(SV=car), "highd", "01_tracksMeta.csv")))]
    assert rows[0]["class"] == ("Truck" if type_ in ("truck", "bus") else "Car")


@pytest.mark.parametrize("rate", [1, 10, 25, 64, 125, 512, 625, 1000])
def test_rates_whose_steps_are_decimals_are_exported(rate: int) -> None:
    """1/512 s has nine decimals, as many as files have."""
    file = subject(SV=motion((None, "0", "0"))).file
    assert subject_of("made", 1, file, rate).times[-1] == 4
    assert len(subject_of("made", 1, file, rate).times) == 4 * rate + 1


@pytest.mark.parametrize("rate", [0, -25, 3, 30, 1001, 1024, 2000])
def test_other_rates_are_refused(rate: int) -> None:
    with pytest.raises(UsageError, match=f"rate={rate}: write samples a second up to 1000"):
        subject_of("made", 1, subject(SV=motion((None, "0", "0"))).file, rate)


def test_a_bound_that_is_just_kept_needs_no_vertex_between() -> None:
    """Braking by 1 m/s² for a second is within an eighth of a metre, exactly."""
    braking = motion((None, "-1", "0"))
    assert len(polyline_of(braking, Fraction(1), 0.125).vertices) == 2
    assert len(polyline_of(braking, Fraction(1), 0.1249).vertices) == 3


@pytest.mark.parametrize(
    ("other", "plain"),
    [
        (Lanelet("b", "main-2", "main", "main", (None, None), (Fraction(4), Fraction(8))), True),
        (Lanelet("b", "main-2", "main", "main", (None, Fraction(900)), (Fraction(4), Fraction(8))), False),
        (Lanelet("b", "main-2", "main", "main", (Fraction(-900), None), (Fraction(4), Fraction(8))), False),
        (Lanelet("b", "main-2", "merge", "main", (None, None), (Fraction(4), Fraction(8))), False),
        (Lanelet("b", "ramp", "merge", "merge", (None, None), (Fraction(4), Fraction(8))), False),
    ],
)
def test_highd_has_a_road_file_where_markings_do_not_say_all(other: Lanelet, plain: bool) -> None:
    main = Lanelet("a", "main-1", "main", "main", (None, None), (Fraction(0), Fraction(4)))
    road = Road("other", (main, other), frozenset({frozenset({"main-1", other.lane})}))
    names = {*FORMATS["highd"](subject(road, SV=motion((None, "0", "0"))))}
    assert ("01_road.toml" in names) == (not plain)


def test_own_signals_are_columns_of_the_vehicles_that_have_them() -> None:
    """One of SV alone, and one of no vehicle, which is in the rows of all."""
    made = subject("main-2", "1", SV=motion((None, "0", "0")), POV=motion((None, "0", "0")))
    courses = {
        ("gaze", "SV"): ((Fraction(0), Fraction(2)), (Fraction(1), Fraction(3))),
        ("red", ""): ((Fraction(0), Fraction(1)),),
    }
    drive = replace(made.file.drive, custom_signals=courses)
    rows = rows_of(file_of(replace(made, file=replace(made.file, drive=drive), rate=2), "csv", "made.csv"))
    assert [*rows[0]][10:] == ["gaze", "red"]
    assert [(x["time"], x["vehicle"], x["gaze"], x["red"]) for x in rows] == [
        ("0", "SV", "2", "1"),
        ("0", "POV", "", "1"),
        ("0.5", "SV", "2", "1"),
        ("0.5", "POV", "", "1"),
        ("1", "SV", "3", "1"),
        ("1", "POV", "", "1"),
    ]


def test_accelerations_across_grow_to_the_left_and_in_highd_to_the_right() -> None:
    """A change of lane that begins and ends; y of highD grows down."""
    made = subject(SV=TURN)
    states = made.samples["SV"]
    expected = [float(x.a_lat) for x in states]
    assert {x > 0 for x in expected if x} == {True, False}
    ours = [float(x["a_lat"]) for x in rows_of(file_of(made, "csv", "made.csv"))]
    assert ours == pytest.approx(expected)
    for column, signal in (("yAcceleration", "a_lat"), ("yVelocity", "v_lat")):
        theirs = [-float(x[column]) for x in rows_of(file_of(made, "highd", "01_tracks.csv"))]
        assert theirs == pytest.approx([float(getattr(x, signal)) for x in states], abs=1e-8)
