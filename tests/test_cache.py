"""What is remembered from run to run: never anything but what would be made anew."""

import os
import pickle
from pathlib import Path

import pytest

from roadproof.errors import TextError
from roadproof.library import loading
from roadproof.library.loading import load_library
from roadproof.library.specification import on_request
from roadproof.logic import parse
from roadproof.logic.parse import parse_bundled, parse_library
from roadproof.runtime.cache import SWITCH, cached, private_folder


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "roadproof/made"


def make(made_of: bytes = b"one", result: str = "made") -> tuple[str, int]:
    """What is remembered, and how often it was made for that."""
    calls = []
    found = cached("thing", made_of, lambda: calls.append(1) or result)
    return found, len(calls)


def test_it_is_made_once_for_each_that_it_is_made_of() -> None:
    assert [make(), make(), make(b"two", "other"), make(b"two"), make()] == [
        ("made", 1),
        ("made", 0),
        ("other", 1),
        ("other", 0),
        ("made", 0),
    ]


def test_what_was_changed_is_made_again(home: Path) -> None:
    make()
    [path] = home.iterdir()
    whole = path.read_bytes()
    evil = pickle.dumps("evil")
    for content in (b"", whole[:-1], whole + b"x", whole[:32] + evil, evil, bytes(32) + evil):
        path.write_bytes(content)
        assert make() == ("made", 1)
        assert make() == ("made", 0)
    path.unlink()
    path.symlink_to(home.parent / "elsewhere")
    assert make() == ("made", 1)


def test_nothing_is_kept_where_others_may_write(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make()
    [path] = home.iterdir()
    path.chmod(0o666)
    assert make() == ("made", 1)
    home.chmod(0o777)
    assert private_folder("made") is None
    assert make() == ("made", 1)
    home.chmod(0o700)
    monkeypatch.setenv(SWITCH, "off")
    assert make() == ("made", 1)
    monkeypatch.delenv(SWITCH)
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert make() == ("made", 1)


@pytest.mark.parametrize("umask", [0o002, 0o077])
def test_it_is_kept_whatever_others_may_do_with_new_files(umask: int, home: Path) -> None:
    """Many systems let the group of a user write by default."""
    before = os.umask(umask)
    try:
        assert [make(), make()] == [("made", 1), ("made", 0)]
    finally:
        os.umask(before)
    assert [x.stat().st_mode & 0o777 for x in (home.parent, home)] == [0o700, 0o700]


def test_old_ones_are_forgotten(home: Path) -> None:
    make()
    [path] = home.iterdir()
    os.utime(path, (0, 0))
    make(b"two")
    assert path not in home.iterdir()


def test_trees_are_those_of_their_text(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = 'def slow(a: vehicle) "a is slow" := v_lon(a) < 3 m/s\n'
    first = parse_bundled(text, "mine.spec")
    assert first == parse_library(text, "mine.spec")
    monkeypatch.setattr(parse, "parse_library", lambda *_: pytest.fail("it was remembered"))
    assert parse_bundled(text, "mine.spec") == first
    monkeypatch.undo()
    monkeypatch.setenv("XDG_CACHE_HOME", str(home.parent.parent))
    faster = text.replace("3 m/s", "4 m/s")
    assert parse_bundled(faster, "mine.spec") == parse_library(faster, "mine.spec") != first
    before = {*home.iterdir()}
    monkeypatch.setattr(parse, "version", lambda: "another")
    assert parse_bundled(text, "mine.spec") == first
    assert len({*home.iterdir()} - before) == 1


def test_the_library_is_that_of_its_texts(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(SWITCH, "off")
    anew = loading.bundled_library.__wrapped__()
    monkeypatch.delenv(SWITCH)
    first = loading.bundled_library.__wrapped__()
    monkeypatch.setattr(loading, "build_library", lambda *_, **__: pytest.fail("it was remembered"))
    found = loading.bundled_library.__wrapped__()
    assert found == first == anew
    assert found.fingerprint == anew.fingerprint
    monkeypatch.undo()
    monkeypatch.setenv("XDG_CACHE_HOME", str(home.parent.parent))
    before = {*home.iterdir()}
    monkeypatch.setattr(loading, "version", lambda: "another")
    assert loading.bundled_library.__wrapped__() == anew
    assert [x.name.partition("-")[0] for x in {*home.iterdir()} - before] == ["library"]


def test_the_tree_of_one_call_is_remembered(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read = parse.parse_claim.__wrapped__
    texts = ("scenario_4@ext(SV, POV,L)", "danger(SV,POV)")
    first = [read(text) for text in texts]
    assert first == [parse._parse(text, "claim", "claim") for text in texts]
    assert [x.name.partition("-")[0] for x in home.iterdir()].count("call") == 2
    longer = read("not danger(SV,POV)")
    with pytest.raises(TextError):
        read("given(SV,POV)")
    monkeypatch.setattr(parse, "_parse", lambda *_: pytest.fail("it was remembered"))
    assert [read(text) for text in texts] == first
    assert [x.body.at for x in map(read, texts)] == [x.body.at for x in first]
    monkeypatch.undo()
    monkeypatch.setenv("XDG_CACHE_HOME", str(home.parent.parent))
    assert read("not danger(SV,POV)") == longer
    assert [x.name.partition("-")[0] for x in home.iterdir()].count("call") == 2


def test_files_of_roadproof_are_parsed_once_and_others_are_read_as_they_stand(
    home: Path, tmp_path: Path
) -> None:
    """A copy beside evidence is the shipped text; one that was changed is not."""
    shipped = on_request()["driver"].read_text("utf-8")
    copy, changed = tmp_path / "driver.spec", tmp_path / "changed.spec"
    copy.write_text(shipped, "utf-8")
    changed.write_text(f"{shipped}\ndef mine(a: vehicle) := v_lon(a) < 3 m/s\n", "utf-8")
    loading._library_with.cache_clear()
    first = load_library([copy])
    assert [x.name.partition("-")[0] for x in home.iterdir()].count("tree") >= 1
    kept = {*home.iterdir()}
    assert load_library([copy]) is first
    assert "mine" in load_library([changed]).definitions
    assert "mine" not in first.definitions
    assert {*home.iterdir()} == kept
    copy.write_text(shipped.replace("1 ", "2 ", 1), "utf-8")
    assert load_library([copy]).files[0].text != first.files[0].text
