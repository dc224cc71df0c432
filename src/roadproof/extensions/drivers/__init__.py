"""Driver models in place of SV, for those who argue what a careful driver prevents."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Driver models, and collisions that they prevent",
    audience="safety cases",
    needs=("kernel",),
    functions={"preventable": "preventing:preventable"},
    questions={"preventable": "preventable.question:PreventableQuestion"},
    answers={"preventable": "preventing:Plates"},
    modifiers={"prevention": "restriction:restriction_of"},
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
