"""The colours of pictures: vehicles, truth, danger and zones of roads."""

from collections.abc import Mapping

from roadproof.world.road import Zone

COLOURS = ("#1f5fbf", "#c8641e", "#4b8b3b", "#8a4fa3")
TRUE, DANGER = "#4b8b3b", "#b5202a"
ZONES: Mapping[Zone, str] = {"main": "main road", "merge": "merge zone", "depart": "departure zone"}
SHADES: Mapping[Zone, str] = {"main": "#ececec", "merge": "#d6e4f2", "depart": "#f4e4cc"}
