"""Requirements, assurance arguments and bundles for auditors, for those who sign a safety case.

All of them rest on evidence that is checked again.
"""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Requirements, safety cases, bundles and build results",
    audience="safety cases",
    page="docs/how-to/assurance.md",
    needs=(
        "catalogue",
        "drivers",
        "maps",
        "pages",
    ),
    incubating=("requirements in the formats of StrictDoc and Doorstop",),
    functions={
        "assurance": "assuring:assurance",
        "bundle": "bundling:bundle",
        "requirements": "tracing:requirements",
        "requirement_changes": "tracing:requirement_changes",
    },
    build_results={"junit": "build_results.junit:junit", "sarif": "build_results.sarif:sarif"},
    schemas=("schemas:TITLES",),
    checked_files={".toml": "checking:check_case"},
    options=dict.fromkeys(
        (
            "prove",
            "check",
            "witness",
            "evaluate",
            "coverage",
            "catalogue",
            "preventable",
            "falsify",
            "resimulate",
        ),
        "options:BuildResultOptions",
    ),
    sections={"trace": "page:TRACE"},
)
