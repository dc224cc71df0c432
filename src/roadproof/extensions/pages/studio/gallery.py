"""The gallery: scenarios of the chosen spec set, each with a drive that is known without a search."""

from dataclasses import asdict
from fractions import Fraction
from functools import lru_cache

import roadproof as rp
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.pages.studio.requests import Answer, Ask
from roadproof.extensions.pages.viewer_data import shown_drive
from roadproof.frontends.api.definitions import Definitions, load
from roadproof.library.scenarios import numbers_of

GRAIN = Fraction(1, 2)  # s between distances of a small picture


def cards(ask: Ask) -> Answer:
    """Drives of ``scenarios`` in the set below the draft: the drive file, and what a small picture shows.

    A scenario without a known drive has none; numbers that the set does not have are left out.
    """
    return {"cards": list(_cards(ask.draft.base, ask.scenarios))}


@lru_cache(maxsize=64)
def _cards(set_name: str, numbers: tuple[int, ...]) -> tuple[Answer, ...]:
    home = load(set_name)
    there = [x for x in numbers_of(home.specification) if x in numbers]
    drives = rp.known_drives(there, home)
    return tuple(_card(home, number, drives.get(number)) for number in there)


def _card(home: Definitions, number: int, drive: JudgedDrive | None) -> Answer:
    formula = home.read(str(number)).text if drive is None else drive.file.formula
    told: Answer = {"number": number, "formula": formula}
    if drive is None:
        return told
    picture = shown_drive(drive.file, home.library, ("along",), GRAIN)
    return {**told, "drive": drive.as_data(), "picture": asdict(picture)}
