"""Folders of answers of which a part is this question's: what is taken up, what is refused, what is left."""

import errno
import json
import os
import stat
import subprocess
import sys
import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from api.both_interfaces import FALSE, SYMMETRIC
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import undecided
from roadproof.evidence.claim import Exists
from roadproof.evidence.specifications import specification_names
from roadproof.frontends.api.proofs import claims_question
from roadproof.questions.checking import read_folder
from roadproof.questions.question import QUESTION as QUESTION_FILE
from roadproof.questions.store import Store
from roadproof.reasons import ReasonKind
from roadproof.runtime import files
from roadproof.runtime.budget import Effort
from roadproof.runtime.files import atomic_file, lock_folder, read_limited, utf8, write_atomic

FAST = "v_lon(SV) > 30 m/s -> v_lon(SV) > 20 m/s"
NEAR = "v_lon(SV) > 40 m/s -> v_lon(SV) > 20 m/s"


# --- files -----------------------------------------------------------------------------------------


def test_a_file_is_whole_readable_and_alone(tmp_path: Path) -> None:
    path = tmp_path / "answer.json"
    with atomic_file(path) as file:
        file.write(b"half")
        assert not path.exists()
        assert [x.name[0] for x in tmp_path.iterdir()] == ["."], "what is not whole is hidden"
    assert path.read_bytes() == b"half"
    assert stat.S_IMODE(path.stat().st_mode) == 0o644
    assert [*tmp_path.iterdir()] == [path]


def fail_to_write(path: Path) -> None:
    with atomic_file(path) as file:
        file.write(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")


def test_a_failure_leaves_what_was_there_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "answer.json"
    path.write_text("before")
    with pytest.raises(InputError, match=f"cannot write {path}: no space left on device; make room"):
        fail_to_write(path)
    assert path.read_text() == "before"
    assert [*tmp_path.iterdir()] == [path]


def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "real.json").write_text("before")
    link = tmp_path / "link.json"
    link.symlink_to("real.json")
    write_atomic(link, b"after")
    assert link.is_symlink()
    assert (tmp_path / "real.json").read_bytes() == b"after"


@pytest.mark.parametrize("size", [0, 9, 10, 11, 12])
def test_a_file_of_the_largest_size_is_read_and_one_byte_more_is_not(size: int, tmp_path: Path) -> None:
    path = tmp_path / "evidence"
    path.write_bytes(b"x" * size)
    if size <= 10:
        assert read_limited(path, 10, "divide it") == b"x" * size
        return
    with pytest.raises(InputError, match="larger than 10 bytes: divide it"):
        read_limited(path, 10, "divide it")


