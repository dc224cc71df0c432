"""A long question of numbers: pieces that rest on others, doubts, and processes that die."""

import json
import os
import shutil
import signal
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, ClassVar

import pytest

import roadproof as rp
from questions.heard import Asked
from roadproof.analysis.basis import Basis
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared, conduct
from roadproof.engines.search.batches import Engines
from roadproof.errors import InputError, SharedError, UsageError
from roadproof.evidence.answer import answer_data, undecided
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_of
from roadproof.frontends.cli.main import main
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.questions.overlap import Meeting, OverlapQuestion
from roadproof.questions.redundancy import RedundancyQuestion
from roadproof.questions.settle import Settled, settle
from roadproof.reasons import Why
from roadproof.runtime.executors import Cluster, Executor, Shard
from roadproof.runtime.files import hold_folder
from sharing import made_once


@dataclass(frozen=True)
class Square:
    """A number as it is kept."""

    value: int | None


@dataclass(frozen=True)
class Sums(Unprepared):
    """For each number the sum of its neighbours' squares, of which the squares are asked first.

    ``dying``: the number whose process dies; ``slow``: one that is in doubt at first.
    """

    record_type: ClassVar[type[Square]] = Square
    numbers: tuple[int, ...]
    dying: int | None = None
    slow: int | None = None

    @property
    def question(self) -> Question:
        return Question("numbers", {}, {}, bundled_library())

    def pieces(self, known: Mapping[str, int | None]) -> Sequence[tuple[str, Any]]:
        squares = [("square", n) for n in self.numbers if f"square-{n}" not in known]
        again = [("again", n) for n in self.numbers if known.get(f"square-{n}", 0) is None and n == self.slow]
        if squares or again:
            return squares or again
        return [
            ("sum", (n, known.get(f"square-{n - 1}"), known.get(f"square-{n + 1}")))
            for n in self.numbers
            if f"sum-{n}" not in known
        ]

    def settle(self, piece: tuple[str, Any]) -> dict[str, int | None]:
        match piece:
            case ("square", n):
                if n == self.dying:
                    os.kill(os.getpid(), signal.SIGKILL)
                return {f"square-{n}": None if n == self.slow else n * n}
            case ("again", n):
                return {f"square-{n}": n * n}
            case (_, (n, left, right)):
                return {f"sum-{n}": (left or 0) + (right or 0)}
        raise AssertionError(piece)

    def doubt(self, piece: tuple[str, Any], reason: str) -> dict[str, int | None]:
        assert "ended each time" in reason
        return {f"square-{piece[1]}": None}

    def is_sure(self, answer: int | None) -> bool:
        return answer is not None

    def record(self, name: str, answer: int | None, shelf: EvidenceStore) -> Square:
        return Square(answer)

    def recall(self, record: Square, shelf: EvidenceStore) -> tuple[str, int | None]:
        raise AssertionError("nothing is kept")


def sums(study: Sums, processes: int) -> dict[str, int | None]:
    answers = conduct(study, hands=processes).answers
    return {name: value for name, value in answers.items() if name.startswith("sum")}


@pytest.mark.parametrize("processes", [1, 3])
def test_later_pieces_rest_on_earlier_answers(processes: int) -> None:
    assert sums(Sums((1, 2, 3, 4)), processes) == {"sum-1": 4, "sum-2": 10, "sum-3": 20, "sum-4": 9}


def test_a_doubt_is_asked_again_under_its_name() -> None:
    assert sums(Sums((1, 2, 3), slow=2), 2) == {"sum-1": 4, "sum-2": 10, "sum-3": 4}


def test_a_piece_whose_process_dies_is_a_doubt_and_the_others_stand() -> None:
    found = conduct(Sums((1, 2, 3), dying=2), hands=2)
    assert found.answers["square-2"] is None
    assert found.answers["sum-1"] == 0
    assert found.answers["sum-2"] == 10
    assert found.as_data(found.records["square-3"]) == {"value": 9}


