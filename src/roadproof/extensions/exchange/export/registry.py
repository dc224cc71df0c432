"""The formats that drives can be exported to; a new one is a file and a line here."""

from collections.abc import Callable, Mapping

from roadproof.extensions.exchange.export import commonroad, csv_files, highd, opendrive, openscenario
from roadproof.extensions.exchange.export.subject import ExportSubject

FORMATS: Mapping[str, Callable[[ExportSubject], dict[str, bytes]]] = {
    "openscenario": openscenario.files,
    "opendrive": opendrive.files,
    "commonroad": commonroad.files,
    "highd": highd.files,
    "csv": csv_files.files,
}
"""By name, what makes the files of a drive: their contents by name. Each raises ``InputError``."""


def vehicle_ids_in(name: str, subject: ExportSubject) -> dict[str, int]:
    """Return the ids of vehicles by name, for a format whose names are numbers."""
    return commonroad.vehicle_ids(subject) if name == "commonroad" else subject.ids
