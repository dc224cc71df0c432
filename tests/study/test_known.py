"""Answers that are known before they are asked for: taken only where all that they depend on is the same."""

import json
import lzma
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from roadproof.analysis.overlap import Overlap

import roadproof as rp
from api.doors import MINE
from roadproof.analysis.study import known
from roadproof.analysis.study.known import SWITCH, KnownAnswers
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.judged import Ruling, judge_file
from roadproof.frontends.api.studied import StudyAnswers
from roadproof.frontends.cli.main import main
from roadproof.library.specification import Library
from roadproof.reasons import Why
from roadproof.verdict import Verdict
from shipping.__main__ import FOLDER, answers_of, archive_of
from shipping.questions import QUESTIONS

RULE = """
def tailgating(a: vehicle, b: vehicle) "a follows b closely" := v_lon(a) > 20 m/s and v_lon(b) > 1 m/s
def careless(a: vehicle) "a is fast" := v_lon(a) > 30 m/s
"""
OTHER = RULE.replace("20 m/s", "21 m/s")
CLAIMS = ("tailgating(SV,POV) -> v_lon(SV) > 19 m/s", "careless(SV) -> v_lon(SV) > 9 m/s")
Answers = StudyAnswers[Any, Any, Any]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of our own, and nothing that is shipped."""
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(known, "shipped", lambda _: tmp_path / "shipped")
    yield tmp_path / "cache/roadproof/answers"
    known._read.cache_clear()


def claims(text: str = RULE, **more: Any) -> Answers:
    using = rp.load(specs=[text])
    return rp.prove(
        "tailgating(SV,POV) -> v_lon(SV) > 19 m/s",
        "careless(SV) -> v_lon(SV) > 9 m/s",
        using=using,
        jobs=1,
        **more,
    )


def pair(**more: Any) -> Answers:
    return rp.overlap("3,4", jobs=1, **more)


def drive(**more: Any) -> Answers:
    return rp.witness("v_lon(SV) > 30 m/s", jobs=1, **more)


def test_the_second_run_takes_what_the_first_has_found(home: Path) -> None:
    said: list[str] = []
    first, second = claims(), claims(say=said.append)
    assert (first.found.known, second.found.known) == ((), ("cache", "cache"))
    assert said == ["2 of 2 answers were known: 2 of earlier runs; --fresh computes them again"]
    assert first.verdicts == second.verdicts
    assert len([*home.iterdir()]) == 2
    assert claims(fresh=True).found.known == ()


def needs(**more: Any) -> Answers:
    return rp.redundancy(90, rp.load(specs=[MINE]), effort=1, jobs=1, **more)


@pytest.mark.parametrize("ask", [claims, pair, drive, needs])
def test_known_answers_say_and_write_the_same(ask: Callable[..., Answers], tmp_path: Path) -> None:
    first = ask(out=tmp_path / "first")
    second = ask(out=tmp_path / "second")
    assert not first.found.known
    assert len(second.found.known) == len(first.found.answers)
    assert tree(tmp_path / "first") == tree(tmp_path / "second")
    assert timeless(first.as_data(), "first") == timeless(second.as_data(), "second")
    bare = ask()
    assert len(bare.found.known) == len(first.found.answers)
    assert timeless(bare.as_data(), "") == timeless(ask(fresh=True).as_data(), "")
    assert rp.check(tmp_path / "second").exit_code == 0


def tree(folder: Path) -> dict[str, Any]:
    """The files of a folder, without seconds, and without seals, which count them."""
    return {
        path.relative_to(folder).as_posix(): timeless(json.loads(path.read_text()), folder.name)
        for path in folder.rglob("*.json")
    }


def timeless(content: Any, folder: str) -> Any:
    match content:
        case dict():
            return {k: timeless(v, folder) for k, v in content.items() if k not in ("seconds", "seal")}
        case list() | tuple():
            return [timeless(x, folder) for x in content]
        case str() if folder:
            return content.replace(f"/{folder}/", "/")
        case _:
            return content


def test_a_changed_definition_makes_only_those_unknown_that_use_it() -> None:
    claims()
    changed = claims(OTHER)
    assert changed.found.known == ("cache",)
    assert len(pair().found.known) == 0
    other = {"using": rp.load(params={"rho": 0.4})}
    assert pair(**other).found.known == ()
    assert pair(**other).found.known == ("cache",)
    assert pair(using=rp.load(specs=[RULE])).found.known == ("cache",), (
        "it uses none of the file's definitions"
    )
    assert pair(horizon=7).found.known == ()
    assert pair(effort=50).found.known == ()
    assert rp.overlap("3,4", jobs=1, lanes="any").found.known == ()


def test_definitions_of_other_sets_count() -> None:
    spec = "set mine extends base {\n  def disturb_3(SV: vehicle, POV: vehicle, L: lane) := true\n}"
    pair()
    try:
        found = rp.overlap("3,4", using=rp.load("mine", specs=[spec]), jobs=1)
    except InputError as error:  # pragma: no cover - a mistake in the text above
        pytest.fail(str(error))
    assert found.found.known == ()


def test_a_planted_change_is_noticed(home: Path) -> None:
    first = drive()
    [path] = home.iterdir()
    data = path.read_bytes()
    content = json.loads(lzma.decompress(data[32:]))
    content["record"]["outcome"]["verdict"] = "IMPOSSIBLE"
    for evil in (data[:32] + lzma.compress(json.dumps(content).encode()), data[:-1], b"", b"x" * 40):
        path.write_bytes(evil)
        assert drive().found.known == ()
        assert drive().verdict is first.verdict
    path.chmod(0o666)
    assert drive().found.known == ()


def test_a_recalled_drive_is_judged_once_and_refused_ones_are_computed_again(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drive()
    judged: list[object] = []

    def reject(file: DriveFile, library: Library) -> Ruling:
        judged.append(file)
        return (
            Ruling(None, Why.TOLD("it is rejected here")) if len(judged) == 1 else judge_file(file, library)
        )

    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.judged.judge_file", reject)
        again = drive()
        assert again.found.known == ()
        assert again.verdict is Verdict.WITNESSED
    assert drive().found.known == ("cache",)
    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.judged.judge_file", lambda *_: pytest.fail("it is judged again"))
        assert drive().found.known == ("cache",), "this program has judged the same bytes for the same claim"


def test_a_recalled_trace_is_judged_and_a_refused_one_is_computed_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    claims, using = ("careless(SV) -> v_lon(SV) > 40 m/s",), rp.load(specs=[RULE])
    for known_here in ((), ("cache",)):
        assert rp.prove(*claims, using=using, jobs=1, drive=False).found.known == known_here
    monkeypatch.setattr(
        "roadproof.analysis.claims.judge_trace", lambda *_: (Acceptance.REJECTED, Why.TOLD("rejected"))
    )
    again = rp.prove(*claims, using=using, jobs=1, drive=False)
    assert again.found.known == ()
    assert again.verdict is Verdict.REFUTED


def test_what_is_in_doubt_is_not_kept(home: Path) -> None:
    told = rp.witness("v_lon(SV) > 300 m/s", jobs=1)
    assert told.verdict in (Verdict.NONE_WITHIN, Verdict.UNKNOWN)
    assert not [*home.iterdir()] if home.exists() else True


def test_the_cache_is_shown_and_removed(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drive()
    assert main(["cache"]) == 0
    assert "     1 answers" in capsys.readouterr().out
    assert main(["cache", "--clear"]) == 0
    assert capsys.readouterr().out.count("removed") == 3
    assert not [*home.iterdir()]
    assert drive().found.known == ()


def test_the_cache_has_bounds(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.runtime.cache.MOST_BYTES", 1)
    drive()
    assert not [*home.iterdir()]


def test_shipped_answers_count_and_changed_ones_do_not(tmp_path: Path) -> None:
    found = pair()
    folder = tmp_path / "shipped/known"
    path = archive_of(found).ship(folder, answers_of(found))
    assert pair(using=rp.load(specs=[RULE])).found.known == ("shipped",)
    assert rp.check(pair(out=tmp_path / "out").folder).exit_code == 0
    content = json.loads(lzma.decompress(path.read_bytes()))
    [entry] = content["answers"].values()
    entry["record"]["verdict"]["verdict"] = "WITNESSED"
    path.write_bytes(lzma.compress(json.dumps(content).encode()))
    known._read.cache_clear()
    assert pair().found.known == ("cache",)


@pytest.mark.parametrize(
    "damage", [b"", b"no archive", lzma.compress(b"[1]"), lzma.compress(b'{"schema": 3}'), None]
)
def test_a_damaged_archive_is_as_none(damage: bytes | None, tmp_path: Path) -> None:
    found = pair()
    path = archive_of(found).ship(tmp_path / "shipped/known", answers_of(found))
    path.write_bytes(path.read_bytes()[:-40] if damage is None else damage)
    known._read.cache_clear()
    assert pair().found.known == ("cache",)
    assert pair(fresh=True).verdicts == found.verdicts


def test_an_archive_that_this_program_cannot_read_is_computed_again(tmp_path: Path) -> None:
    found = pair()
    shutil.rmtree(tmp_path / "cache")
    [(entry, content)] = answers_of(found).items()
    content["record"] = {**content["record"], "later": 1}
    archive_of(found).ship(tmp_path / "shipped/known", {entry: content})
    assert pair().found.known == ()


def test_an_answer_under_the_name_of_another_does_not_count(home: Path, tmp_path: Path) -> None:
    one, other = rp.overlap("3,4", jobs=1), rp.overlap("3,5", jobs=1)
    shutil.rmtree(home)
    [entry] = answers_of(one)
    [content] = answers_of(other).values()
    archive_of(one).ship(tmp_path / "shipped/known", {entry: content})
    assert pair().found.known == ()


def test_known_evidence_equals_the_computed(home: Path) -> None:
    first, second = drive(), drive()
    assert second.found.known == ("cache",)
    assert first.drives == second.drives == drive().drives
    computed, known_one, known_other = (rp.overlap("1,5", jobs=1).pairs[0].query for _ in range(3))
    assert known_one == known_other
    assert known_one is not None
    assert computed is not None
    assert known_one.formula == computed.formula


def test_every_shipped_archive_is_that_of_a_question() -> None:
    """Else its answers are never found, as after a change of version: ``make evidence`` makes them again."""
    assert all(x.name.endswith(".json.xz") for x in FOLDER.iterdir())
    assert {*QUESTIONS} >= {"prove", "order", "classify"}


@pytest.mark.parametrize("numbers", ["1,2", "9,17"])
def test_a_sample_of_the_shipped_answers_is_as_computed(
    numbers: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(known, "shipped", lambda _: FOLDER.parent)
    there, again = rp.overlap(numbers, jobs=1), rp.overlap(numbers, jobs=1, fresh=True)
    assert there.found.known == ("shipped",)
    assert timeless(there.as_data(), "") == timeless(again.as_data(), "")


def test_another_version_is_another_question(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = KnownAnswers.to("roadproof/overlap/1", {}, {})
    monkeypatch.setattr(known, "ANSWERS", "0.0.1")
    assert KnownAnswers.to("roadproof/overlap/1", {}, {}).asked != asked.asked
    assert Overlap.record_type.__name__ == "Record"
