"""Runs that divide a question among them, and folders of answers that they go on in."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from questions.decided_claims import Asked
from roadproof.engines.search.batches import Engines
from roadproof.errors import InputError, SharedError, UsageError
from roadproof.evidence.answer import undecided
from roadproof.evidence.answer_codec import answer_data
from roadproof.extensions.surveys.redundancy import RedundancyQuestion
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_question
from roadproof.frontends.cli.main import main
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.questions.basis import Basis
from roadproof.questions.decide import Decisions, decide_claims
from roadproof.questions.overlap import Meeting, OverlapQuestion
from roadproof.reasons import ReasonKind
from roadproof.runtime.executors import Cluster, Executor, Shard
from roadproof.runtime.files import lock_folder
from sharing import made_once

# --- Runs that divide a question without talking to each other: nothing is lost, and nothing is asked twice

NAMES = [f"piece-{k}" for k in range(500)]


@pytest.fixture
def asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The claims that engines are asked."""
    return Asked(tmp_path / "notes", monkeypatch, Engines, lambda claim: claim.text)


QUESTION = claims_question(
    load(), [f"v_lon(SV) > {k} m/s -> v_lon(SV) > {k - 1} m/s" for k in range(1, 8)], None
)


def plain(found: Decisions) -> dict[str, Any]:
    return {name: answer_data(x) for name, x in sorted(found.answers.items())}


@pytest.mark.parametrize("of", [1, 2, 3, 7])
def test_each_piece_is_in_one_share(of: int) -> None:
    shards = [Shard(k, of) for k in range(1, of + 1)]
    assert [sum(shard.includes(name) for shard in shards) for name in NAMES] == [1] * len(NAMES)
    assert sorted(x for shard in shards for x in shard.among(NAMES)) == sorted(NAMES)
    assert all(sum(map(shard.includes, NAMES)) > len(NAMES) / of / 2 for shard in shards)


def test_shares_make_up_the_whole(asked: Asked, tmp_path: Path) -> None:
    whole, folder = decide_claims(QUESTION, tmp_path / "whole", 1), tmp_path / "out"
    assert len(asked.since()) == 7
    shares = []
    for number in (2, 1, 2):
        with pytest.raises(
            SharedError, match=f"shard {number}/3 is done: . answers are stored; other runs process . claims"
        ):
            decide_claims(QUESTION, folder, Executor(1, shard=Shard(number, 3)))
        shares += asked.since()
    assert len(shares) == 5  # of 7: every third to each of two runs
    found = decide_claims(QUESTION, folder, Executor(1, shard=Shard(3, 3)))  # the last one has the whole
    shares += asked.since()
    assert len(shares) == len({*shares}) == len(whole.answers)
    assert plain(found) == plain(whole)
    assert plain(decide_claims(QUESTION, folder, 1)) == plain(whole)
    assert asked.since() == []


def test_the_last_run_asks_what_a_run_that_never_came_was_to_ask(asked: Asked, tmp_path: Path) -> None:
    with pytest.raises(SharedError):
        decide_claims(QUESTION, tmp_path / "out", Executor(1, shard=Shard(1, 2)))
    first = asked.since()
    assert len(first) == 4
    decide_claims(QUESTION, tmp_path / "out", 1)
    assert len({*first, *asked.since()}) == 7


