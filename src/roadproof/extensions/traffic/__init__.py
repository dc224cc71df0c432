"""Recordings of traffic: read, monitored, evaluated and simulated, for those who have data."""

from roadproof.extension import Extension

EXTENSION = Extension(
    title="Recorded and simulated traffic: monitors and evaluations",
    audience="researchers",
    page="docs/how-to/highd.md",
    needs=(
        "drivers",
        "maps",
    ),
    incubating=("recordings that are larger than memory",),
    functions={
        "monitor": "monitoring:monitor",
        "trace": "monitoring:trace",
        "evaluate": "evaluating:evaluate",
        "roads": "evaluating:roads",
        "convert": "converting:convert",
        "simulate": "simulating:simulate",
    },
    reserved={
        "formats": ("highD", "exiD", "inD", "NGSIM", "CSV", "Parquet", "converted"),
        "traces": (".csv", ".parquet", ".json"),
        "drives": (".json",),
    },
    schemas=("schemas:TITLES",),
    frames=("formats.table:frame_of",),
)
