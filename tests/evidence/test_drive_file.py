"""Drive files: writing is reading's inverse, and what is damaged is refused with its reason."""

import copy
import json
import random
from dataclasses import replace
from fractions import Fraction

import pytest

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, drive_data, load_drive, read_drive
from roadproof.evidence.judged import judge_file
from roadproof.library.bind import default_values
from roadproof.library.loading import bundled_library
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

LIBRARY = bundled_library()


def motion(s, speed, d="13/5"):
    numbers = [Fraction(x) for x in ("9/2", "9/5", s, d, speed, 0)]
    pieces = (
        Piece(Fraction(3, 5), Fraction(-1), Fraction(0)),
        Piece(None, Fraction(0), Fraction(0)),
    )
    return Motion(*numbers, pieces)


FILE = DriveFile(
    4,
    "base",
    "scenario_4(SV, POV, L)",
    Fraction(3),
    {"L": "main-1"},
    default_values(LIBRARY),
    {"lateral_sign": "rss", "lateral_rss": "paper"},
    load_road("main-2"),
    Drive({"SV": motion("0", "30"), "POV": motion("100", "24")}),
)


def test_this_drive_is_accepted():
    assert judge_file(FILE, LIBRARY).reason == ""


def test_writing_is_readings_inverse(tmp_path):
    data = drive_data(FILE, {"verdict": "WITNESSED"})
    assert read_drive(data, "test") == FILE
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(data), "utf-8")
    assert load_drive(path) == FILE


def test_the_contract_of_the_file():
    data = drive_data(FILE, {})
    assert data["schema"] == "roadproof/drive/1"
    assert data["lane"] == "main-1"
    assert data["parameters"]["rho"] == "3/5"
    assert data["parameters"]["lateral_sign"] == "rss"
    assert data["road"]["lanelets"][0]["s"] == [None, None]
    assert data["road"]["adjacent"] == [["main-1", "main-2"]]
    assert data["vehicles"]["SV"]["pieces"][-1] == {"duration": None, "a_lon": "0", "a_lat": "0"}
    assert data["vehicles"]["SV"]["length"] == "9/2"


def with_jerk(*jerks):
    """The file with pieces of a second with these jerks (m/s³) before those of SV, for which it is still."""
    before = tuple(Piece(Fraction(1), Fraction(0), Fraction(0), Fraction(x)) for x in jerks)
    subject = FILE.drive.vehicles["SV"]
    jerking = replace(subject, pieces=(*before, *subject.pieces))
    return replace(FILE, drive=Drive({**FILE.drive.vehicles, "SV": jerking}))


def test_a_drive_with_jerk_is_of_the_next_version():
    file = with_jerk("1/3", "-1/2")
    data = json.loads(json.dumps(drive_data(file, {"verdict": "WITNESSED"})))
    assert data["schema"] == "roadproof/drive/2"
    assert data["vehicles"]["SV"]["pieces"][1] == {
        "duration": "1",
        "a_lon": "0",
        "a_lat": "0",
        "j_lon": "-1/2",
    }
    assert [piece["j_lon"] for piece in data["vehicles"]["POV"]["pieces"]] == ["0", "0"]
    assert read_drive(data, "test") == file
    assert judge_file(file, LIBRARY).accepted


def test_a_drive_without_jerk_is_of_the_first_version_whatever_it_was_read_from():
    data = json.loads(json.dumps(drive_data(with_jerk(1), {})))
    data["vehicles"]["SV"]["pieces"][0]["j_lon"] = "0"
    assert drive_data(read_drive(data, "test"), {})["schema"] == "roadproof/drive/1"


