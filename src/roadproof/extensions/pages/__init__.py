"""Results to look at, for those who would rather look than read: pages, pictures, a studio."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Reports, viewer, atlas, studio and animations",
    audience="testers",
    needs=(
        "catalogue",
        "drivers",
        "exchange",
        "surveys",
        "traffic",
    ),
    incubating=("animations as GIF and MP4",),
    functions={"page": "reporting:page", "atlas": "atlas.atlas:atlas"},
    animations={"svg": "animation:SVG", "gif": "animation:GIF", "mp4": "animation:MP4"},
    completions={"--animate": "completion:formats"},
)
