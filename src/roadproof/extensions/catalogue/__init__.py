"""A report of what tests show and leave out, for those who keep a catalogue of them."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Catalogues of tests: what they show and what is missing",
    audience="testers",
    page="docs/how-to/catalogue.md",
    needs=(
        "drivers",
        "exchange",
        "surveys",
        "traffic",
    ),
    functions={"catalogue": "cataloguing:catalogue"},
    questions={"catalogue": "question:CatalogueQuestion"},
    answers={"catalogue": "cataloguing:CatalogueAnswer"},
    schemas=("schemas:TITLES",),
)
