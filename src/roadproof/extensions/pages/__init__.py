"""Report pages, viewer, atlas, studio and animations, for those who want to see results."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Reports, viewer, atlas, studio and animations",
    audience="testers",
    page="docs/how-to/report.md",
    needs=(
        "catalogue",
        "drivers",
        "exchange",
        "maps",
        "surveys",
        "traffic",
    ),
    incubating=("animations as GIF and MP4",),
    functions={"page": "reporting:page", "atlas": "atlas.atlas:atlas"},
    pictures={"drive": "drive_picture:draw_drive"},
    pages={"catalogue": "reporting:folder_page"},
    animations={"svg": "animation:SVG", "gif": "animation:GIF", "mp4": "animation:MP4"},
    completions={"--animate": "completion:formats"},
    sections={
        "index": "page.standard_sections:CLAIMS",
        "verdicts": "page.standard_sections:CLAIMS",
        "witness": "page.standard_sections:WITNESS",
        "compare": "page.standard_sections:COMPARE",
        "overlap": "page.standard_sections:OVERLAP",
        "coverage": "page.standard_sections:COVERAGE",
        "classify": "page.standard_sections:CLASSIFY",
        "order": "page.standard_sections:ORDER",
        "redundancy": "page.standard_sections:REDUNDANCY",
        "explore": "page.standard_sections:EXPLORE",
        "monitor": "page.standard_sections:MONITOR",
        "catalogue": "page.standard_sections:CATALOGUE",
        "preventable": "page.standard_sections:PREVENTABLE",
        "traffic-results": "page.standard_sections:TRAFFIC",
        "list": "page.standard_sections:LIST",
        "show": "page.standard_sections:SHOW",
        "check": "page.standard_sections:CHECK",
    },
)
