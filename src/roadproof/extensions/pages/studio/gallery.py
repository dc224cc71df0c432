"""The gallery of the studio: scenarios of the chosen spec set, each with a drive that is known without a
search.
"""

from dataclasses import asdict
from fractions import Fraction
from functools import lru_cache

import roadproof as rp
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.pages.studio.requests import Answer, StudioQuestion
from roadproof.extensions.pages.viewer_data import drive_view
from roadproof.frontends.api.definitions import Definitions, load
from roadproof.library.scenarios import numbers_of

GRAIN = Fraction(1, 2)  # s between distances of a small picture


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
