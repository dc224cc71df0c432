"""Animations of drives, which come with an extension."""

from collections.abc import Mapping
from typing import Protocol

from roadproof.evidence.drive_file import DriveFile
from roadproof.extension import entries, import_entry
from roadproof.library.specification import Library


class Animation(Protocol):
    """An animation of drives in a format."""

    @property
    def ending(self) -> str:
        """The ending of its files, behind the name of the drive."""

    def need(self) -> None:
        """Raises ``MissingSolverError`` where a program that it needs is not there."""

    def draw(self, file: DriveFile, library: Library) -> bytes:
        """Return the file of a drive. Raises ``MissingSolverError``."""


def animations() -> Mapping[str, Animation]:
    """Return the animations by the name of their format."""
    return {name: import_entry(entry) for name, entry in entries("animations").items()}
