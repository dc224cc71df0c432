"""A long question of numbers: pieces that rest on others, doubts, and processes that die."""

import json
import os
import shutil
import signal
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import pytest
from roadproof.analysis.claims import ClaimResult, Claims
from roadproof.analysis.overlap import Overlap, PairVerdict
from roadproof.analysis.overlap import name_of as pair_name
from roadproof.evidence.answers.overlap import Record

from evidence.folders import changes, check, places
from roadproof.analysis.basis import Basis
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared, conduct
from roadproof.errors import InputError, SharedError, UsageError
from roadproof.evidence.codec import read, write
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.journal import ANSWERS, HEAD, seal_of
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_of
from roadproof.frontends.cli.main import main
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.specification import Source
from roadproof.runtime.executors import Cluster, Executor, Shard
from roadproof.runtime.files import hold_folder
from roadproof.verdict import Verdict


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


@dataclass(frozen=True)
class Kept(Sums):
    """The same under a schema that folders may have."""

    @property
    def question(self) -> Question:
        return Question("roadproof/index/1", {"options": {}, "specs": []}, {}, bundled_library())


def test_a_folder_that_goes_away_ends_the_run_before_an_index_names_what_is_lost(tmp_path) -> None:
    folder = tmp_path / "answers"

    def remove(name: str, answer: int | None) -> None:
        if name == "square-2" and folder.exists():
            shutil.rmtree(folder)

    with pytest.raises(InputError, match="was removed during the run"):
        conduct(Kept((1, 2, 3)), folder, hands=1, each=remove)
    assert not list(folder.rglob("*.json"))


# --- Runs that divide a question without talking to each other: nothing is lost, and nothing is asked twice

NAMES = [f"piece-{k}" for k in range(500)]


@dataclass(frozen=True)
class Counted(Claims):
    """Claims that note in a file which of them are asked; ``doubtful``: one that is never sure."""

    notes: Path = Path("/dev/null")
    doubtful: str = ""

    def settle(self, piece: Any) -> dict[str, ClaimResult]:
        with self.notes.open("a") as file:
            file.write(f"{piece.claim}\n")
        return super().settle(piece)

    def is_sure(self, answer: ClaimResult) -> bool:
        return answer.task.claim != self.doubtful and super().is_sure(answer)

    @property
    def asked(self) -> list[str]:
        return self.notes.read_text().splitlines()


@pytest.fixture
def study(tmp_path: Path) -> Counted:
    return some(tmp_path / "notes")


def some(notes: Path = Path("/dev/null")) -> Counted:
    claims = claims_of(load(), [f"v_lon(SV) > {k} m/s -> v_lon(SV) > {k - 1} m/s" for k in range(1, 8)], None)
    return Counted(claims.tasks, claims.specifications, notes=notes)


def plain(answers: Mapping[str, ClaimResult]) -> dict[str, Any]:
    return {name: (x.task, x.verdict, x.settled.result.certificate) for name, x in sorted(answers.items())}


@pytest.mark.parametrize("of", [1, 2, 3, 7])
def test_each_piece_is_in_one_share(of: int) -> None:
    shards = [Shard(k, of) for k in range(1, of + 1)]
    assert [sum(shard.has(name) for shard in shards) for name in NAMES] == [1] * len(NAMES)
    assert sorted(x for shard in shards for x in shard.among(NAMES)) == sorted(NAMES)
    assert all(sum(map(shard.has, NAMES)) > len(NAMES) / of / 2 for shard in shards)


def test_shares_make_up_the_whole(study: Counted, tmp_path: Path) -> None:
    whole, folder = conduct(some(), hands=1).answers, tmp_path / "out"
    for number in (2, 1, 2):
        with pytest.raises(
            SharedError, match=f"shard {number}/3 is done: . answers are stored; other runs process . claims"
        ):
            conduct(study, folder, Executor(1, shard=Shard(number, 3)), what="claims")
    assert len(study.asked) == 5  # of 7: every third to each of two runs
    found = conduct(study, folder, Executor(1, shard=Shard(3, 3)))  # the last one has the whole
    assert len(study.asked) == len({*study.asked}) == len(whole)
    assert plain(found.answers) == plain(whole)
    assert plain(conduct(study, folder, 1).answers) == plain(whole)
    assert len(study.asked) == len(whole)


def test_the_last_run_asks_what_a_run_that_never_came_was_to_ask(study: Counted, tmp_path: Path) -> None:
    with pytest.raises(SharedError):
        conduct(study, tmp_path / "out", Executor(1, shard=Shard(1, 2)))
    assert len(study.asked) == 4
    assert plain(conduct(study, tmp_path / "out", 1).answers) == plain(conduct(some(), hands=1).answers)
    assert len(study.asked) == len({*study.asked}) == 7


