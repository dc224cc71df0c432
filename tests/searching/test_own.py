"""Own signals and kinds in drives and proofs: found, written, read, and refused where they were changed."""

import json
from fractions import Fraction

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.judged import judge_file
from roadproof.library.loading import load_library
from roadproof.library.specification import Source
from roadproof.world.drive import Drive, Motion, Piece, value_at
from roadproof.world.models import load_vehicle

SPEC = """
signal red: bool
signal jerk(a: vehicle): m/s^3 in [-10, 10]
signal free(a: vehicle): m
signal wild(a: vehicle): bool derived by jerk(a) > 9 m/s^3
"""
HOME = rp.load(specs=[SPEC])
LIBRARY = load_library([Source("own.spec", SPEC)])
FORMULA = "kind(SV) = truck and not red and F (red and wild(SV)) and F jerk(SV) < 0 and free(SV) > 2000 m"


@pytest.fixture(scope="module")
def found():
    return rp.witness(FORMULA, using=HOME).drives[0].as_data()


def changed(found, change):
    data = json.loads(json.dumps(found))
    change(data)
    return judge_file(read_drive(data, "drive"), LIBRARY)


def test_a_drive_has_a_course_for_each_signal_and_is_judged_again(found):
    assert {(x["signal"], x["vehicle"]) for x in found["signals"]} == {
        ("red", None),
        ("jerk", "SV"),
        ("free", "SV"),
    }
    assert found["vehicles"]["SV"]["kind"] == "truck"
    assert changed(found, lambda data: None).accepted
    assert read_drive(found, "drive").drive == rp.witness(FORMULA, using=HOME).drives[0].file.drive


def course(data, name):
    return next(x for x in data["signals"] if x["signal"] == name)["values"]


CHANGES = {
    "a value beyond the bounds": (
        lambda data: course(data, "jerk")[-1].update(value="11"),
        "within [-10, 10] m/s^3",
    ),
    "no truth value": (lambda data: course(data, "red")[-1].update(value="1/2"), "false or true"),
    "never red": (lambda data: [x.update(value="0") for x in course(data, "red")], "does not hold"),
    "no course": (lambda data: data.pop("signals"), "the drive says nothing of"),
    "another kind": (lambda data: data["vehicles"]["SV"].update(kind="bus"), "does not hold"),
    "no kind": (lambda data: data["vehicles"]["SV"].pop("kind"), "what kind of vehicle SV is"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_drive_is_rejected(found, name):
    change, told = CHANGES[name]
    ruling = changed(found, change)
    assert not ruling.accepted
    assert told in ruling.reason


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda data: course(data, "red")[0].update({"from": "1"}), "their times must ascend from 0"),
        (lambda data: data["signals"].append(data["signals"][0]), "is given twice"),
        (lambda data: data["signals"][0].update(vehicle="X"), "which the drive does not have"),
        (lambda data: data["vehicles"]["SV"].update(kind="lorry"), "is none of car, truck"),
    ],
)
def test_what_is_no_course_cannot_be_read(found, change, told):
    with pytest.raises(rp.InputError, match=told):
        changed(found, change)


def test_a_no_names_the_ranges_that_were_tried():
    wide = "free(SV) > 5 m and F (free(SV) < -1001 m and red)"
    assert rp.witness(wide, using=HOME, effort=5).drives  # the largest number widens the range
    clash = "kind(SV) = truck and F v_lon(SV) > 30 m/s or jerk(SV) > 10 m/s^3 and red"
    none = rp.witness(clash, using=HOME, effort=5)
    told = "own signals constant between samples, jerk(SV) in [-10, 10] m/s^3, red in false or true"
    assert told in str(none)
    assert none.as_data()["verdicts"][0]["limits"]["signals"]["red"] == "false or true"


def test_a_model_that_does_not_say_its_kind_is_refused_where_that_matters():
    car = load_vehicle("car")
    unknown = type(car)(**{**vars(car), "kind": None})
    with pytest.raises(UsageError, match="the model does not say it"):
        rp.witness("kind(SV) = truck", vehicles=unknown)
    assert rp.witness("v_lon(SV) > 20 m/s", vehicles=unknown).drives


TRUE = (
    "G jerk(SV) <= 10 m/s^3",
    "jerk(SV)^2 <= 100 m/s^3 * 1 m/s^3",
    "kind(SV) = car -> G not kind(SV) = bus",
)
FALSE = ("G jerk(SV) < 10 m/s^3", "red -> G red", "free(SV) <= 100000 m", "kind(SV) = car")


def test_the_bound_is_known_at_every_instant_and_nothing_else_is():
    proved = rp.prove(*TRUE, using=HOME)
    assert {str(x) for x in proved.verdicts.values()} == {"PROVED"}
    assert proved.check().exit_code == 0
    refuted = rp.prove(*FALSE, using=HOME)
    assert {str(x) for x in refuted.verdicts.values()} == {"REFUTED"}
    assert "jerk" in refuted.as_data()["signals"]


def test_a_certificate_is_bound_to_the_declared_bounds(tmp_path):
    folder = rp.prove(TRUE[0], using=HOME).save(tmp_path / "kept")
    (spec,) = folder.glob("*.spec")
    spec.write_text(spec.read_text().replace("[-10, 10]", "[-10, 11]"))
    assert rp.check(folder).exit_code == 10


def test_recast_drives_keep_own_signals():
    still = Motion(*map(Fraction, (4, 2, 0, 3, 20, 0)), (Piece(None, Fraction(0), Fraction(0)),))
    red, jerk = ((Fraction(0), Fraction(1)),), ((Fraction(0), Fraction(2)), (Fraction(1), Fraction(3)))
    drive = Drive({"SV": still, "POV": still}, {("red", ""): red, ("jerk", "POV"): jerk})
    assert drive.cast({"A": "POV", "B": "SV"}).own == {("red", ""): red, ("jerk", "A"): jerk}
    assert [value_at(jerk, Fraction(x, 2)) for x in range(4)] == [2, 2, 3, 3]
