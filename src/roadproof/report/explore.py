"""An exploration to look at: a strip or a map as text, the ends of what was found, and pictures."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from textwrap import wrap
from typing import Any, TypeAlias

from roadproof.report.figures import as_bytes, make_figure
from roadproof.report.overlap import COLOURS, SIGNS

MOST_NOTES = 2  # for one verdict on a map or strip; JSON has them all
# Reasons, each with its number.
Notes: TypeAlias = dict[str, int]
_MEANING = {
    "WITNESSED": "a drive, judged at this value",
    "IMPOSSIBLE": "proved for all values that there is none",
    "NONE-WITHIN": "none within the limits that are printed",
    "UNKNOWN": "not decided",
}


def as_text(data: Mapping[str, Any]) -> str:
    """One explored formula for the terminal: its map, the ends, the extremes; reasons as notes below."""
    notes: Notes = {}
    lines = [f"{_name(data)}, set {data['set']}"]
    if data["vary"]:
        lines += _strip(data) if len(data["vary"]) == 1 else _map(data)
        lines += _legend(data["values"], notes)
    if len(data["vary"]) == 1:
        lines += _ends(data, notes)
    for extreme in data["extremes"]:
        lines += _extreme(data, extreme, notes)
    for reason, number in notes.items():
        lines += wrap(reason, 108, initial_indent=f"  [{number}] ", subsequent_indent="      ")
    counts = [f"{data['searches']} searches"]
    if data["values"]:
        counts = [f"{len(data['values'])} values", *counts, f"{data['drives']} drives"]
    return "\n".join([*lines, f"  {', '.join(counts)} in {data['seconds']} s"])


def _name(data: Mapping[str, Any]) -> str:
    return str(data["formula"]) if data["scenario"] is None else f"scenario {data['scenario']}"


def _note(finding: Mapping[str, Any], notes: Notes) -> str:
    """The verdict with the number of the note that says why."""
    number = notes.setdefault(finding["reason"], len(notes) + 1)
    return f"{finding['verdict']} [{number}]"


def _strip(data: Mapping[str, Any]) -> list[str]:
    [knob] = data["vary"]
    signs = "".join(SIGNS[x["verdict"]] for x in data["values"])
    return [f"  {knob['name']}  {show(knob['low'])} {signs} {show(knob['high'])} {_unit(knob)}"]


def _map(data: Mapping[str, Any]) -> list[str]:
    """Rows are values of the second knob, the greatest on top; columns those of the first."""
    across, up = data["vary"]
    columns, rows = _axes(data["values"])
    signs = {tuple(x["at"]): SIGNS[x["verdict"]] for x in data["values"]}
    width = max(len(show(row)) for row in rows)
    lines = [f"  {up['name']} ({_unit(up)})"]
    for row in reversed(rows):
        lines.append(f"  {show(row):>{width}} |" + "".join(f" {signs[column, row]}" for column in columns))
    lines.append(" " * (width + 4) + f" {show(columns[0])} … {show(columns[-1])}  ")
    lines[-1] += f"{across['name']} ({_unit(across)})"
    return lines


def _legend(values: Sequence[Mapping[str, Any]], notes: Notes) -> list[str]:
    lines: list[str] = []
    for verdict, sign in SIGNS.items():
        here = [x for x in values if x["verdict"] == verdict]
        if here:
            unlike = list({x["reason"]: x for x in here if x["reason"]}.values())
            why = [_note(x, notes).partition(" ")[2] for x in unlike[:MOST_NOTES]]
            why += [f"and {len(unlike) - MOST_NOTES} more"] if len(unlike) > MOST_NOTES else []
            line = f"  {sign} {verdict}: {_MEANING[verdict]}, at {len(here)} of {len(values)} values"
            lines.append(" ".join([line, *why]))
    return lines


def _ends(data: Mapping[str, Any], notes: Notes) -> list[str]:
    """The least and the greatest value with a drive, and what is beyond; then gaps between."""
    [knob] = data["vary"]
    held = [x for x in data["values"] if x["verdict"] == "WITNESSED"]
    held += [x["held"] for x in data["boundaries"]]
    if not held:
        return []
    places = sorted({_at(x) for x in held})
    lines: list[str] = []
    for word, place, end in (("least", places[0], knob["low"]), ("greatest", places[-1], knob["high"])):
        line = f"  {word} {knob['name']} with a drive: {_value(place, knob)}"
        if place == Fraction(end):
            lines.append(f"{line}, the end of the range")
        else:
            boundary = next(x for x in data["boundaries"] if _at(x["held"]) == place)
            lines.append(f"{line}; {_beyond(boundary, knob, notes)}")
    for boundary in data["boundaries"]:
        if _inside(boundary, places):
            beside = _value(_at(boundary["held"]), knob)
            lines.append(f"  a gap beside {beside}; {_beyond(boundary, knob, notes)}")
    return lines


def _inside(boundary: Mapping[str, Any], places: Sequence[Fraction]) -> bool:
    return places[0] < _at(boundary["missed"]) < places[-1]


def _beyond(bracket: Mapping[str, Any], knob: Mapping[str, Any], notes: Notes) -> str:
    """What is known of the other side of a bracket."""
    missed, surely = bracket["missed"], bracket["surely"]
    text = f"at {_value(_at(missed), knob)} {_note(missed, notes)}"
    if surely is not None and surely["at"] != missed["at"]:
        text += f", at {_value(_at(surely), knob)} {_note(surely, notes)}"
    return text


def _extreme(data: Mapping[str, Any], extreme: Mapping[str, Any], notes: Notes) -> list[str]:
    """The best value reached, and what is beyond."""
    unit = {"unit": extreme["unit"]}
    when = f"when {extreme['when']}" if extreme["when"] else "at the start"
    head = f"  {extreme['sense']} {extreme['measure']} {when}"
    if extreme["point"]:
        [knob] = data["vary"]
        head += f", {knob['name']} = {show(extreme['point'][0])}"
    best = extreme["best"]
    if best is None:
        return [f"{head}: no drive: {_note(extreme['missed'], notes)}"]
    if extreme["endless"]:
        return [f"{head}: no end; the judged drive goes past {_value(_at(best), unit)}"]
    line = f"{head}: {_value(_at(best), unit)} on a judged drive"
    if extreme["missed"] is None:
        return [line]
    return [f"{line}; {_beyond(extreme, unit, notes)}"]


def draw_exploration(data: Mapping[str, Any]) -> dict[str, bytes]:
    """The strip or map of an exploration as ``{"png": …, "svg": …}``, measures over the strip.

    Raises ``InputError`` without matplotlib.
    """
    if len(data["vary"]) == 1:
        return _draw_strip(data)
    return _draw_map(data)


def _draw_strip(data: Mapping[str, Any]) -> dict[str, bytes]:
    [knob] = data["vary"]
    measured = [x for x in data["extremes"] if x["best"] is not None and x["point"]]
    figure, made = make_figure([2.6, 0.7, 0.7] if measured else [0.7, 0.7], width=8.0)
    *above, axes, below = made
    places = [_at(x) for x in data["values"]]
    edges = [float(x) for x in (places[0], *_edges(places, data["boundaries"]), places[-1])]
    for x, low, high in zip(data["values"], edges, edges[1:], strict=False):
        axes.fill((low, high, high, low), (0, 0, 1, 1), color=COLOURS[x["verdict"]], ec="white", lw=0.8)
    axes.plot([float(x) for x in places], [0.08] * len(places), color="#333333", marker="|", ms=6, lw=0)
    for boundary in data["boundaries"]:
        held, missed = float(_at(boundary["held"])), float(_at(boundary["missed"]))
        axes.plot((held, held), (0, 1), color="#222222", lw=1.4)
        axes.plot((missed, missed), (0, 1), color="#222222", ls=":", lw=1.4)
        axes.text(held, 1.05, f"{held:g}", fontsize=7, ha="center")
    axes.set_yticks([])
    axes.set_ylim(0, 1)
    axes.set_xlabel(f"{knob['name']}, {_unit(knob)}", fontsize=8)
    for one in (*above, axes):
        one.set_xlim(float(places[0]), float(places[-1]))
        one.tick_params(labelsize=7)
    if measured:
        _draw_measures(above[0], measured)
    _finish(figure, below, data)
    return as_bytes(figure)


def _edges(places: Sequence[Fraction], boundaries: Sequence[Mapping[str, Any]]) -> Iterator[Fraction]:
    """Where one colour ends: inside the bracket of a boundary, else halfway between two values."""
    brackets = [(_at(x["held"]), _at(x["missed"])) for x in boundaries]
    for low, high in pairwise(places):
        here = [pair for pair in brackets if all(low <= end <= high for end in pair)]
        yield sum(here[0] if here else (low, high), Fraction(0)) / 2


def _draw_measures(axes: Any, measured: Sequence[Mapping[str, Any]]) -> None:
    """Each measure over the knob: what judged drives reach, and the nearest value that none was found for."""
    for sense, colour in (("least", "#1f5fbf"), ("greatest", "#c8641e")):
        here = [x for x in measured if x["sense"] == sense and not x["endless"]]
        if not here:
            continue
        at = [float(Fraction(x["point"][0])) for x in here]
        reached = [float(_at(x["best"])) for x in here]
        axes.plot(at, reached, color=colour, marker="o", ms=3, lw=1, label=f"{sense}, on judged drives")
        beyond = [(p, float(_at(x["missed"]))) for p, x in zip(at, here, strict=True) if x["missed"]]
        axes.plot(*zip(*beyond, strict=True), color=colour, marker="x", ms=4, lw=0, label="not found")
    axes.set_ylabel(f"{measured[0]['measure']}, {measured[0]['unit']}", fontsize=7)
    axes.legend(fontsize=6, framealpha=0.6)


def _draw_map(data: Mapping[str, Any]) -> dict[str, bytes]:
    across, up = data["vary"]
    columns, rows = _axes(data["values"])
    found = {tuple(x["at"]): x for x in data["values"]}
    width = max(5.0, 0.42 * len(columns) + 2.5)
    figure, [axes, below] = make_figure([0.42 * len(rows) + 1.0, 0.7], width)
    for y, row in enumerate(rows):
        for x, column in enumerate(columns):
            cell = found[column, row]
            colour = COLOURS[cell["verdict"]]
            axes.fill((x, x + 1, x + 1, x), (y, y, y + 1, y + 1), color=colour, ec="white", lw=0.8)
            if cell["number"] is not None:
                axes.text(x + 0.5, y + 0.5, str(cell["number"]), fontsize=6, ha="center", va="center")
            held = cell["verdict"] == "WITNESSED"
            if x and held != (found[columns[x - 1], row]["verdict"] == "WITNESSED"):
                axes.plot((x, x), (y, y + 1), color="#222222", lw=1.6)
            if y and held != (found[column, rows[y - 1]]["verdict"] == "WITNESSED"):
                axes.plot((x, x + 1), (y, y), color="#222222", lw=1.6)
    axes.set_xlim(0, len(columns))
    axes.set_ylim(0, len(rows))
    axes.set_xticks([k + 0.5 for k in range(len(columns))], [show(c) for c in columns], fontsize=7)
    axes.set_yticks([k + 0.5 for k in range(len(rows))], [show(r) for r in rows], fontsize=7)
    axes.set_xlabel(f"{across['name']}, {_unit(across)}; numbers in cells tell drives apart", fontsize=8)
    axes.set_ylabel(f"{up['name']}, {_unit(up)}", fontsize=8)
    _finish(figure, below, data)
    return as_bytes(figure)


def _finish(figure: Any, below: Any, data: Mapping[str, Any]) -> None:
    """Title, and what colours mean."""
    present = {x["verdict"] for x in data["values"]}
    for verdict in (v for v in SIGNS if v in present):
        below.fill([], [], color=COLOURS[verdict], label=f"{verdict}: {_MEANING[verdict]}")
    below.legend(fontsize=6, loc="upper left", frameon=False)
    below.axis("off")
    figure.suptitle(f"{_name(data)[:100]}, set {data['set']}", fontsize=9)


def _axes(values: Sequence[Mapping[str, Any]]) -> tuple[list[str], list[str]]:
    """The values of the first and of the second knob, in order, as they are written."""
    columns = list(dict.fromkeys(x["at"][0] for x in values))
    return columns, list(dict.fromkeys(x["at"][1] for x in values))


def _at(finding: Mapping[str, Any]) -> Fraction:
    return Fraction(finding["at"][0])


def _value(value: Fraction, knob: Mapping[str, Any]) -> str:
    return f"{show(value)} {_unit(knob)}".rstrip()


def _unit(knob: Mapping[str, Any]) -> str:
    return "" if knob["unit"] == "unitless" else str(knob["unit"])


def show(value: Fraction | str) -> str:
    """A value in decimals, to six digits."""
    return f"{float(Fraction(value)):.6g}"
