"""Pages against what their commands do: sessions, figures, pictures; and the pages put right."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from console import agree, files_of, rewritten, sessions_of
from findings.figures import Difference, Picture, Statement, compare, exits_said
from findings.results import ROOT, Results


@dataclass(frozen=True)
class Wrong:
    """A place in a file where the text is not what comes out."""

    file: str
    line: int
    said: str
    found: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}\n  text:   {self.said}\n  output: {self.found}"


@dataclass(frozen=True)
class Sessions:
    """All console sessions of a page; ``beside`` are files that they use."""

    page: str
    beside: tuple[Path, ...] = ()

    @property
    def commands(self) -> tuple[str, ...]:
        return tuple(session.command for session in sessions_of((ROOT / self.page).read_text("utf-8")))


Item = Sessions | Statement | Picture


def check_sessions(item: Sessions, results: Results, update: bool) -> list[Wrong]:
    path = ROOT / item.page
    page = path.read_text("utf-8")
    sessions = sessions_of(page)
    printed = results.session(item.commands, files_of(page), item.beside)
    wrong = [
        Wrong(item.page, session.line, f"$ {session.command}", "\n          ".join(lines))
        for session, lines in zip(sessions, printed, strict=True)
        if not agree(lines, session.expected)
    ]
    if wrong and update:
        by_line = {session.line: lines for session, lines in zip(sessions, printed, strict=True)}
        path.write_text(rewritten(page, by_line), "utf-8")
    return wrong


def check_statement(item: Statement, results: Results, update: bool) -> list[Wrong]:
    outcome = results.ask(item.commands)
    texts = {name: (ROOT / name).read_text("utf-8") for name in (item.data or item.page, item.page)}
    shown, page = texts[item.data or item.page], texts[item.page]
    found = {name: list[Difference]() for name in texts}
    found[item.data or item.page] += [d for x in item.figures for d in compare(x, shown, outcome)]
    found[item.page] += _exits(page, item.named or item.commands[-1], outcome.exit)
    for name, differences in found.items():
        if differences and update:
            (ROOT / name).write_text(_put_right(texts[name], differences), "utf-8")
    return [
        Wrong(name, _line_of(texts[name], d), d.said, f"{d.found}   ($ {item.commands[-1]})")
        for name, differences in found.items()
        for d in differences
    ]


def check_picture(item: Picture, results: Results, update: bool) -> list[Wrong]:
    outcome = results.ask(item.commands)
    made = outcome.folder / item.made(outcome)
    if not made.is_file():
        return [Wrong(item.file, 0, "a picture", f"{made.name} is not written by $ {item.commands[-1]}")]
    if (ROOT / item.file).is_file() and made.read_bytes() == (ROOT / item.file).read_bytes():
        return []
    if update:
        (ROOT / item.file).write_bytes(made.read_bytes())
    return [Wrong(item.file, 0, "a picture", f"another one: {made}")]


def _exits(page: str, command: str, code: int) -> Iterable[Difference]:
    """A command that a page names with no exit code ends with 0; another code stands behind it."""
    said = exits_said(page, command)
    if not said:
        yield Difference(f"`{command}`", "the page does not name this command")
    for stated, place in said:
        if stated != code:
            yield Difference(f" (exit {stated})", f" (exit {code})" if code else "", place, True)


def _put_right(page: str, differences: Sequence[Difference]) -> str:
    placed = [(d.place.begin, d.place.end, d.found) for d in differences if d.mendable]
    for begin, end, found in sorted(placed, reverse=True):
        page = page[:begin] + found + page[end:]
    return page


def _line_of(page: str, difference: Difference) -> int:
    return page.count("\n", 0, difference.place.begin) + 1
