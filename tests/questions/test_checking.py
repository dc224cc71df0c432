"""What ``check`` prints of a folder beside its claims: the view of its accepted answers."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.evidence.finding import Acceptance
from roadproof.frontends.api.checking import LISTS, check
from roadproof.questions.question import QUESTION
from roadproof.verdict import ExitCode, Verdict
from sharing import made_once


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Pairs, and the tables of them."""
    made = made_once(
        "checked-pairs", lambda home: rp.overlap("3-5", out=home / "pairs", jobs=1).add_files(False)
    )
    return Path(shutil.copytree(made / "pairs", tmp_path / "pairs"))


def verdicts(folder: Path) -> dict[str, Verdict]:
    [view] = check(folder, jobs=1).views.values()
    return dict(view.verdicts)


def test_the_view_of_what_is_accepted_is_that_of_the_run(folder: Path) -> None:
    checked = check(folder, jobs=1)
    assert checked.exit_code is ExitCode.AS_EXPECTED
    assert str(rp.overlap("3-5", jobs=1)).rpartition(" in ")[0] in str(checked)
    assert {*verdicts(folder).values()} >= {Verdict.IMPOSSIBLE}


def test_an_answer_that_is_rejected_is_in_doubt_in_the_view(folder: Path) -> None:
    before = verdicts(folder)
    path = next(x for x in sorted(folder.glob("*.json")) if "queries" in x.read_text("utf-8"))
    content = json.loads(path.read_text("utf-8"))
    content["queries"] = content["queries"][:-1]
    path.write_text(json.dumps(content), "utf-8")
    checked = check(folder, jobs=1)
    assert checked.exit_code is ExitCode.UNEXPECTED
    after = verdicts(folder)
    assert [(before[x], after[x]) for x in before if before[x] is not after[x]] == [
        (Verdict.IMPOSSIBLE, Verdict.UNKNOWN)
    ]


@pytest.mark.parametrize("change", [lambda x: x + b"\n", lambda x: x.replace(b"IMPOSSIBLE", b"WITNESSED")])
def test_a_table_that_the_answers_do_not_make_is_rejected(
    change: Callable[[bytes], bytes], folder: Path
) -> None:
    table = next(folder.glob("*.csv"))
    table.write_bytes(change(table.read_bytes()))
    checked = check(folder, jobs=1)
    assert [x.where for x in checked.findings if x.outcome is Acceptance.REJECTED] == [str(table)]


@pytest.mark.parametrize("content", ["", "{}", "[]", '{"schema": "roadproof/question/9"}'])
def test_a_question_that_cannot_be_read_is_rejected(content: str, folder: Path) -> None:
    (folder / QUESTION).write_text(content, "utf-8")
    assert check(folder, jobs=1).exit_code in (ExitCode.UNEXPECTED, ExitCode.BAD_INPUT)


def test_views_that_are_lists_of_claims_are_not_printed_twice(tmp_path: Path) -> None:
    rp.prove("v_lon(SV) > 2 m/s -> v_lon(SV) > 1 m/s", out=tmp_path, jobs=1)
    assert check(tmp_path, jobs=1).views == {}
    assert LISTS == ("prove", "witness")
