"""The gallery of the studio: scenarios of the chosen spec set, each with a drive that is known without a
search.
"""

import json
from dataclasses import asdict
from fractions import Fraction
from functools import cache, lru_cache
from importlib import resources

import roadproof as rp
from roadproof.evidence.codec import write
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.pages.studio.requests import Answer, StudioQuestion
from roadproof.extensions.pages.viewer_data import drive_view
from roadproof.frontends.api.definitions import Definitions, load
from roadproof.library.scenarios import numbers_of
from roadproof.library.words import words_of

GRAIN = Fraction(1, 2)  # s between distances of a small picture
SHIPPED, SHIPPED_SETS = "shipped_cards.json", ("base", "extA", "ext")


def cards(question: StudioQuestion) -> Answer:
    """Return a card for each of ``scenarios`` in the set below the draft: the drive file and a small picture.

    Scenarios without a known drive have neither; numbers that the set lacks are left out.
    """
    return {"cards": list(_cards(question.draft.base, question.scenarios))}


@lru_cache(maxsize=64)
def _cards(set_name: str, numbers: tuple[int, ...]) -> tuple[Answer, ...]:
    home = load(set_name)
    there = [x for x in numbers_of(home.specification) if x in numbers]
    drives = rp.known_drives(there, home)
    return tuple(_card(home, number, drives.get(number)) for number in there)


def _card(home: Definitions, number: int, drive: JudgedDrive | None) -> Answer:
    formula = home.read(str(number)).text if drive is None else drive.file.formula
    card: Answer = {"number": number, "formula": formula}
    if drive is None:
        return card
    picture = drive_view(drive.file, home.library, ("along",), GRAIN)
    return {**card, "drive": drive.as_data(), "picture": asdict(picture)}


@cache
def shipped_cards() -> dict[str, list[Answer]]:
    """Return the cards of each shipped set that the gallery shows before it has asked: words and pictures.

    They are of the shipped answers, made by ``make_shipped_cards``; the cards that the page asks for replace
    them.
    """
    text = resources.files("roadproof.extensions.pages.studio").joinpath(SHIPPED).read_text("utf-8")
    cards: dict[str, list[Answer]] = json.loads(text)
    return cards


def make_shipped_cards() -> str:
    """Return the text of the file of ``shipped_cards``, with numbers rounded as small pictures need them.

    It takes known answers, which ``ROADPROOF_KNOWN=off`` leaves out.
    """
    lines = []
    for set_name in SHIPPED_SETS:
        home = load(set_name)
        numbers = tuple(numbers_of(home.specification))
        drives = rp.known_drives(numbers, home)
        pictures = {x: _card(home, x, drives.get(x)).get("picture") for x in numbers}
        cards = [
            {**write(words_of(home.specification, x)), "picture": _rounded(pictures[x])} for x in numbers
        ]
        rows = ",\n".join(json.dumps(x, separators=(",", ":")) for x in cards)
        lines.append(f"{json.dumps(set_name)}: [\n{rows}\n]")
    return "{" + ",\n".join(lines) + "}\n"


def _rounded(data: object) -> object:
    """Return plain data with numbers of three decimals."""
    if isinstance(data, float):
        return round(data, 3)
    if isinstance(data, dict):
        return {name: _rounded(x) for name, x in data.items()}
    return [_rounded(x) for x in data] if isinstance(data, list | tuple) else data
