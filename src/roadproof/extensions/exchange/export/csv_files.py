"""A drive as CSV, with its road."""

from roadproof.extensions.exchange.export.subject import Subject
from roadproof.frontends.report.samples import csv_of, road_toml


def files(subject: Subject) -> dict[str, bytes]:
    """NAME.csv, and NAME_road.toml, the road that it is on. Raises ``InputError``."""
    table = csv_of(subject.file, subject.rate)
    road = road_toml(subject.file.road)
    return {f"{subject.name}.csv": table.encode(), f"{subject.name}_road.toml": road.encode()}
