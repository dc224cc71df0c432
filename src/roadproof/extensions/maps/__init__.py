"""Roads of maps, for those whose tests and recordings have one."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Roads of OpenDRIVE, Lanelet2 and CommonRoad maps",
    audience="testers",
    page="docs/how-to/maps.md",
    functions={"road": "roads:road", "stretches": "roads:stretches"},
    schemas=("schemas:TITLES",),
    roads={".xodr": "stretch:road_of", ".osm": "stretch:road_of", ".xml": "stretch:road_of"},
)
