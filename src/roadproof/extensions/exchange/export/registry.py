"""The formats that drives can be exported to; a new one is a file and a line here."""

from collections.abc import Callable, Mapping

from roadproof.extensions.exchange.export import commonroad, csv_files, highd, opendrive, openscenario
from roadproof.extensions.exchange.export.subject import Subject

FORMATS: Mapping[str, Callable[[Subject], dict[str, bytes]]] = {
    "openscenario": openscenario.files,
    "opendrive": opendrive.files,
    "commonroad": commonroad.files,
    "highd": highd.files,
    "csv": csv_files.files,
}
"""By name, what makes the files of a drive: their contents by name. Each raises ``InputError``."""


def numbers_in(name: str, subject: Subject) -> dict[str, int]:
    """What vehicles are called in a format, where names are numbers."""
    return commonroad.numbers(subject) if name == "commonroad" else subject.ids
