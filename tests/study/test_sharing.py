"""Runs that divide a question without talking to each other: nothing is lost, and nothing is asked twice."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from roadproof.analysis.claims import ClaimResult, Claims, name_of
from roadproof.analysis.study.frame import conduct
from roadproof.errors import InputError, SharedError, UsageError
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.proofs import claims_of
from roadproof.frontends.cli.main import main
from roadproof.runtime.executors import Cluster, Executor, Shard
from roadproof.runtime.files import hold_folder

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
    assert 0 < len(study.asked) < len(whole)
    found = conduct(study, folder, Executor(1, shard=Shard(3, 3)))  # the last one has the whole
    assert len(study.asked) == len({*study.asked}) == len(whole)
    assert plain(found.answers) == plain(whole)
    assert plain(conduct(study, folder, 1).answers) == plain(whole)
    assert len(study.asked) == len(whole)


def test_the_last_run_asks_what_a_run_that_never_came_was_to_ask(study: Counted, tmp_path: Path) -> None:
    with pytest.raises(SharedError):
        conduct(study, tmp_path / "out", Executor(1, shard=Shard(1, 2)))
    assert 0 < len(study.asked) < 7
    assert plain(conduct(study, tmp_path / "out", 1).answers) == plain(conduct(some(), hands=1).answers)
    assert len(study.asked) == len({*study.asked}) == 7


def test_a_doubt_is_told_and_left_to_the_last_run(study: Counted, tmp_path: Path) -> None:
    first = Shard(1, 3)
    doubtful = next(x.claim for x in study.tasks if first.has(name_of(x)))
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
