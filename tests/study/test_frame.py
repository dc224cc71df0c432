"""A long question of numbers: pieces that rest on others, doubts, and processes that die."""

import os
import shutil
import signal
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import pytest

from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import conduct
from roadproof.errors import InputError, UsageError
from roadproof.library.loading import bundled_library


@dataclass(frozen=True)
class Square:
    """A number as it is kept."""

    value: int | None


@dataclass(frozen=True)
class Sums:
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
        assert "ended twice" in reason
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
