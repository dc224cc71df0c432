"""Questions about whole sets of scenarios, for those who write definitions."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Surveys of sets of scenarios: redundancy, gaps, classes, limits",
    audience="researchers",
    page="docs/how-to/surveys.md",
    needs=("traffic",),
    functions={
        "redundancy": "redundancies:redundancy",
        "coverage": "covering:coverage",
        "classify": "classifying:classify",
        "explore": "exploring:explore",
        "ask": "surveying:ask",
    },
    questions={
        "classify": "classify.question:ClassifyQuestion",
        "coverage": "coverage.question:CoverageQuestion",
        "explore": "explore.question:ExploreQuestion",
        "redundancy": "redundancy:RedundancyQuestion",
    },
    answers={
        "classify": "classifying:Classifications",
        "coverage": "covering:Coverages",
        "explore": "exploring:Explorations",
        "redundancy": "redundancies:Redundancies",
    },
    pictures={"order": "report.order_picture:draw_answer", "overlap": "report.overlap_picture:draw_answer"},
    schemas=("schemas:TITLES",),
)
