"""Files of other tools, for those who use them: drives and monitors are written, recordings are read."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Drives, recordings and monitors for other tools",
    audience="testers",
    page="docs/how-to/interop.md",
    needs=(
        "encoding",
        "maps",
        "traffic",
    ),
    incubating=(
        "storyboards of OpenSCENARIO, which are run here",
        "problems of searches (mps, lp, smt2)",
    ),
    functions={
        "export": "exporting:export",
        "compile": "compiling:compile",
        "online_monitor": "watching:online_monitor",
    },
    completions=dict.fromkeys(("--to", "--format"), "completion:formats"),
    formats={"CommonRoad": "commonroad:FORMAT", "OpenSCENARIO": "openscenario:FORMAT", "OSI": "osi:FORMAT"},
    traces={".xosc": "openscenario:read_scenario"},
    drives={".xosc": "storyboard.drives:read_storyboard_drive"},
)
