"""Drive files: writing is reading's inverse, and what is damaged is refused with its reason."""

import copy
import json
import random
from dataclasses import replace
from fractions import Fraction

import pytest

from evidence.folders import answer
from roadproof.engines.prove.properties import find_label
from roadproof.errors import InputError
from roadproof.evidence import strict
from roadproof.evidence.checking import Checker
from roadproof.evidence.drive_file import DriveFile, drive_data, load_drive, read_drive
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.judged import judge_file, times_data
from roadproof.evidence.strict import DEEPEST, Fields, parse_json, rational
from roadproof.evidence.times import read_moment
from roadproof.library.bind import default_values
from roadproof.library.loading import bundled_library
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from tables import read_table

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


# --- What the reader of evidence refuses, and what is said of a drive that is accepted --------------

TEXTS = read_table(__file__, "texts")


@pytest.mark.parametrize(("text", "message"), TEXTS, ids=range(len(TEXTS)))
def test_texts_that_are_refused(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        parse_json(text, "here")


def test_files_that_are_refused(tmp_path) -> None:
    path = tmp_path / "x.json"
    told = "not UTF-8 text: byte 0 is 0xff"
    for content, message in ((b"\xff{}", told), (b" " * 101, "larger than 100 bytes")):
        path.write_bytes(content)
        with pytest.raises(InputError, match=message):
            strict.read_json(path, 100)


def test_nesting_up_to_the_limit_is_read() -> None:
    assert parse_json("[" * DEEPEST + "]" * DEEPEST, "here")


@pytest.mark.parametrize(
    ("read", "value"),
    [
        ("text", 1),
        ("text", None),
        ("flag", "true"),
        ("flag", 1),
        ("flag", None),
        ("whole", "1"),
        ("whole", 1.0),
        ("whole", True),
        ("items", {}),
        ("items", "ab"),
        ("mapping", []),
        ("texts", ["a", 1]),
        ("rational", 1),
        ("rational", "1.5"),
        ("rational", "\u0663"),
        ("rational", "1/\u0663"),
        ("rational", "1/0"),
        ("rational", " 1"),
        ("rational", "1\n"),
        ("rational", "9" * 41),
    ],
)
def test_values_of_another_kind_are_refused(read: str, value: object) -> None:
    with pytest.raises(InputError):
        getattr(Fields({"field": value}, "here"), read)("field")


def test_fields_that_nobody_reads_and_fields_that_are_missing_are_named() -> None:
    with pytest.raises(InputError, match="unknown field 'c'"):
        Fields({"a": 1, "c": 2}, "here", ("a", "b"))
    with pytest.raises(InputError, match="'b' is missing"):
        Fields({"a": 1}, "here", ("a", "b")).text("b")
    with pytest.raises(InputError, match="a JSON object is expected"):
        Fields([], "here")


def test_rationals() -> None:
    assert rational("-12/18", "here") == Fraction(-2, 3)


@pytest.mark.parametrize("text", ["", " ", "\u0663", "t\u00e9"])
def test_moments_are_ascii_and_not_empty(text: str) -> None:
    with pytest.raises(InputError):
        read_moment(text)


LANELETS = drive_data(FILE, {})["road"]["lanelets"]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"road": {"lanelets": [LANELETS[0], LANELETS[0]], "adjacent": [], "name": "r"}}, "are called 'm1'"),
        ({"road": {"adjacent": [["main-1", "main-1"]]}}, "no lane is beside itself"),
        ({"road": {"adjacent": [["main-1", "main-9"]]}}, "there is no lane 'main-9'"),
        ({"road": {"adjacent": [["main-1", "main-2"], ["main-2", "main-1"]]}}, "is given twice"),
        ({"overlaps_allowed": "no"}, "write true or false"),
        ({"lane": "main-2", "lanes": {"L": "main-1"}}, "lane=main-2, but lanes.L=main-1"),
        ({"more": 1}, "unknown field 'more'"),
        ({"parameters": {"rho": 1}}, "is no text"),
        ({"vehicles": {f"POV{k}": {} for k in range(21)}}, "21 vehicles, at most 20"),
        ({"road": {"lanelets": [LANELETS[0]] * 1001}}, "1001 lanelets, at most 1000"),
    ],
)
def test_drives_that_are_refused(changed, message) -> None:
    data = drive_data(FILE, {})
    for name, value in changed.items():
        data[name] = {**data[name], **value} if name == "road" else value
    with pytest.raises(InputError, match=message):
        read_drive(data, "test")