def test_names_that_are_no_text_can_be_read_again() -> None:
    name = os.fsdecode(b"drive-\xff.json")
    assert json.loads(utf8(json.dumps(name, ensure_ascii=False))) == name


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize("shared", [False, True])
def test_a_run_that_lives_keeps_others_out_at_once(shared: bool, tmp_path: Path) -> None:
    code = (
        "import sys\nfrom pathlib import Path\nfrom roadproof.runtime.files import lock_folder\n"
        f"with lock_folder(Path({str(tmp_path)!r}), {shared}):\n    print('held', flush=True)\n"
        "    sys.stdin.readline()\n"
    )
    pipe = subprocess.PIPE
    other = subprocess.Popen([sys.executable, "-c", code], stdin=pipe, stdout=pipe, text=True)
    assert other.stdout is not None
    assert other.stdout.readline() == "held\n"
    begun = time.monotonic()
    try:
        for mine in (False, True):
            if mine and shared:
                with lock_folder(tmp_path, shared=True):
                    pass
                continue
            with pytest.raises(InputError, match="another run is writing"), lock_folder(tmp_path, mine):
                pass
        assert time.monotonic() - begun < files.RELEASE_SECONDS
    finally:
        other.communicate("\n", timeout=60)
    with lock_folder(tmp_path):
        pass


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize(
    ("state", "flags", "pending", "lives"),
    [
        ("S", 0x400000, 0, True),
        ("R", 0x400100, 0x4000, True),
        ("D", 0x400000, 0, True),
        ("Z", 0x400000, 0, False),
        ("X", 0x400000, 0, False),
        ("S", 0x400004, 0, False),
        ("S", 0x400000, 0x100, False),
        ("S", 0x400000, 0x4100, False),
    ],
)
def test_who_is_about_to_end_holds_no_folder(
    state: str, flags: int, pending: int, lives: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of several holders one that lives is enough."""
    monkeypatch.setattr(files, "_PROC", tmp_path)
    for pid, (letter, bits, signals) in {"7": (state, flags, pending), "8": ("Z", 0, 0)}.items():
        (tmp_path / pid).mkdir()
        (tmp_path / pid / "stat").write_text(f"{pid} (a) b) {letter} 1 1 1 0 -1 {bits} 0 0")
        (tmp_path / pid / "status").write_text(f"Name:\ta\nSigPnd:\t{0:016x}\nShdPnd:\t{signals:016x}\n")
    handle = os.open(tmp_path, os.O_RDONLY)
    inode = os.fstat(handle).st_ino
    rows = [f"{k}: FLOCK  ADVISORY  WRITE {pid} 08:01:{inode} 0 EOF" for k, pid in enumerate("879")]
    (tmp_path / "locks").write_text("\n".join(rows) + "\n")
    try:
        assert files._is_alive("7") is lives
        assert files._holder_lives(handle) is lives
    finally:
        os.close(handle)


def test_two_specification_files_of_one_name_are_refused(tmp_path: Path) -> None:
    paths = [tmp_path / name / "mine.spec" for name in ("a", "b")]
    for k, path in enumerate(paths):
        path.parent.mkdir()
        path.write_text(f"def mine_{k}(a: vehicle) := v_lon(a) > {k} m/s\n")
    home = rp.load(specs=paths)
    with pytest.raises(UsageError, match="two files of --spec have the same name"):
        specification_names(home.library)


# --- claims: one proved beside one that is not -------------------------------------------------------


def claims(folder: Path, *what: str, **more: Any) -> dict[str, str]:
    found = rp.prove(*what, out=folder, jobs=1, drive=False, **more)
    return {x.task.claim: str(x.verdict) for x in found.answers}


def index_of(folder: Path) -> dict[str, str]:
    """The verdicts of a folder by claim, as it is read again."""
    return {x.claim.query.text: str(x.verdict) for x in read_folder(folder).answers.values()}


def test_a_folder_grows_and_new_answers_count(tmp_path: Path) -> None:
    assert claims(tmp_path, FAST, FALSE) == {FAST: "PROVED", FALSE: "REFUTED"}
    assert claims(tmp_path, SYMMETRIC) == {SYMMETRIC: "PROVED"}
    assert index_of(tmp_path) == {FAST: "PROVED", FALSE: "REFUTED", SYMMETRIC: "PROVED"}
    files = {x.name for x in tmp_path.glob("*.json")}
    again = claims(tmp_path, FALSE, NEAR)
    assert again == {FALSE: "REFUTED", NEAR: "PROVED"}
    assert files <= {x.name for x in tmp_path.glob("*.json")}
    assert rp.check(tmp_path).accepted


def test_a_claim_in_doubt_beside_one_that_is_proved(tmp_path: Path) -> None:
    doubtful = "F[0, 3 s] danger(SV,POV) -> F[0, 2 s] (danger(SV,POV) and fasterThan(SV,POV))"
    claims(tmp_path, FAST)
    for what in ((doubtful, FAST), (FAST, doubtful)):
        found = rp.prove(*what, out=tmp_path, jobs=1, effort=0.001, drive=False)
        assert [found.verdicts[x.task.name] for x in found.answers] == [
            "UNKNOWN" if x is doubtful else "PROVED" for x in what
        ]
        assert found.exit_code == 20
    assert index_of(tmp_path) == {FAST: "PROVED", doubtful: "UNKNOWN"}


@pytest.mark.parametrize(
    "other",
    [
        lambda: {"using": rp.load(options={"lateral_sign": "literal"})},
        lambda: {"using": rp.load(specs=["def mine(a: vehicle) := v_lon(a) > 3 m/s\n"])},
    ],
    ids=["another reading", "another file"],
)
def test_claims_read_otherwise_go_into_another_folder(other: Any, tmp_path: Path) -> None:
    claims(tmp_path, FAST)
    before = index_of(tmp_path)
    with pytest.raises(UsageError, match="name another folder"):
        claims(tmp_path, NEAR, **other())
    assert index_of(tmp_path) == before


def test_a_folder_of_another_command_is_refused(tmp_path: Path) -> None:
    rp.overlap("5,6", out=tmp_path, jobs=1)
    before = (tmp_path / QUESTION_FILE).read_bytes()
    with pytest.raises(UsageError, match="holds the answers to another question"):
        claims(tmp_path, NEAR)
    assert (tmp_path / QUESTION_FILE).read_bytes() == before


@pytest.mark.parametrize(
    ("field", "value"),
    [("options", {"lateral_sign": "literal"}), ("specs", ["mine.spec"]), ("sets", ["ext"])],
)
def test_a_question_that_was_read_otherwise_does_not_grow(field: str, value: Any, tmp_path: Path) -> None:
    claims(tmp_path, FAST)
    (tmp_path / "mine.spec").write_text("def mine(a: vehicle) := v_lon(a) > 3 m/s\n")
    content = json.loads((tmp_path / QUESTION_FILE).read_text("utf-8"))
    content["basis"][field] = value
    (tmp_path / QUESTION_FILE).write_text(json.dumps(content), "utf-8")
    with pytest.raises(UsageError, match="holds the answers to another question"):
        claims(tmp_path, SYMMETRIC)


def test_what_is_assumed_is_assumed_in_every_answer(tmp_path: Path) -> None:
    overtaking = "s(SV) < s(POV) and not F s(SV) = s(POV) -> G s(SV) < s(POV)"
    dense = rp.prove(overtaking, drive=False, jobs=1, out=tmp_path)
    moving = rp.prove(overtaking, assume="motion", drive=False, jobs=1, out=tmp_path)
    assert (dense.verdict, moving.verdict) == ("REFUTED", "PROVED")
    again = rp.prove(overtaking, drive=False, jobs=1, out=tmp_path)
    assert again.verdict == "REFUTED"


def test_a_key_changes_with_all_that_is_asked() -> None:
    def key(claim: str, **more: Any) -> str:
        asked = replace(claims_question(rp.load(), [claim], None), **more)
        [found] = asked.claims.values()
        return Store(None, asked.kind, asked.work).key(found)

    usual = key(FAST)
    assert usual == key(f"  {FAST}  ")
    task = claims_question(rp.load(), [FAST], None).tasks[0]
    basis = claims_question(rp.load(), [FAST], None).basis
    others = [
        key(NEAR),
        key(FAST, basis=replace(basis, effort=Effort(3.0))),
        key(FAST, seek_drive=False),
        key(FAST, tasks=(replace(task, task=replace(task.task, assuming=("motion",))),)),
        key(FAST, tasks=(replace(task, within=Exists()),)),
        key(FAST, tasks=(replace(task, within=Exists(horizon=Fraction(3))),)),
    ]
    assert len({usual, *others}) == 1 + len(others)


def test_a_key_is_that_of_one_version_of_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = claims_question(rp.load(), [FAST], None)
    [claim] = asked.claims.values()
    store = Store(None, asked.kind, asked.work)
    key = store.key(claim)
    monkeypatch.setattr("roadproof.questions.store.ANSWERS", "9.9.9")
    assert store.key(claim) != key


@pytest.mark.parametrize("gone", ["the folder", "its question"])
def test_an_answer_is_not_written_where_the_folder_is_gone(gone: str, tmp_path: Path) -> None:
    asked = claims_question(rp.load(), [FAST], None)
    [(name, claim)] = asked.claims.items()
    folder = tmp_path / "answers"
    if gone == "its question":
        folder.mkdir()
    with pytest.raises(InputError, match="was removed during the run"):
        Store(folder, asked.kind, asked.work).keep(name, undecided(claim, ReasonKind.NO_DRIVE()))
    assert not [*tmp_path.rglob("*.json")]


def test_an_answer_to_another_claim_is_not_taken_for_this_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Names are digests of claims, and two may be the same."""
    monkeypatch.setattr("roadproof.engines.prove.properties.name_of_claim", lambda *_: "claim-one")
    assert claims(tmp_path, FAST) == {FAST: "PROVED"}
    assert claims(tmp_path, FALSE) == {FALSE: "REFUTED"}


def test_each_claim_of_the_list_is_read_in_its_set() -> None:
    asked = claims_question(rp.load(), ["P1", "P2", "P3", "P4", "P5", "P6"], None)
    sets = {x.task.set_name for x in asked.tasks}
    assert len(sets) > 1
    for task in (x.task for x in asked.tasks):
        assert asked.specification_of(task).set_name == task.set_name


def test_a_bounded_answer_is_that_of_its_limits(tmp_path: Path) -> None:
    """A refuting drive of one question about drives is none of another."""
    slow = "v_lon(SV) < 100 km/h"
    common: dict[str, Any] = {"engine": "milp", "dt": "3/5", "jobs": 1}
    first = rp.prove(slow, out=tmp_path, horizon=3, **common)
    assert (first.verdict, first.exit_code) == ("REFUTED", 10)
    truck = rp.prove("v_lon(SV) < 140 km/h", out=tmp_path, horizon=3, vehicles="truck", **common)
    assert (truck.verdict, truck.exit_code) == ("PROVED-BOUNDED", 0)
    car = rp.prove("v_lon(SV) < 140 km/h", out=tmp_path, horizon=3, **common)
    assert (car.verdict, car.exit_code) == ("REFUTED", 10)
    limits = truck.as_data()["verdicts"]
    assert [(x["view"], x["limits"]["horizon"]) for x in limits] == [("grid", "3")]  # type: ignore[union-attr,index]
    again = rp.prove(slow, out=tmp_path, horizon=3, **common)
    assert [(x.verdict, x.expected) for x in again.answers] == [("REFUTED", "PROVED-BOUNDED")]
    false = rp.prove(slow, out=tmp_path, horizon=3, expect="REFUTED", **common)
    assert [(x.verdict, x.expected) for x in false.answers] == [("REFUTED", "REFUTED")]
    assert false.exit_code == 0
    dense = rp.prove(slow, out=tmp_path, jobs=1)
    assert (dense.verdict, dense.exit_code) == ("REFUTED", 10)
