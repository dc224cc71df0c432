"""Driver models in place of SV, for those who argue what a careful driver prevents."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Driver models, and collisions that they prevent",
    audience="safety cases",
    page="docs/explanation/preventable.md",
    needs=("kernel",),
    functions={"preventable": "preventing:preventable"},
    questions={"preventable": "preventable.question:PreventableQuestion"},
    answers={"preventable": "preventing:Plates"},
    drivers={
        "careful": "laws:CAREFUL",
        "r157": "laws:R157",
        "eu1426": "laws:EU1426",
        "rss": "laws:RSS",
        "fsm": "laws:FSM",
    },
    specifications={"driver": "driver.spec", "prevention": "prevention.spec"},
    modifiers={"prevention": "restriction:restriction_of"},
    headings={"prevention": "heading:PreventionHeading"},
    evidence={"roadproof/boundary/1": "preventable.boundary_file:BoundaryFile"},
    schemas=("schemas:TITLES",),
    words=("words:words_of_parts",),
    completions=dict.fromkeys(
        ("--preventable", "--unpreventable", "--drivers", "--model"), "completion:models"
    ),
    options={
        "witness": "options:Prevention",
        "overlap": "options:Prevention",
        "explore": "options:Prevention",
        "classify": "options:Prevention",
        "coverage": "options:PreventionOfDrives",
    },
)
