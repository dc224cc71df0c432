"""Answers that are known before they are asked for: taken only where all that they depend on is the same."""

import json
import lzma
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from api.both_interfaces import MINE
from roadproof.errors import InputError
from roadproof.evidence.answer import RefutingTrace
from roadproof.evidence.answer_codec import answer_data
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import Ruling, judge_file
from roadproof.evidence.readers import refutation
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.cli.main import main
from roadproof.library.specification import Library
from roadproof.questions.store import Store
from roadproof.reasons import ReasonKind
from roadproof.runtime import archives
from roadproof.runtime.archives import SWITCH
from roadproof.verdict import Verdict
from shipping.__main__ import FOLDER
from shipping.archive import ship
from shipping.questions import QUESTIONS

RULE = """
def tailgating(a: vehicle, b: vehicle) "a follows b closely" := v_lon(a) > 20 m/s and v_lon(b) > 1 m/s
def careless(a: vehicle) "a is fast" := v_lon(a) > 30 m/s
"""
OTHER = RULE.replace("20 m/s", "21 m/s")
CLAIMS = ("tailgating(SV,POV) -> v_lon(SV) > 19 m/s", "careless(SV) -> v_lon(SV) > 9 m/s")
Answers = QuestionAnswers[Any]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of our own, and nothing that is shipped."""
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(archives, "shipped_folder", lambda _: tmp_path / "shipped")
    archives.shipped_answers.cache_clear()
    yield tmp_path / "cache/roadproof/answers"
    archives.shipped_answers.cache_clear()


def origins(found: Answers) -> tuple[str, ...]:
    """From where the answers came that were known."""
    return tuple(found.found.origins.values())


def contents(found: Answers) -> dict[str, str]:
    """The answers as an archive has them, by key."""
    store = Store(None, found.question.kind, found.question.work)
    return {store.key(x.claim): json.dumps(answer_data(x)) for x in found.found.answers.values()}


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
    assert (origins(first), origins(second)) == ((), ("cache", "cache"))
    assert said == ["2 of 2 answers were known: 2 of earlier runs; --fresh computes them again"]
    assert first.verdicts == second.verdicts
    assert len([*home.iterdir()]) == 2
    assert origins(claims(fresh=True)) == ()


def needs(**more: Any) -> Answers:
    return rp.redundancy(90, rp.load(specs=[MINE]), effort=1, jobs=1, **more)


@pytest.mark.parametrize("ask", [claims, pair, drive, needs])
def test_known_answers_say_and_write_the_same(ask: Callable[..., Answers], tmp_path: Path) -> None:
    first = ask(out=tmp_path / "first")
    second = ask(out=tmp_path / "second")
    assert not origins(first)
    assert len(origins(second)) == len(first.found.answers)
    assert tree(tmp_path / "first") == tree(tmp_path / "second")
    assert timeless(first.as_data(), "first") == timeless(second.as_data(), "second")
    bare = ask()
    assert len(origins(bare)) == len(first.found.answers)
    assert timeless(bare.as_data(), "") == timeless(ask(fresh=True).as_data(), "")
    assert rp.check(tmp_path / "second").exit_code == 0


def tree(folder: Path) -> dict[str, Any]:
    """The files of a folder, without what they cost."""
    return {
        path.relative_to(folder).as_posix(): timeless(json.loads(path.read_text()), folder.name)
        for path in folder.rglob("*.json")
    }


def timeless(content: Any, folder: str) -> Any:
    match content:
        case dict():
            return {k: timeless(v, folder) for k, v in content.items() if k not in ("seconds", "sizes")}
        case list() | tuple():
            return [timeless(x, folder) for x in content]
        case str() if folder:
            return content.replace(f"/{folder}/", "/")
        case _:
            return content


def test_a_changed_definition_makes_only_those_unknown_that_use_it() -> None:
    claims()
    changed = claims(OTHER)
    assert origins(changed) == ("cache",)
    assert len(origins(pair())) == 0
    other = {"using": rp.load(params={"rho": 0.4})}
    assert origins(pair(**other)) == ()
    assert origins(pair(**other)) == ("cache",)
    assert origins(pair(using=rp.load(specs=[RULE]))) == ("cache",), "it uses none of the file's definitions"
    assert origins(pair(horizon=7)) == ()
    assert origins(pair(effort=50)) == ()
    assert origins(rp.overlap("3,4", jobs=1, lanes="any")) == ()


def test_definitions_of_other_sets_count() -> None:
    spec = "set mine extends base {\n  def disturb_3(SV: vehicle, POV: vehicle, L: lane) := true\n}"
    pair()
    try:
        found = rp.overlap("3,4", using=rp.load("mine", specs=[spec]), jobs=1)
    except InputError as error:  # pragma: no cover - a mistake in the text above
        pytest.fail(str(error))
    assert origins(found) == ()


def test_a_planted_change_is_noticed(home: Path) -> None:
    first = drive()
    [path] = home.iterdir()
    data = path.read_bytes()
    content = json.loads(lzma.decompress(data[32:]))
    content["formula"] = "v_lon(SV) > 29 m/s"
    for evil in (data[:32] + lzma.compress(json.dumps(content).encode()), data[:-1], b"", b"x" * 40):
        path.write_bytes(evil)
        assert origins(drive()) == ()
        assert drive().verdict is first.verdict
    path.chmod(0o666)
    assert origins(drive()) == ()


def test_a_known_drive_that_is_refused_is_computed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    drive()
    judged: list[object] = []

    def reject(file: DriveFile, library: Library) -> Ruling:
        judged.append(file)
        return (
            Ruling(None, ReasonKind.TOLD("it is rejected here"))
            if len(judged) == 1
            else judge_file(file, library)
        )

    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.judged.judge_file", reject)
        again = drive()
        assert origins(again) == ()
        assert again.verdict is Verdict.WITNESSED
    assert origins(drive()) == ("cache",)


def test_a_shipped_trace_that_is_refused_is_computed_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    claims, using = ("careless(SV) -> v_lon(SV) > 40 m/s",), rp.load(specs=[RULE])
    for known_here in ((), ("cache",)):
        found = rp.prove(*claims, using=using, jobs=1, drive=False)
        assert origins(found) == known_here
    ship(tmp_path / "shipped/known", "prove", contents(found))
    monkeypatch.setattr("roadproof.evidence.readers.refutation.fault_of", lambda *_: "rejected")
    again = rp.prove(*claims, using=using, jobs=1, drive=False)
    assert origins(again) == ()
    assert again.verdict is Verdict.REFUTED


def test_the_cache_is_shown_and_removed(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drive()
    assert main(["cache"]) == 0
    assert "     1 answers" in capsys.readouterr().out
    assert main(["cache", "--clear"]) == 0
    assert capsys.readouterr().out.count("removed") == 4
    assert not [*home.iterdir()]
    assert origins(drive()) == ()


def test_the_cache_has_bounds(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.runtime.cache.MOST_BYTES", 1)
    drive()
    assert not [*home.iterdir()]


def test_shipped_answers_count_and_changed_ones_do_not(tmp_path: Path) -> None:
    found = pair()
    path = ship(tmp_path / "shipped/known", "overlap", contents(found))
    assert origins(pair(using=rp.load(specs=[RULE]))) == ("shipped",)
    assert rp.check(pair(out=tmp_path / "out").folder).exit_code == 0
    text = lzma.decompress(path.read_bytes()).decode()
    path.write_bytes(lzma.compress(text.replace("roadproof/", "roadproof-").encode()))
    archives.shipped_answers.cache_clear()
    assert origins(pair()) == ("cache",)


@pytest.mark.parametrize(
    "damage", [b"", b"no archive", lzma.compress(b"[1]"), lzma.compress(b'{"schema": 3}'), None]
)
def test_a_damaged_archive_is_as_none(damage: bytes | None, tmp_path: Path) -> None:
    found = pair()
    path = ship(tmp_path / "shipped/known", "overlap", contents(found))
    path.write_bytes(path.read_bytes()[:-40] if damage is None else damage)
    archives.shipped_answers.cache_clear()
    assert origins(pair()) == ("cache",)
    assert pair(fresh=True).verdicts == found.verdicts


def test_an_answer_that_this_program_cannot_read_is_computed_again(tmp_path: Path) -> None:
    found = pair()
    shutil.rmtree(tmp_path / "cache")
    [(key, content)] = contents(found).items()
    later = json.dumps({**json.loads(content), "later": 1})
    ship(tmp_path / "shipped/known", "overlap", {key: later})
    assert origins(pair()) == ()


def test_an_answer_under_the_key_of_another_does_not_count(home: Path, tmp_path: Path) -> None:
    one, other = rp.overlap("3,4", jobs=1), rp.overlap("3,5", jobs=1)
    shutil.rmtree(home)
    [key] = contents(one)
    [content] = contents(other).values()
    ship(tmp_path / "shipped/known", "overlap", {key: content})
    assert origins(pair()) == ()


def test_a_known_trace_is_judged_once_by_each_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What an earlier run kept it has judged; what is shipped is judged when it is met first."""
    judged: list[int] = []
    judge = refutation.fault_of

    def counted(trace: Countermodel, *more: Any) -> str | None:
        judged.append(1)
        return judge(trace, *more)

    def asked() -> tuple[tuple[str, ...], int]:
        judged.clear()
        found = rp.prove("v_lon(SV) > 20 m/s -> v_lon(SV) > 30 m/s", drive=False, jobs=1)
        return origins(found), len(judged)

    found = rp.prove("v_lon(SV) > 20 m/s -> v_lon(SV) > 30 m/s", drive=False, jobs=1)
    assert [type(x.evidence) for x in found.found.answers.values()] == [RefutingTrace]
    monkeypatch.setattr(refutation, "fault_of", counted)
    assert asked() == (("cache",), 0)
    texts = contents(found)
    ship(tmp_path / "shipped/known", "prove", texts)
    assert asked() == (("shipped",), 1)
    assert asked() == (("shipped",), 0)
    monkeypatch.setattr(archives, "program_digest", lambda: "another program")
    assert asked() == (("shipped",), 1)
    [(key, text)] = texts.items()
    data = json.loads(text)
    for instant in data["trace"]["instants"]:
        instant["values"] = dict.fromkeys(instant["values"], "0")
    ship(tmp_path / "shipped/known", "prove", {key: json.dumps(data)})
    for _ in range(2):
        known, times = asked()
        assert known == ()
        assert times


