"""Titles of the schemas of this extension's JSON files."""

from collections.abc import Mapping

from roadproof.extensions.drivers.preventable.boundary_file import BoundaryFile
from roadproof.extensions.drivers.preventable.data import PreventableData

TITLES: Mapping[type, str] = {
    PreventableData: (
        "roadproof preventable --json: from which initial values a driver prevents a collision"
    ),
    BoundaryFile: "NAME.json in a folder of answers: where on the lines of a plate a formula holds",
}
