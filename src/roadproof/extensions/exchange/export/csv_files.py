"""A drive as CSV, with its road."""

from roadproof.extensions.exchange.export.subject import ExportSubject
from roadproof.extensions.traffic.road_file import road_toml
from roadproof.frontends.report.samples import csv_of


def files(subject: ExportSubject) -> dict[str, bytes]:
    """NAME.csv, and NAME_road.toml, the road that it is on. Raises ``InputError``."""
    table = csv_of(subject.file, subject.rate)
    road = road_toml(subject.file.road)
    return {f"{subject.name}.csv": table.encode(), f"{subject.name}_road.toml": road.encode()}
