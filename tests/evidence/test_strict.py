"""What the reader of evidence refuses, and what is said of a drive that is accepted."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from evidence.folders import answer
from evidence.test_drive_file import FILE, LIBRARY, motion
from roadproof.engines.prove.properties import find_label
from roadproof.errors import InputError
from roadproof.evidence import strict
from roadproof.evidence.checking import Checker
from roadproof.evidence.drive_file import drive_data, read_drive
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.judged import judge_file, times_data
from roadproof.evidence.strict import DEEPEST, Fields, parse_json, rational
from roadproof.evidence.times import read_moment
from roadproof.world.drive import Drive

TEXTS = [
    ('{"a": 1, "a": 2}', "'a' is given twice"),
    ('{"a": {"b": 1, "b": 1}}', "'b' is given twice"),
    ('{"a": NaN}', "NaN is no number"),
    ('{"a": -Infinity}', "-Infinity is no number"),
    ('{"a": 1e999}', "no finite number"),
    (f'{{"a": {"9" * 5000}}}', "a number of 5000 characters"),
    (f'{{"a": 0.{"9" * 5000}}}', "a number of 5002 characters"),
    ('{"a": "x\\u0000"}', r"the character U\+0000"),
    ('{"\\u0000": 1}', r"the character U\+0000"),
    ('{"a": "\\ud800"}', r"the character U\+D800"),
    ("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1), "nested deeper"),
    ("[" * 100_000, "nested deeper"),
    ("{'a': 1}", "no JSON text"),
    ('\ufeff{"a": 1}', "no JSON text"),
    ("", "no JSON text"),
]


@pytest.mark.parametrize(("text", "message"), TEXTS, ids=range(len(TEXTS)))
def test_texts_that_are_refused(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        parse_json(text, "here")


def test_files_that_are_refused(tmp_path) -> None:
    path = tmp_path / "x.json"
    for content, message in ((b"\xff{}", "byte 0 is not UTF-8"), (b" " * 101, "larger than 100 bytes")):
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
        ("named_texts", {"a": True}),
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
