"""Titles of the schemas of this extension's JSON files."""

from collections.abc import Mapping

from roadproof.extensions.maps import answer

TITLES: Mapping[type, str] = {
    answer.MapData: "roadproof road --json: the roads of a map",
}