def test_known_evidence_equals_the_computed(home: Path) -> None:
    first, second = drive(), drive()
    assert origins(second) == ("cache",)
    assert first.drives == second.drives == drive().drives
    computed, known_one, known_other = (rp.overlap("1,5", jobs=1).pairs[0].query for _ in range(3))
    assert known_one == known_other
    assert known_one is not None
    assert computed is not None
    assert known_one.formula == computed.formula


def test_every_shipped_archive_is_that_of_a_question() -> None:
    """Else its answers are never found, as after a change of version: ``make evidence`` makes them again."""
    assert all(x.suffix == ".xz" for x in FOLDER.iterdir())
    assert {*QUESTIONS} >= {"prove", "order", "classify"}


@pytest.mark.parametrize("numbers", ["1,2", "9,17"])
def test_a_sample_of_the_shipped_answers_is_as_computed(
    numbers: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(archives, "shipped_folder", lambda _: FOLDER.parent)
    there, again = rp.overlap(numbers, jobs=1), rp.overlap(numbers, jobs=1, fresh=True)
    assert {*origins(there)} == {"shipped"}
    assert there.verdicts == again.verdicts
    assert there.check().accepted


def test_another_version_is_another_question(monkeypatch: pytest.MonkeyPatch) -> None:
    pair()
    monkeypatch.setattr("roadproof.questions.store.ANSWERS", "0.0.1")
    assert origins(pair()) == ()
    assert origins(pair()) == ("cache",)
