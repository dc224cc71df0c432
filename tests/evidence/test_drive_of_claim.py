"""A drive answers a claim only on the road, in the lanes and with the vehicles that it asks for."""

from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.frontends.api.checking import check
from roadproof.questions.checking import read_folder

OTHERS: dict[str, tuple[dict[str, Any], str]] = {
    "road": ({"road": "main-3"}, "its drive is on road 'main-2', and another one is asked for"),
    "lane": ({"lanes": {"L": "main-2"}}, "L is main-1 on its drive, not main-2"),
    "vehicle": ({"vehicles": "truck"}, "POV has not the kind, length and width of truck"),
}


def _witness(out: Path, **settings: Any) -> Any:
    return rp.witness(4, out=out, pictures=False, jobs=1, **settings)


def _put(source: Path, target: Path) -> Path:
    [name] = [x.name for x in target.glob("scenario-04*.json")]
    (target / name).write_bytes((source / name).read_bytes())
    return target / name


@pytest.mark.parametrize(("settings", "message"), OTHERS.values(), ids=OTHERS)
def test_a_drive_of_another_setting_is_no_answer(
    tmp_path: Path, settings: dict[str, Any], message: str
) -> None:
    usual, other = tmp_path / "usual", tmp_path / "other"
    _witness(usual)
    _witness(other, **settings)
    assert check(other).accepted
    path = _put(usual, other)
    [problem] = read_folder(other).problems
    assert message in str(problem.reason)
    assert not check(other).accepted
    _witness(other, **settings)
    assert check(other).accepted
    assert path.read_bytes() != (usual / path.name).read_bytes()