def test_a_doubt_is_told_and_left_to_the_last_run(
    asked: Asked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    doubtful, true_settle = QUESTION.tasks[0].task.claim, Engines.answer_claim

    def doubt(engines: Engines, claim: Any, *more: Any) -> Any:
        answer, cost = true_settle(engines, claim, *more)
        return (undecided(claim, ReasonKind.SOLVER_GAVE_UP()) if claim.text == doubtful else answer), cost

    with monkeypatch.context() as patch:
        patch.setattr(Engines, "answer_claim", doubt)
        with pytest.raises(SharedError) as raised:
            decide_claims(QUESTION, tmp_path / "out", Executor(1, shard=Shard(1, 3)))
    assert "1 in doubt, to be computed again" in str(raised.value)
    first = asked.since()
    decide_claims(QUESTION, tmp_path / "out", 1)
    assert [x for x in first if x in asked.since()] == [doubtful]


def test_what_no_share_is(capsys: pytest.CaptureFixture[str]) -> None:
    for text in ("0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2", ""):
        with pytest.raises(UsageError, match="write K/N with K from 1 to N"):
            Shard.read(text)
    with pytest.raises(UsageError, match="the folder that the runs share"):
        decide_claims(QUESTION, executor=Executor(shard=Shard(1, 2)))
    for line, told in (
        ("--shard 1/2 --json -", "use --json in the run without --shard"),
        ("--tls-ca ca.pem", "--tls-ca requires --cluster"),
        ("--cluster local:2 --jobs 2", "--jobs and --cluster exclude each other"),
        ("--cluster somewhere", "write the address of a scheduler"),
    ):
        assert main(["overlap", "--among", "3,4", "--out", "never", *line.split()]) == 2
        assert told in capsys.readouterr().err
    assert not Path("never").exists()


def test_runs_that_share_a_folder_keep_others_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.runtime.files.RELEASE_SECONDS", 0.0)
    outside = pytest.raises(InputError, match="another run is writing")
    with (
        lock_folder(tmp_path, shared=True),
        lock_folder(tmp_path, shared=True),
        outside,
        lock_folder(tmp_path),
    ):
        pass
    with lock_folder(tmp_path), outside, lock_folder(tmp_path, shared=True):
        pass


def test_what_a_cluster_may_be_called() -> None:
    assert Cluster("local:3").local == 3
    assert Cluster("tcp://10.0.0.1:8786").local == 0
    for text in ("local", "local:", "local:x", "host:8786", "tcp://host", "http://host:1", "tcp:// a:1"):
        with pytest.raises(UsageError, match="write the address of a scheduler"):
            Cluster(text)


def test_a_folder_that_goes_away_ends_the_run(tmp_path: Path) -> None:
    folder = tmp_path / "answers"

    def remove(*_: Any) -> None:
        shutil.rmtree(folder, ignore_errors=True)

    with pytest.raises(InputError, match="was removed during the run"):
        decide_claims(QUESTION, folder, executor=1, each=remove)
    assert not list(tmp_path.rglob("*.json"))


# --- Answers of a folder, one file each: only those count that are of this very question

BASIS = Basis(bundled_library().select())
PAIRS = OverlapQuestion(BASIS, Meeting(among=(3, 4, 5)))
FIRST, SECOND, *_ = (name for claims in PAIRS.claims.values() for name in claims)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = made_once("pairs", lambda home: decide_claims(PAIRS, home / "out", 1))
    return Path(shutil.copytree(made / "out", tmp_path / "out"))


def again(folder: Path, asked: Asked, question: OverlapQuestion = PAIRS) -> tuple[int, list[str]]:
    """How many claims are asked again, and what is told of files that do not count."""
    asked.since()
    told: list[str] = []
    decide_claims(question, folder, 1, say=told.append)
    return len(asked.since()), told


def test_nothing_that_is_there_is_asked_again(folder: Path, asked: Asked, tmp_path: Path) -> None:
    before = {x.name: x.read_bytes() for x in folder.iterdir()}
    assert again(folder, asked) == (0, [])
    assert again(folder.rename(tmp_path / "moved"), asked) == (0, []), "a folder may be moved"
    assert {x.name: x.read_bytes() for x in (tmp_path / "moved").iterdir()} == before


@pytest.mark.parametrize(
    "content", [b"", b"{}", b"[1]", b'{"schema": "roadproof/drive/1"}', b"\xff", None], ids=str
)
def test_a_file_that_does_not_stand_is_told_and_computed_again(
    content: bytes | None, folder: Path, asked: Asked
) -> None:
    path = folder / f"{FIRST}.json"
    good = path.read_bytes()
    path.write_bytes((folder / f"{SECOND}.json").read_bytes() if content is None else content)
    count, [told] = again(folder, asked)
    assert count == 1
    assert "a stored answer is invalid and is computed again" in told
    assert path.read_bytes() == good


def test_what_is_gone_is_asked_again(folder: Path, asked: Asked) -> None:
    (folder / f"{FIRST}.json").unlink()
    assert again(folder, asked) == (1, [])
    assert rp.check(folder, jobs=1).accepted


def other_questions() -> Iterator[tuple[str, Any]]:
    library = bundled_library()

    def under(basis: Basis) -> OverlapQuestion:
        return OverlapQuestion(basis, PAIRS.settings)

    def added(text: str) -> OverlapQuestion:
        return under(Basis(build_library([Source("m", text)], library).select()))

    yield "another value", under(replace(BASIS, values={"rho": Fraction(1)}))
    yield "another reading", under(Basis(library.select("base", {"lateral_sign": "literal"})))
    yield "another set", under(Basis(library.select("ext")))
    yield "another library", added("def danger(a, b: vehicle) := true")
    yield "another default", added("param rho = 1 s where rho >= 0")
    yield "another bound", added("param rho = 0.6 s where rho > 0")
    yield "another order of readings", added("option lateral_sign = literal | rss")
    yield "another analysis", RedundancyQuestion(BASIS)
    yield "other pairs", OverlapQuestion(BASIS, Meeting(among=(3, 4)))
    yield "another start", OverlapQuestion(BASIS, replace(PAIRS.settings, start="any"))


OTHERS = dict(other_questions())


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS.keys())
def test_answers_to_another_question_are_not_taken_over(folder: Path, other: Any) -> None:
    before = {x.name: x.read_bytes() for x in folder.glob("*.json")}
    with pytest.raises(UsageError, match="the answers to another question"):
        decide_claims(other, folder, 1)
    assert {x.name: x.read_bytes() for x in folder.glob("*.json")} == before


def test_answers_of_another_version_are_not_taken_over(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.evidence.heading.VERSION", "0.0.0")
    with pytest.raises(UsageError, match="the answers to another question"):
        decide_claims(PAIRS, folder, 1)


def test_copies_of_specification_files_lie_beside_the_evidence(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("def near(a, b: vehicle) := s(a) - s(b) < 10 m\n")
    out = tmp_path / "out"
    assert main(["overlap", "--among", "5,6", "--spec", str(mine), "--out", str(out), "--no-pictures"]) == 0
    assert (out / "mine.spec").read_text() == mine.read_text()
    assert json.loads((out / "question.json").read_text())["basis"]["specs"] == ["mine.spec"]
    assert main(["check", str(out)]) == 0
