"""A mistake of the user leaves a folder of answers as it was."""

from pathlib import Path

import pytest

import roadproof as rp

SPEC = "def fast(a: vehicle) := v_lon(a) > 30 m/s\n"


def contents(folder: Path) -> dict[str, bytes]:
    return {x.name: x.read_bytes() for x in folder.iterdir()}


@pytest.mark.parametrize("before", [None, {}, {"mine.spec": SPEC.encode()}], ids=["new", "empty", "mine"])
def test_a_folder_without_question_has_none_after_a_mistake(
    tmp_path: Path, before: dict[str, bytes] | None
) -> None:
    out = tmp_path / "out"
    if before is not None:
        out.mkdir()
        for name, content in before.items():
            (out / name).write_bytes(content)
    spec = tmp_path / "mine.spec"
    spec.write_text(SPEC)
    with pytest.raises(rp.UsageError, match="the formula mentions"):
        rp.witness("F fast(SV)", using=rp.load(specs=[spec]), vehicles={"POV": "bus"}, out=out, jobs=1)
    assert (contents(out) if out.exists() else None) == before


def test_a_folder_with_answers_keeps_them(tmp_path: Path) -> None:
    rp.witness(4, out=tmp_path, pictures=False, jobs=1)
    before = contents(tmp_path)
    with pytest.raises(rp.UsageError, match="the formula mentions"):
        rp.witness(2, vehicles={"POV": "bus"}, out=tmp_path, pictures=False, jobs=1)
    assert contents(tmp_path) == before
    assert rp.check(tmp_path).accepted
