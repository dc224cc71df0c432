"""Which command makes which figure of which page: ``statements.toml``, and the pages with sessions.

``{}`` stands where a figure is, on the page and in the output. A source ``= NAME KEYS`` is a function of
``readings``; KEYS, with commas between them, are the parts of its result that are meant.
"""

import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path

from findings import readings
from findings.checking import Sessions
from findings.figures import Figures, Outcome, Picture, Source, Statement
from findings.results import ROOT

SESSIONS = (
    *map(Sessions, ("README.md", "docs/reference/language.md")),
    *(
        Sessions(
            f"examples/{name}/README.md",
            tuple(p for p in sorted((ROOT / "examples" / name).iterdir()) if p.name != "README.md"),
        )
        for name in ("motion", "time-to-collision", "traffic")
    ),
)


def _source(text: str) -> Source:
    return partial(_read, *text[2:].partition(" ")[::2]) if text.startswith("= ") else text


def _read(name: str, keys: str, outcome: Outcome) -> object:
    result = getattr(readings, name)(outcome)
    if not keys:
        return result
    numbered = isinstance(result, tuple) or int in map(type, result)
    parts = tuple(result[int(key) if numbered else key] for key in keys.split(","))
    return parts if len(parts) > 1 else parts[0]


def _made(text: str) -> Callable[[Outcome], str]:
    return lambda outcome: str(_read(text[2:], "", outcome)) if text.startswith("= ") else text


_PAGES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
PICTURES = tuple(Picture(x["file"], tuple(x["commands"]), _made(x["made"])) for x in _PAGES.pop("picture"))
STATEMENTS = tuple(
    Statement(
        page,
        tuple(x.pop("commands")),
        tuple(Figures(said, _source(source)) for said, source in x.pop("figures", ())),
        **x,
    )
    for page, statements in _PAGES.items()
    for x in statements
)