# --- what is said of a drive that is accepted ----------------------------------------------------


def line_of(tmp_path, **changed) -> tuple[Acceptance, str]:
    file = replace(FILE, options=dict(LIBRARY.select().options), **changed)
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(drive_data(file, {})), "utf-8")
    finding = Checker(LIBRARY, answer, find_label).check(path)
    return finding.outcome, str(finding)


CRASH = Drive({"SV": motion("0", "30"), "POV": motion("40", "10")})
FASTER = {"formula": "v_lon(SV) > v_lon(POV)", "scenario": None, "drive": CRASH, "lanes": {}}


def test_check_says_what_it_checked_and_what_it_did_not(tmp_path) -> None:
    outcome, line = line_of(tmp_path)
    assert outcome is Acceptance.ACCEPTED
    assert line.startswith("WITNESSED scenario 4 base  scenario_4(SV, POV, L)  [dense, unbounded time")
    assert "declared parameters; boxes apart up to 3 s" in line
    assert line.endswith("not checked: limits of vehicles]")


def test_collisions_that_are_allowed_or_come_later_are_said(tmp_path) -> None:
    assert "overlap from 1.7" in line_of(tmp_path, **FASTER)[1]
    assert line_of(tmp_path, **FASTER)[0] is Acceptance.REJECTED
    outcome, line = line_of(tmp_path, **FASTER, horizon=Fraction(0))
    assert outcome is Acceptance.ACCEPTED
    assert "boxes apart up to 0 s; after that the boxes of POV and SV overlap from 1.7" in line
    outcome, line = line_of(tmp_path, **FASTER, overlaps_allowed=True)
    assert outcome is Acceptance.ACCEPTED
    assert "collisions allowed: the boxes of POV and SV overlap from 1.7" in line


def test_boxes_that_never_meet_are_said_where_there_are_two(tmp_path) -> None:
    away = Drive({"SV": motion("0", "10"), "POV": motion("40", "30")})
    slower = {"formula": "v_lon(SV) < v_lon(POV)", "scenario": None, "drive": away, "lanes": {}}
    assert "boxes apart for ever" in line_of(tmp_path, **slower)[1]
    alone = {**slower, "formula": "v_lon(SV) > 0", "drive": Drive({"SV": motion("0", "10")})}
    outcome, line = line_of(tmp_path, **alone)
    assert outcome is Acceptance.ACCEPTED
    assert "apart" not in line


def test_values_other_than_the_declared_are_said(tmp_path) -> None:
    assert "with rho=1/2" in line_of(tmp_path, values={**FILE.values, "rho": Fraction(1, 2)})[1]


@pytest.mark.parametrize(
    ("verdict", "message"),
    [
        ({"verdict": "IMPOSSIBLE"}, "a drive that holds is WITNESSED"),
        ({"view": "grid"}, "judged in dense time"),
        ({"times": []}, "are not those"),
        ({"sure": True}, "unknown field 'sure'"),
    ],
)
def test_what_a_drive_file_says_of_itself_is_compared(tmp_path, verdict, message) -> None:
    file = replace(FILE, options=dict(LIBRARY.select().options))
    judgement = judge_file(file, LIBRARY).judgement
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(drive_data(file, {"times": times_data(judgement)})), "utf-8")
    checker = Checker(LIBRARY, answer, find_label)
    assert checker.check(path).outcome is Acceptance.ACCEPTED
    path.write_text(json.dumps(drive_data(file, verdict)), "utf-8")
    assert message in checker.check(path).reason


@pytest.mark.parametrize("left_out", ["rho", "lateral_sign"])
def test_what_a_drive_was_judged_with_is_said_by_its_file(tmp_path, left_out) -> None:
    data = drive_data(replace(FILE, options=dict(LIBRARY.select().options)), {})
    del data["parameters"][left_out]
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(data), "utf-8")
    reason = Checker(LIBRARY, answer, find_label).check(path).reason
    assert reason == f"it does not say with which {left_out} it was judged"


def test_a_number_that_is_not_that_of_the_formula_is_rejected(tmp_path) -> None:
    outcome, line = line_of(tmp_path, scenario=5)
    assert outcome is Acceptance.REJECTED
    assert "scenario=5, but its formula is another" in line