@dataclass(frozen=True)
class Pairs(Sums):
    """The same with the squares of two numbers in a piece."""

    def pieces(self, known: Mapping[str, int | None]) -> Sequence[tuple[int, ...]]:
        left = [n for n in self.numbers if f"square-{n}" not in known]
        return [tuple(left[k : k + 2]) for k in range(0, len(left), 2)]

    def settle(self, piece: tuple[int, ...]) -> dict[str, int | None]:
        return {name: x for n in piece for name, x in super(Pairs, self).settle(("square", n)).items()}

    def doubt(self, piece: tuple[int, ...], reason: str) -> dict[str, int | None]:
        return {f"square-{n}": None for n in piece}

    def parts(self, piece: tuple[int, ...]) -> Sequence[tuple[int, ...]]:
        return [(n,) for n in piece]


@pytest.mark.parametrize("dying", [1, 4, 5])
def test_of_a_group_whose_process_dies_only_one_is_a_doubt(dying: int) -> None:
    answers = conduct(Pairs((1, 2, 3, 4, 5), dying=dying), hands=2).answers
    assert answers == {f"square-{n}": None if n == dying else n * n for n in (1, 2, 3, 4, 5)}


def test_progress_is_told() -> None:
    told: list[tuple[int, int, str]] = []
    conduct(
        Sums((1, 2)),
        hands=2,
        progress=lambda *x: told.append(x),
        what="numbers",  # type: ignore[arg-type]
    )
    assert told == [(0, 2, "numbers"), (1, 2, "numbers"), (2, 2, "numbers")] * 2


def test_no_processes_are_too_few() -> None:
    with pytest.raises(UsageError, match="greater than 0"):
        conduct(Sums((1, 2)), hands=0)


def test_nothing_to_ask_is_nothing_found() -> None:
    assert conduct(replace(Sums(()))).answers == {}


# --- Runs that divide a question without talking to each other: nothing is lost, and nothing is asked twice

NAMES = [f"piece-{k}" for k in range(500)]


