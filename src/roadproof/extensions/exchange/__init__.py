"""Files of other tools, for those who use them: drives and monitors are written, recordings are read."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Drives, recordings and monitors for other tools",
    audience="testers",
    needs=(
        "maps",
        "traffic",
    ),
    incubating=("storyboards of OpenSCENARIO, which are run here",),
    functions={"export": "exporting:export", "compile": "compiling:compile"},
    completions=dict.fromkeys(("--to", "--format"), "completion:formats"),
    formats=("commonroad:FORMAT", "openscenario:FORMAT", "osi:FORMAT"),
    traces={".xosc": "openscenario:read_scenario"},
    drives={".xosc": "storyboard.drives:read_storyboard_drive"},
)
