"""Plates of which one thing was changed: ``check`` says what does not fit."""

import json
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

import roadproof as rp


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("plates")
    at = {"Ve0": ["60 km/h", "90 km/h"], "Vy": 1}
    rp.preventable("cut-in", ["r157"], at=at, lines=3, lemmas=False, jobs=1, out=out)
    return out


def a_place(plate: Any, other: Any) -> None:
    plate["shown"][0]["at"]["dx0"] = "100"


def a_fixed_value(plate: Any, other: Any) -> None:
    plate["fixed"]["Vy"] = "3/2"


def the_drives_of_the_other_plate(plate: Any, other: Any) -> None:
    for mine, theirs in zip(plate["shown"], other["shown"], strict=True):
        mine.update(theirs)


def the_other_side(plate: Any, other: Any) -> None:
    one, two = plate["shown"]
    one["side"], two["side"] = two["side"], one["side"]


def another_model(plate: Any, other: Any) -> None:
    plate["model"] = "careful"
    plate["name"] = plate["name"].replace("r157", "careful")


def a_controller(plate: Any, other: Any) -> None:
    """Lines of a controller are not worked out again: an exact plate may not pass for one."""
    plate["stepped"] = "each place is decided by a drive"


def no_side(plate: Any, other: Any) -> None:
    del plate["shown"][0]


def a_place_off_the_plate(plate: Any, other: Any) -> None:
    plate["shown"][0]["at"]["dV0"] = "1"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (a_place, "its formula is not|but the plate says"),
        (a_fixed_value, "its name is"),
        (the_drives_of_the_other_plate, "are not those of the plate"),
        (the_other_side, "but its formula is not"),
        (another_model, "but that of its model is"),
        (a_controller, "'stepped' does not go with"),
        (no_side, "but has to show"),
        (a_place_off_the_plate, "is not on the plate"),
    ],
)
def test_a_changed_plate_is_rejected(
    change: Callable[[Any, Any], None], told: str, folder: Path, tmp_path: Path
) -> None:
    out = tmp_path / "forged"
    copytree(folder, out)
    index = json.loads((out / "index.json").read_text("utf-8"))
    change(*index["plates"])
    (out / "index.json").write_text(json.dumps(index), "utf-8")
    checked = rp.check(out)
    assert checked.exit_code == 10
    assert any(x in str(checked) for x in told.split("|"))


def test_the_folder_is_accepted(folder: Path) -> None:
    assert rp.check(folder).exit_code == 0
