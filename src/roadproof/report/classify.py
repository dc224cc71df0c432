"""Classes of scenarios to look at: a table as text, and a picture of which scenarios make up which class."""

from collections.abc import Mapping, Sequence
from typing import Any

from roadproof.report.figures import as_bytes, make_figure

_DOT, _NO_DOT, _BAR, _DOUBT = "#1f5fbf", "#dddddd", "#3f7d4e", "#b5473c"


def as_table(data: Mapping[str, Any]) -> str:
    """A line for each thing that happens, its places added up; below it a line for each place."""
    happenings = _merged(data["classes"], "happens")
    shares = data["shares"]
    rows = [["class", "drives", *(["situations"] if shares else []), "what happens"]]
    for one in happenings:
        drives = f"{one['witnessed']} of {one['count']}"
        rows.append([one["name"], drives, *_share(one, shares), _told(one)])
    lines = _aligned(rows)
    places = _merged(data["classes"], "where")
    if len(places) > 1:
        rows = [["where", "drives", *(["situations"] if shares else [])]]
        rows += [
            [one["name"], f"{one['witnessed']} of {one['count']}", *_share(one, shares)] for one in places
        ]
        lines += ["", *_aligned(rows)]
    return "\n".join(lines)


def _merged(classes: Sequence[Mapping[str, Any]], by: str) -> list[dict[str, Any]]:
    """Classes of the same vehicles in which ``by`` is the same, or of all vehicles with the same place."""
    found: dict[object, dict[str, Any]] = {}
    for x in classes:
        happens = "_".join(map(str, x["happens"]))
        name = str(x["where"]) if by == "where" else f"class_{happens}"
        key = name if by == "where" else (tuple(x["vehicles"]), name)
        empty = {"name": name, "witnessed": 0, "count": 0, "situations": 0, "of": {}}
        one = found.setdefault(key, empty | {k: x[k] for k in ("description", "happens", "vehicles")})
        one["witnessed"] += x["verdict"] == "WITNESSED"
        one["count"] += 1
        one["situations"] += x["situations"] or 0
        one["of"][str(len(x["vehicles"]))] = True
    return list(found.values())


def _told(one: Mapping[str, Any]) -> str:
    *most, last = map(str, one["happens"])
    return f"{', '.join(most)} and {last} together" if most else str(one["description"])


def _share(one: Mapping[str, Any], shares: Mapping[str, Any] | None) -> list[str]:
    """How many situations, and of those with as many vehicles how much."""
    if not shares:
        return []
    whole = sum(shares["situations"].get(number, 0) for number in one["of"])
    part = f"{100 * one['situations'] / whole:5.1f} %" if whole else "      -"
    return [f"{one['situations']:>5} {part}"]


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(x.ljust(width) for x, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def draw_classes(data: Mapping[str, Any], title: str) -> dict[str, bytes]:
    """Bars of how often each class occurs, over dots for the scenarios in it: ``{"png": …, "svg": …}``.

    Places are added up: a column is something that happens, a row a scenario but for its road sector.
    """
    columns = _merged(data["classes"], "happens")
    numbers = sorted({number for one in columns for number in one["happens"]})
    shares = data["shares"]
    heights = [2.2, 0.24 * len(numbers) + 0.6] if shares else [0.24 * len(numbers) + 0.6]
    figure, axes = make_figure(heights, width=max(5.0, 1.6 + 0.42 * len(columns)))
    if shares:
        _bars(axes[0], columns, shares)
    below = axes[-1]
    for x, one in enumerate(columns):
        rows = [numbers.index(number) for number in one["happens"]]
        colour = _DOT if one["witnessed"] == one["count"] else _DOUBT
        below.scatter([x] * len(numbers), range(len(numbers)), s=28, color=_NO_DOT, zorder=1)
        below.plot([x, x], [min(rows), max(rows)], color=colour, lw=1.6, zorder=2)
        below.scatter([x] * len(rows), rows, s=34, color=colour, zorder=3)
    names = [one["name"].removeprefix("class_").replace("_", "+") for one in columns]
    below.set_xticks(range(len(columns)), names, fontsize=7, rotation=45)
    below.set_yticks(range(len(numbers)), [f"scenario {number}" for number in numbers], fontsize=7)
    below.set_ylim(len(numbers) - 0.4, -0.6)
    below.set_xlim(-0.6, len(columns) - 0.4)
    below.tick_params(length=0)
    for side in ("top", "right", "bottom", "left"):
        below.spines[side].set_visible(False)
    figure.suptitle(title, fontsize=9)
    return as_bytes(figure)


def _bars(axes: Any, columns: Sequence[Mapping[str, Any]], shares: Mapping[str, Any]) -> None:
    counts = [one["situations"] for one in columns]
    axes.bar(range(len(columns)), counts, color=_BAR, width=0.7)
    for x, count in enumerate(counts):
        axes.text(x, count, str(count), fontsize=7, ha="center", va="bottom")
    axes.set_xlim(-0.6, len(columns) - 0.4)
    axes.set_ylim(0, 1.12 * max([1, *counts]))
    axes.set_xticks([])
    axes.set_ylabel("situations", fontsize=7)
    axes.tick_params(labelsize=7)
    axes.set_title(f"on {shares['source']}", fontsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
