"""Drives that were found under a driver model are monitored with the definitions beside them."""

import shutil
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import RoadproofError


def test_a_restricted_drive_is_monitored_in_its_folder_and_refused_without_it(tmp_path: Path) -> None:
    rp.witness(4, preventable="careful", out=tmp_path / "drives", jobs=1)
    drive = tmp_path / "drives/scenario-04-base.json"
    answer = rp.monitor(4, drive)
    assert answer.verdict == "true"
    assert "cc_perception" in answer.library.options
    shutil.copy(drive, tmp_path / "alone.json")
    with pytest.raises(RoadproofError, match="there is no option 'cc_perception'"):
        rp.monitor(4, tmp_path / "alone.json")