def test_a_doubt_is_told_and_left_to_the_last_run(study: Counted, tmp_path: Path) -> None:
    first = Shard(1, 3)
    doubtful = study.tasks[0].claim
    study = replace(study, doubtful=doubtful)
    with pytest.raises(SharedError) as raised:
        conduct(study, tmp_path / "out", Executor(1, shard=first))
    assert "1 in doubt, to be computed again" in str(raised.value)
    conduct(study, tmp_path / "out", 1)
    assert [x for x in study.asked if study.asked.count(x) > 1] == [doubtful] * 2


def test_what_no_share_is(capsys: pytest.CaptureFixture[str]) -> None:
    for text in ("0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2", ""):
        with pytest.raises(UsageError, match="write K/N with K from 1 to N"):
            Shard.read(text)
    with pytest.raises(UsageError, match="the folder that the runs share"):
        conduct(some(), hands=Executor(shard=Shard(1, 2)))
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


# --- Kept answers, one file each: only those count that are as they were written, and of this very question

BASIS = Basis(bundled_library().select())
PAIRS = ((Scenario(3, "base"), Scenario(4, "base")), (Scenario(5, "base"), Scenario(6, "base")))
STUDY = Overlap(BASIS, PAIRS)
FIRST, SECOND = (pair_name(*pair) for pair in PAIRS)


