"""The cache where some permissions are right and some are not, and where it is full."""

import os
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from roadproof.extensions.kernel.coq import one_at_a_time
from roadproof.runtime import cache
from roadproof.runtime.cache import SWITCH, cached, is_private, private_folder

MODES = [0o700, 0o750, 0o755, 0o770, 0o720, 0o702, 0o707, 0o777]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv(SWITCH, raising=False)
    assert private_folder("made") is not None
    return tmp_path / "roadproof/made"


def make(made_of: bytes = b"one") -> int:
    """How often it was made."""
    calls: list[int] = []
    cached("thing", made_of, lambda: calls.append(1))
    return len(calls)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("which", ["folder", "the one above", "file"])
def test_what_others_may_write_is_no_cache(mode: int, which: str, home: Path) -> None:
    assert make() == 1
    [entry] = home.iterdir()
    path = {"folder": home, "the one above": home.parent, "file": entry}[which]
    path.chmod(mode & 0o666 if which == "file" else mode)
    others_write = bool(mode & (stat.S_IWGRP | stat.S_IWOTH))
    assert is_private(path) is not others_write
    if which != "file":
        assert (private_folder("made") is None) is others_write
    assert make() == int(others_write)


def test_what_belongs_to_another_user_is_no_cache(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert make() == 1
    monkeypatch.setattr(os, "getuid", lambda: home.stat().st_uid + 1)
    assert not is_private(home)
    assert make() == 1


def test_a_link_to_a_sound_entry_is_no_entry(home: Path, tmp_path: Path) -> None:
    make()
    [entry] = home.iterdir()
    entry.rename(tmp_path / "elsewhere")
    entry.symlink_to(tmp_path / "elsewhere")
    assert not is_private(entry)
    assert make() == 1


def test_an_entry_under_another_name_is_no_entry(home: Path) -> None:
    make(b"one")
    [one] = home.iterdir()
    make(b"two")
    [two] = {*home.iterdir()} - {one}
    two.write_bytes(one.read_bytes())
    assert make(b"two") == 1


@pytest.mark.parametrize("base", ["relative", "./cache", "../cache"])
def test_a_relative_folder_is_no_cache(base: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", base)
    assert private_folder("made") is None
    assert not (tmp_path / base).exists()


def test_what_was_used_last_stays_where_the_cache_is_full(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make()
    [first] = home.iterdir()
    content, now = first.read_bytes(), time.time()
    first.unlink()
    for k in (2, 0, 3, 1):
        path = home / f"entry-{k}"
        path.write_bytes(content)
        os.utime(path, (now - 100 + k, now - 100 + k))
    monkeypatch.setattr(cache, "MOST_BYTES", 2 * len(content))
    cache.evict_old("made")
    assert {x.name for x in home.iterdir()} == {"entry-2", "entry-3"}
    monkeypatch.setattr(cache, "MOST_BYTES", 2 * len(content) - 1)
    cache.evict_old("made")
    assert {x.name for x in home.iterdir()} == {"entry-3"}
    monkeypatch.setattr(cache, "_OLD", 60.0)
    cache.evict_old("made")
    assert not [*home.iterdir()]


def test_use_makes_an_entry_young_again(home: Path) -> None:
    make()
    [entry] = home.iterdir()
    before = time.time() - 1000
    os.utime(entry, (before, before))
    assert make() == 0
    assert entry.stat().st_mtime > before + 500


@pytest.mark.skipif(sys.platform != "linux", reason="locks of folders are those of Linux")
def test_one_process_at_a_time(home: Path) -> None:
    with one_at_a_time(home):
        lock = f"fcntl.flock(os.open({str(home)!r}, os.O_RDONLY), fcntl.LOCK_SH | fcntl.LOCK_NB)"
        code = f"import fcntl, os; {lock}"
        other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        assert "BlockingIOError" in other.stderr
