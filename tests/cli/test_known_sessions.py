"""Commands of the book, asked with known answers on: what they say and their exit codes are as without any.

All other tests have known answers off. Each command is asked without them, with those that are shipped, and
with those that the run before has kept.
"""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

from console import files_of, sessions_of
from roadproof.frontends.cli.main import main
from roadproof.questions.store import Store
from roadproof.runtime import archives
from roadproof.runtime.archives import SWITCH

BOOK = Path(__file__).parent / "book"
ASKING = ("prove", "witness", "overlap", "explore", "coverage")
SLOW = ("coverage --set complete", "explore 4", "witness 1 --unpreventable", "explore 'v_lon(SV) <=")
"""Questions that take longer than a few seconds without known answers; ``make long`` asks them."""
END = re.compile(r"[|;>]|\s2>")
SECONDS = re.compile(r"\d+(\.\d+)? s\b|(?<=\"seconds\": )[\d.]+")


def commands() -> Iterator[tuple[str, str]]:
    """Questions of the book with the page that has them, each up to what the shell does with its answer."""
    for page in sorted(BOOK.glob("*.md")):
        for session in sessions_of(page.read_text("utf-8")):
            words = session.command.removeprefix("roadproof ")
            if session.command.startswith("roadproof ") and words.startswith(ASKING):
                yield page.stem, whole(words)


def whole(words: str) -> str:
    """A command without what is behind it; a sign in quotes is a part of it."""
    for end in END.finditer(words):
        head = words[: end.start()]
        if head.count("'") % 2 == 0 and head.count('"') % 2 == 0:
            return head.strip()
    return words


QUESTIONS = [x for x in dict.fromkeys(commands()) if not x[1].startswith(SLOW) and "$(" not in x[1]]


DURATION = re.compile(r" \(… s\)|,? *… s")
"""How long an answer took: a recalled one does not say it."""


def ask(words: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    arguments = shlex.split(words)
    if "--jobs" not in arguments:
        arguments += ["--jobs", "1"]
    if "--out" in arguments:
        arguments[arguments.index("--out") + 1] = str(folder / "out")
    try:
        code = main(arguments)
    except SystemExit as ended:
        code = int(str(ended.code))
    printed = capsys.readouterr()
    said = printed.out.replace(str(folder), "FOLDER")
    return code, DURATION.sub("", SECONDS.sub("… s", said)) + (
        printed.err.replace(str(folder), "FOLDER") if code == 2 else ""
    )


@pytest.mark.parametrize(("page", "words"), QUESTIONS, ids=[f"{page}-{x[:60]}" for page, x in QUESTIONS])
def test_known_answers_say_the_same(
    page: str,
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    for name, text in files_of((BOOK / f"{page}.md").read_text("utf-8")).items():
        (tmp_path / name).write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    archives.shipped_answers.cache_clear()
    said = []
    for switch in ("off", "on", "on"):
        monkeypatch.setenv(SWITCH, switch)
        folder = tmp_path / f"run-{len(said)}"
        folder.mkdir()
        said.append(ask(words, folder, capsys))
    without, shipped, kept = said
    assert shipped == without
    assert kept == without


def test_questions_of_several_commands_are_asked() -> None:
    assert len(QUESTIONS) >= 15
    assert {x.split()[0] for _, x in QUESTIONS} >= {"prove", "witness", "overlap", "explore"}


def test_a_wrong_known_answer_would_be_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The keys of answers leave out the claim, and what a file is about is not compared."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(Store, "key", lambda self, claim: "one key")
    for reader in ("about_claim", "certificate", "refutation"):
        monkeypatch.setattr(f"roadproof.evidence.readers.{reader}.require", lambda *_: None)
    claims = ("v_lon(SV) > 3 m/s -> v_lon(SV) > 2 m/s", "v_lon(SV) > 4 m/s -> v_lon(SV) < 3 m/s")
    monkeypatch.setenv(SWITCH, "off")
    without = [ask(f"prove '{x}' --no-drive", tmp_path, capsys) for x in claims]
    monkeypatch.setenv(SWITCH, "on")
    assert [ask(f"prove '{x}' --no-drive", tmp_path, capsys) for x in claims] != without
