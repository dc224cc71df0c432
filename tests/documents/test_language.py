"""Documents are written in plain English: short sentences, no riddles, no spelling mistakes.

``exceptions.txt`` lists the sentences that break a rule, a line each. It may only shrink: a new offence fails
the test, and so does a line whose sentence is gone. ``python tests/documents/test_language.py`` prints all
offences.
"""

import re
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXCEPTIONS = Path(__file__).with_name("exceptions.txt")
MOST_WORDS = 25
# Clauses that hide a noun, and inversions.
TURNS = re.compile(
    r"\b(what (?:nobody|is not|was|has no|follows|clashes|stands|holds)|nobody|whatever|whoever|that which"
    r"|there is none|there are such|but for|in place of|of which|so that it|is asked (?:about|of|for)"
    r"|has no say|says? the same|beside (?:it|that|them)|come upon|gone through)\b",
    re.IGNORECASE,
)
# Words of the private language that earlier versions were written in.
FORBIDDEN = re.compile(r"\b(?:roster|wishful|hunch|shelf|knob)s?\b", re.IGNORECASE)
FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$", re.MULTILINE | re.DOTALL)
ASIDE = re.compile(r"^(?:\||#| {4}|!\[|<).*$", re.MULTILINE)
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
END = re.compile(r"(?<=[.!?:;])\s+|\n\s*\n|\n\s*(?:[-*]|\d+\.)\s")
# Words of other languages, formats and formulas, which codespell takes for English.
KNOWN = "thw,untils"


def documents() -> list[Path]:
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def sentences(text: str) -> Iterator[str]:
    """The sentences of a page without code, tables, headings and targets of links.

    A colon or a semicolon ends one too.
    """
    prose = ASIDE.sub("", FENCE.sub("", text))
    prose = re.sub(r"`[^`]*`", "x", LINK.sub(r"\1", prose))
    for sentence in END.split(prose):
        plain = " ".join(sentence.split())
        if plain:
            yield plain


def faults(sentence: str) -> Iterator[str]:
    words = len(sentence.split())
    if words > MOST_WORDS:
        yield f"{words} words"
    yield from (f"'{x[0]}'" for x in (*TURNS.finditer(sentence), *FORBIDDEN.finditer(sentence)))


def offences() -> dict[str, str]:
    """Each sentence that breaks a rule, behind its page, with its faults."""
    found: dict[str, str] = {}
    for path in documents():
        for sentence in sentences(path.read_text("utf-8")):
            if said := ", ".join(faults(sentence)):
                found[f"{path.relative_to(ROOT).as_posix()}: {sentence}"] = said
    return found


def test_every_sentence_is_plain() -> None:
    allowed = set(EXCEPTIONS.read_text("utf-8").splitlines())
    new = {line: said for line, said in offences().items() if line not in allowed}
    assert not new, "rewrite: " + "\n".join(f"{line} ({said})" for line, said in new.items())


def test_no_exception_outlives_its_sentence() -> None:
    found = offences()
    gone = [line for line in EXCEPTIONS.read_text("utf-8").splitlines() if line not in found]
    assert not gone, "remove from exceptions.txt: " + "\n".join(gone)


@pytest.mark.parametrize(
    ("sentence", "wrong"),
    [
        ("The prover rejects claims with free lanes.", []),
        ("Refuse what nobody reads.", ["'what nobody'"]),
        ("The heuristic is a hunch.", ["'hunch'"]),
        (" ".join(["word"] * 26), ["26 words"]),
    ],
)
def test_faults_are_found(sentence: str, wrong: list[str]) -> None:
    assert list(faults(sentence)) == wrong


def test_code_and_tables_are_no_sentences() -> None:
    page = "# A title\n\nOne [link](there.md#x).\n\n```sh\nwhat nobody reads\n```\n\n| what nobody |\n\nTwo."
    assert list(sentences(page)) == ["One link.", "Two."]


@pytest.mark.skipif(find_spec("codespell_lib") is None, reason="codespell is not installed (extra dev)")
def test_spelling() -> None:
    files = [
        str(x.relative_to(ROOT)) for x in (*documents(), ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md")
    ]
    command = [sys.executable, "-m", "codespell_lib", "--ignore-words-list", KNOWN, *files]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == ""


if __name__ == "__main__":
    print(*sorted(offences()), sep="\n")
