"""The book of console sessions, the attacks and the examples: every page is run as it stands, in a folder
of its own, with the files that lie beside it if it is an example (see tests/console.py)."""

import shutil
from pathlib import Path

import pytest

from console import agree, files_of, matches, run, sessions_of

ROOT = Path(__file__).parents[2]
LONG = ("roadproof overlap --among 3,4,6,8",)
"""Questions of the README that ``make findings`` asks; shorter ones of these commands are in the book."""
# The example of an extension is installed, and asked, by tests/core/test_example.py.
EXAMPLES = sorted(x for x in ROOT.glob("examples/*/README.md") if x.parent.name != "extension")
TUTORIALS = ("first-scenario", "catalogue", "recordings", "careful-driver", "closed-loop")
GUIDES = (
    *("interop", "requirements", "signals", "rss", "roads", "solvers", "terminal", "recordings"),
    *("certificates", "c", "assurance", "maps", "surveys", "typical"),
)
PAGES = [
    *sorted(Path(__file__).parent.joinpath("book").glob("*.md")),
    *sorted(ROOT.joinpath("tests/attacks").glob("*.md")),
    *EXAMPLES,
    ROOT / "README.md",
    *(ROOT / "docs" / f"{name}.md" for name in ("index", "testers", "safety-cases", "researchers")),
    *(ROOT / "docs/tutorials" / f"{name}.md" for name in TUTORIALS),
    ROOT / "docs/reference/language.md",
    *(ROOT / "docs/how-to" / f"{name}.md" for name in GUIDES),
    ROOT / "docs/explanation/motion.md",
    ROOT / "docs/explanation/entering.md",
    ROOT / "docs/explanation/encoding.md",
]


def name_of(path: Path) -> str:
    """``book-proving``, ``traffic-README``, and README: wherever the clone lies."""
    return path.stem if path.parent == ROOT else f"{path.parent.name}-{path.stem}"


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_page(path: Path, tmp_path: Path) -> None:
    folder = tmp_path / "page"
    if path in EXAMPLES:
        shutil.copytree(path.parent, folder)
    else:
        folder.mkdir()
        folder.joinpath("examples").symlink_to(ROOT / "examples")
    page = path.read_text("utf-8")
    for name, text in files_of(page).items():
        (folder / name).write_text(text, "utf-8")
    sessions = sessions_of(page)
    assert sessions, f"{path.name} has no sessions"
    if any(session.command.startswith("cc ") for session in sessions) and shutil.which("cc") is None:
        pytest.skip("no C compiler: install gcc or clang")
    for session in (x for x in sessions if x.command not in LONG):
        printed = run(session.command, folder)
        same = agree(printed, session.expected)
        assert same, f"{path.name}:{session.line}: $ {session.command}\n" + "\n".join(printed)
        assert not any("Traceback" in line for line in printed)


def test_there_are_examples() -> None:
    assert {path.parent.name for path in EXAMPLES} >= {"time-to-collision", "traffic"}


def test_the_book_notices_a_difference(tmp_path: Path) -> None:
    [session] = sessions_of("```console\n$ echo one; exit 3\none\n[exit 3]\n```\n")
    assert run(session.command, tmp_path) == list(session.expected) == ["one", "[exit 3]"]
    assert not matches("two", "one")
    assert not matches("one more", "one")
    assert matches("one more", "one…")