@cache
def answers() -> dict[str, PairVerdict]:
    return dict(conduct(STUDY, hands=1).answers)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder as a run leaves it that was broken off before its index."""
    made = tmp_path / "out"
    shelf = EvidenceStore(made, STUDY.question)
    for name, answer in answers().items():
        shelf.keep(name, write(STUDY.record(name, answer, shelf)), STUDY.is_sure(answer))
    return made


def kept(folder: Path, question: Question | None = None) -> tuple[list[str], list[str]]:
    """The names of the answers that count, and what is told of the others."""
    told: list[str] = []
    found = [name for name, _ in EvidenceStore(folder, question or STUDY.question).answers(told.append)]
    return found, told


def file_of(folder: Path, name: str = FIRST) -> Path:
    return folder / ANSWERS / f"{name}.json"


def record_of(folder: Path, name: str = FIRST) -> Any:
    return json.loads(file_of(folder, name).read_text("utf-8"))


def test_answers_are_kept_and_checked(folder: Path) -> None:
    assert kept(folder) == ([FIRST, SECOND], [])
    findings = check(folder)
    assert [(x.outcome, x.verdict, x.label) for x in findings] == [
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 3@base and 4@base"),
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 5@base and 6@base"),
    ]


def test_what_is_kept_comes_back_as_it_was(folder: Path) -> None:
    shelf = EvidenceStore(folder, STUDY.question)
    records = (read(Record, content, "a kept answer") for _, content in shelf.answers())
    found = dict(STUDY.recall(record, shelf) for record in records)
    for name, answer in answers().items():
        assert found[name].certificate == answer.certificate
        assert found[name].query is not None
        assert answer.query is not None
        assert found[name].query.formula == answer.query.formula
        assert [core.told for core in found[name].cores] == [core.told for core in answer.cores]


def test_nothing_that_is_kept_is_asked_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Overlap, "settle", lambda *_: pytest.fail("asked again"))
    found = conduct(STUDY, folder)
    assert [x.verdict for x in found.answers.values()] == [Verdict.IMPOSSIBLE] * 2
    told = found.as_data(found.records[FIRST])["verdict"]
    assert told["certificate"] == str(folder / f"impossible-{FIRST}.json")


def test_a_folder_may_be_moved(folder: Path, tmp_path: Path) -> None:
    moved = folder.rename(tmp_path / "moved")
    assert kept(moved) == ([FIRST, SECOND], [])


def test_no_change_of_an_answer_counts(folder: Path) -> None:
    """With the seal that was there; and, where it says something else, with one that was made anew."""
    head, first = json.loads((folder / HEAD).read_text("utf-8")), record_of(folder)
    told_only = ("verdict.core", "verdict.cores", "verdict.reason", "verdict.seconds")
    tried, counting = 0, []
    for place in places(first):
        for word, changed in changes(first, place):
            name = f"{'.'.join(map(str, place))}: {word}"
            tried += 1
            file_of(folder).write_text(json.dumps(changed), "utf-8")
            assert kept(folder)[0] == [SECOND], name
            if name.startswith(told_only) or "evidence" not in changed or place[0] in ("seal", "evidence"):
                continue
            try:
                sealed = {**changed, "seal": seal_of(changed, head["question"], folder)}
            except (TypeError, ValueError):
                continue
            file_of(folder).write_text(json.dumps(sealed), "utf-8")
            if kept(folder)[0] != [SECOND]:
                counting.append(name)
    assert tried > 150
    assert counting == []


def test_a_changed_answer_is_rejected_by_check(folder: Path) -> None:
    text = file_of(folder).read_text("utf-8")
    file_of(folder).write_text(text.replace("IMPOSSIBLE", "WITNESSED"), "utf-8")
    assert any(x.outcome is Acceptance.REJECTED and "seal" in x.reason for x in check(folder))


def test_other_evidence_is_found_under_a_new_seal(folder: Path) -> None:
    head, first = json.loads((folder / HEAD).read_text("utf-8")), record_of(folder)
    other = (folder / f"impossible-{SECOND}.json").read_bytes()
    (folder / f"impossible-{FIRST}.json").write_bytes(other)
    sealed = {**first, "seal": seal_of(first, head["question"], folder)}
    file_of(folder).write_text(json.dumps(sealed), "utf-8")
    names, told = kept(folder)
    assert names == [SECOND]
    assert "but its file" in told[0]
    assert any("but its file" in x.reason for x in check(folder))


@pytest.mark.parametrize("gone", [f"impossible-{FIRST}.json", f"{ANSWERS}/{FIRST}.json"])
def test_what_is_gone_is_asked_again(folder: Path, gone: str) -> None:
    (folder / gone).unlink()
    assert kept(folder)[0] == [SECOND]


def test_an_answer_under_another_name_is_no_other_answer(folder: Path) -> None:
    """Each name is that of a pair, and a pair is asked by its name."""
    file_of(folder).rename(file_of(folder, "base-07-base-08"))
    other = Overlap(BASIS, ((Scenario(7, "base"), Scenario(8, "base")),))
    found = conduct(other, folder, hands=1)
    (verdict,) = other.verdicts(found.answers)
    assert (verdict.a.number, verdict.b.number) == (7, 8)


def other_questions() -> Iterator[tuple[str, Question]]:
    library = bundled_library()

    def under(basis: Basis) -> Question:
        return Overlap(basis, PAIRS).question

    def added(text: str) -> Question:
        return under(Basis(build_library([Source("m", text)], library).select()))

    yield "another value", under(replace(BASIS, values={"rho": Fraction(1)}))
    yield "another reading", under(Basis(library.select("base", {"lateral_sign": "literal"})))
    yield "another set", under(Basis(library.select("ext")))
    yield "another library", added("def danger(a, b: vehicle) := true")
    yield "another default", added("param rho = 1 s where rho >= 0")
    yield "another bound", added("param rho = 0.6 s where rho > 0")
    yield "another order of readings", added("option lateral_sign = literal | rss")
    yield "another analysis", replace(STUDY.question, schema="roadproof/redundancy/1")


OTHERS = dict(other_questions())


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS.keys())
def test_answers_to_another_question_are_not_taken_over(folder: Path, other: Question) -> None:
    with pytest.raises(UsageError, match="the answers to another question"):
        kept(folder, other)


def test_answers_of_another_version_are_not_taken_over(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.evidence.heading.VERSION", "0.0.0")
    with pytest.raises(UsageError, match="the answers to another question"):
        kept(folder)


def test_planted_seals_that_are_not_compared_are_noticed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = record_of(folder)
    slower = {**first, "verdict": {**first["verdict"], "seconds": 9.0}}
    file_of(folder).write_text(json.dumps(slower), "utf-8")
    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.journal.seal_of", lambda record, question, folder: record["seal"])
        assert kept(folder)[0] == [FIRST, SECOND]
    assert kept(folder)[0] == [SECOND]


def test_planted_evidence_that_is_not_looked_at_is_noticed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head, first = json.loads((folder / HEAD).read_text("utf-8")), record_of(folder)
    wrong = {**first, "verdict": {**first["verdict"], "verdict": "WITNESSED"}}
    sealed = {**wrong, "seal": seal_of(wrong, head["question"], folder)}
    file_of(folder).write_text(json.dumps(sealed), "utf-8")
    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.journal.read_record", lambda *_: [])
        patch.setattr("roadproof.evidence.journal.faults_of_line", lambda *_: iter(()))
        assert kept(folder)[0] == [FIRST, SECOND]
    assert kept(folder)[0] == [SECOND]


def test_copies_of_specification_files_lie_beside_the_evidence(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("def near(a, b: vehicle) := s(a) - s(b) < 10 m\n")
    out = tmp_path / "out"
    assert main(["overlap", "--among", "5,6", "--spec", str(mine), "--out", str(out), "--no-pictures"]) == 0
    assert (out / "mine.spec").read_text() == mine.read_text()
    assert json.loads((out / "index.json").read_text())["specs"] == ["mine.spec"]
    assert main(["check", str(out)]) == 0
