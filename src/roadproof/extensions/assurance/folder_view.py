"""The view of a folder of answers as plain data."""

from collections.abc import Sequence
from pathlib import Path

from roadproof.evidence.strict import JsonObject
from roadproof.questions.checking import read_folder
from roadproof.questions.views import view_data


def folder_data(folder: Path, given: Sequence[Path] = ()) -> JsonObject:
    """Return the view of a folder of answers as plain data. Raises ``InputError``."""
    stored = read_folder(folder, given)
    return view_data(stored.question, stored.answers, Path())