@pytest.fixture
def asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The claims that engines are asked."""
    return Asked(tmp_path / "notes", monkeypatch, Engines, lambda claim: claim.text)


QUESTION = claims_of(load(), [f"v_lon(SV) > {k} m/s -> v_lon(SV) > {k - 1} m/s" for k in range(1, 8)], None)


def plain(found: Settled) -> dict[str, Any]:
    return {name: answer_data(x) for name, x in sorted(found.answers.items())}


@pytest.mark.parametrize("of", [1, 2, 3, 7])
def test_each_piece_is_in_one_share(of: int) -> None:
    shards = [Shard(k, of) for k in range(1, of + 1)]
    assert [sum(shard.has(name) for shard in shards) for name in NAMES] == [1] * len(NAMES)
    assert sorted(x for shard in shards for x in shard.among(NAMES)) == sorted(NAMES)
    assert all(sum(map(shard.has, NAMES)) > len(NAMES) / of / 2 for shard in shards)


def test_shares_make_up_the_whole(asked: Asked, tmp_path: Path) -> None:
    whole, folder = settle(QUESTION, hands=1), tmp_path / "out"
    assert len(asked.since()) == 7
    shares = []
    for number in (2, 1, 2):
        with pytest.raises(
            SharedError, match=f"shard {number}/3 is done: . answers are stored; other runs process . claims"
        ):
            settle(QUESTION, folder, Executor(1, shard=Shard(number, 3)))
        shares += asked.since()
    assert len(shares) == 5  # of 7: every third to each of two runs
    found = settle(QUESTION, folder, Executor(1, shard=Shard(3, 3)))  # the last one has the whole
    shares += asked.since()
    assert len(shares) == len({*shares}) == len(whole.answers)
    assert plain(found) == plain(whole)
    assert plain(settle(QUESTION, folder, 1)) == plain(whole)
    assert asked.since() == []


def test_the_last_run_asks_what_a_run_that_never_came_was_to_ask(asked: Asked, tmp_path: Path) -> None:
    with pytest.raises(SharedError):
        settle(QUESTION, tmp_path / "out", Executor(1, shard=Shard(1, 2)))
    first = asked.since()
    assert len(first) == 4
    settle(QUESTION, tmp_path / "out", 1)
    assert len({*first, *asked.since()}) == 7


def test_a_doubt_is_told_and_left_to_the_last_run(
    asked: Asked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    doubtful, true_settle = QUESTION.tasks[0].task.claim, Engines.settle

    def doubt(engines: Engines, claim: Any) -> Any:
        answer, cost = true_settle(engines, claim)
        return (undecided(claim, Why.NONE_FOUND()) if claim.text == doubtful else answer), cost

    with monkeypatch.context() as patch:
        patch.setattr(Engines, "settle", doubt)
        with pytest.raises(SharedError) as raised:
            settle(QUESTION, tmp_path / "out", Executor(1, shard=Shard(1, 3)))
    assert "1 in doubt, to be computed again" in str(raised.value)
    first = asked.since()
    settle(QUESTION, tmp_path / "out", 1)
    assert [x for x in first if x in asked.since()] == [doubtful]


def test_what_no_share_is(capsys: pytest.CaptureFixture[str]) -> None:
    for text in ("0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2", ""):
        with pytest.raises(UsageError, match="write K/N with K from 1 to N"):
            Shard.read(text)
    with pytest.raises(UsageError, match="the folder that the runs share"):
        settle(QUESTION, hands=Executor(shard=Shard(1, 2)))
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
    monkeypatch.setattr("roadproof.runtime.files.LETTING_GO", 0.0)
    outside = pytest.raises(InputError, match="another run is writing")
    with (
        hold_folder(tmp_path, shared=True),
        hold_folder(tmp_path, shared=True),
        outside,
        hold_folder(tmp_path),
    ):
        pass
    with hold_folder(tmp_path), outside, hold_folder(tmp_path, shared=True):
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
        settle(QUESTION, folder, hands=1, each=remove)
    assert not list(tmp_path.rglob("*.json"))


# --- Answers of a folder, one file each: only those count that are of this very question

BASIS = Basis(bundled_library().select())
PAIRS = OverlapQuestion(BASIS, Meeting(among=(3, 4, 5)))
FIRST, SECOND, *_ = (name for claims in PAIRS.claims.values() for name in claims)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = made_once("pairs", lambda home: settle(PAIRS, home / "out", 1))
    return Path(shutil.copytree(made / "out", tmp_path / "out"))


def again(folder: Path, asked: Asked, question: OverlapQuestion = PAIRS) -> tuple[int, list[str]]:
    """How many claims are asked again, and what is told of files that do not count."""
    asked.since()
    told: list[str] = []
    settle(question, folder, 1, say=told.append)
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
        return OverlapQuestion(basis, PAIRS.asked)

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
    yield "another start", OverlapQuestion(BASIS, replace(PAIRS.asked, start="any"))


OTHERS = dict(other_questions())


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS.keys())
def test_answers_to_another_question_are_not_taken_over(folder: Path, other: Any) -> None:
    before = {x.name: x.read_bytes() for x in folder.glob("*.json")}
    with pytest.raises(UsageError, match="the answers to another question"):
        settle(other, folder, 1)
    assert {x.name: x.read_bytes() for x in folder.glob("*.json")} == before


def test_answers_of_another_version_are_not_taken_over(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.evidence.heading.VERSION", "0.0.0")
    with pytest.raises(UsageError, match="the answers to another question"):
        settle(PAIRS, folder, 1)


def test_copies_of_specification_files_lie_beside_the_evidence(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("def near(a, b: vehicle) := s(a) - s(b) < 10 m\n")
    out = tmp_path / "out"
    assert main(["overlap", "--among", "5,6", "--spec", str(mine), "--out", str(out), "--no-pictures"]) == 0
    assert (out / "mine.spec").read_text() == mine.read_text()
    assert json.loads((out / "question.json").read_text())["basis"]["specs"] == ["mine.spec"]
    assert main(["check", str(out)]) == 0