@pytest.mark.parametrize(
    ("place", "field", "value", "message"),
    [
        (-1, "j_lon", "1", "the last piece has j_lon=1"),
        (0, "j_lon", 1, "no rational as text"),
        (0, "j_lon", "1/0", "divides by zero"),
        (0, "j_lon", None, "no rational as text"),
        (1, "j_lat", "0", "unknown field 'j_lat'"),
    ],
)
def test_damaged_jerks_are_refused(place, field, value, message):
    data = json.loads(json.dumps(drive_data(with_jerk(1), {})))
    data["vehicles"]["SV"]["pieces"][place][field] = value
    with pytest.raises(InputError, match=message):
        read_drive(data, "test")


def changed(path, value):
    data = json.loads(json.dumps(drive_data(FILE, {})))
    place = data
    for key in path[:-1]:
        place = place[key]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return data


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("schema",), "roadproof/drive/3", "schema="),
        (("schema",), "roadproof/drive/2", "'j_lon' is missing"),
        (("vehicles", "SV", "pieces", 0, "j_lon"), "0", "unknown field 'j_lon'"),
        (("horizon",), 6, "no rational as text"),
        (("horizon",), "1/0", "divides by zero"),
        (("horizon",), "-1", "negative"),
        (("formula",), None, "'formula' is missing"),
        (("vehicles",), [], "no object"),
        (("vehicles", "SV", "length"), "0", "length=0"),
        (("vehicles", "SV", "pieces"), [], "last piece"),
        (("vehicles", "SV", "pieces", 0, "duration"), "-1", "duration > 0"),
        (("road", "lanelets", 0, "zone"), "x", "zone="),
        (("road", "lanelets", 0, "d"), ["1", "1"], "empty lanelet"),
        (("road", "adjacent"), [["a"]], "no pair"),
        (("scenario",), "4", "not a whole number"),
    ],
)
def test_damaged_files_are_refused(path, value, message):
    with pytest.raises(InputError, match=message):
        read_drive(changed(path, value), "test")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("formula",), "scenario_1(SV, POV, L)"),
        (("formula",), "scenario_99(SV, POV, L)"),
        (("formula",), "F danger(SV, POV9)"),
        (("set",), "none"),
        (("lane",), "main-2"),
        (("lane",), "main-7"),
        (("lane",), None),
        (("vehicles", "POV"), None),
        (("vehicles", "POV", "s"), "-200000"),
        (("vehicles", "POV", "v_lon"), "31"),
        (("vehicles", "SV", "d"), "6"),
        (("vehicles", "POV", "s"), "4"),
    ],
)
def test_changed_drives_are_rejected(path, value):
    assert not judge_file(read_drive(changed(path, value), "test"), LIBRARY).accepted


def test_overlapping_boxes_are_rejected_unless_allowed():
    drive = Drive({"SV": motion("0", "30"), "POV": motion("4", "30")})
    crash = DriveFile(
        None, "base", "v_lon(SV) >= 1 m/s and v_lon(POV) >= 1 m/s", Fraction(1), {}, {}, {}, FILE.road, drive
    )
    assert "overlap" in judge_file(crash, LIBRARY).reason
    allowed = DriveFile(
        *[getattr(crash, f) for f in crash.__dataclass_fields__ if f != "overlaps_allowed"], True
    )
    assert judge_file(allowed, LIBRARY).accepted


def test_random_damage_never_crashes():
    dice = random.Random(4)
    original = drive_data(FILE, {"verdict": "WITNESSED"})
    junk = [None, True, 0, -1.5, "", "x", "1e9", "9" * 50, [], {}, [None], {"a": 1}]
    refused = 0
    for _ in range(400):
        data = copy.deepcopy(original)
        place = data
        while True:
            key = dice.choice(list(place) if isinstance(place, dict) else range(len(place)))
            inner = place[key]
            if not isinstance(inner, dict | list) or not inner or dice.random() < 0.2:
                break
            place = inner
        place[key] = dice.choice(junk)
        try:
            ruling = judge_file(read_drive(data, "test"), LIBRARY)
            assert ruling.accepted or ruling.reason
        except InputError:
            refused += 1
    assert refused > 100
