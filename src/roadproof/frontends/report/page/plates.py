"""Plates of driver models: where a collision is unpreventable, drawn, with the drives beside the boundary."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.drivers.manoeuvres import MANOEUVRES, Quantity
from roadproof.drivers.models import MODELS
from roadproof.drivers.words import legend
from roadproof.evidence.answers.plates import Index, Plate
from roadproof.evidence.codec import read
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import counts, evidence_of, folded, verdict
from roadproof.frontends.report.page.results import Result
from roadproof.frontends.report.preventable import COLOURS, measured
from roadproof.world.units import UNITS

_WIDE, _HIGH, _LEFT, _BELOW = 300.0, 190.0, 34.0, 28.0  # of a plate in px, and the room for its numbers


def plates(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """Each choice of fixed values as a picture with all its models, then plates and lemmas with evidence."""
    index = read(Index, result.data, result.name)
    found, along, across = index.plates, index.along, index.across
    known = MANOEUVRES[index.manoeuvre].quantities
    groups: dict[tuple[tuple[str, str], ...], list[Plate]] = {}
    for x in found:
        groups.setdefault(tuple(sorted(x.fixed.items())), []).append(x)
    pictures = [_picture(_told(known, dict(of)), here, known, along, across) for of, here in groups.items()]
    parts: list[Content] = [
        tag("p", counts(x.verdict for x in found)),
        _legend(found),
        tag("div", *pictures, class_="plates"),
    ]
    parts.append(
        tag(
            "p",
            f"Filled is what is unpreventable; {_label(known, across[0])} over {_label(known, along[0])}.",
            class_="faint",
        )
    )
    fixed = {name for x in found for name in x.fixed}
    symbols = [x for name, x in known.items() if name in {along[0], across[0], *fixed}]
    parts.append(tag("p", f"{legend(symbols)}.", class_="faint"))
    parts += [_plate(x, known, result, context) for x in found]
    for lemma in index.lemmas:
        inside: list[Content] = [tag("p", lemma.title), tag("p", tag("code", lemma.claim))]
        inside += evidence_of(result, context, certificate=lemma.certificate)
        parts.append(folded((verdict(lemma.verdict), " lemma ", tag("b", lemma.name)), *inside))
    return joined(parts)


def _legend(found: Sequence[Plate]) -> Markup:
    named = dict.fromkeys(x.model for x in found)
    return tag("p", joined([tag("b", _title(x), style=f"color:{_colour(x)}") for x in named], " · "))


def _title(model: str) -> str:
    return MODELS[model].title if model in MODELS else model


def _colour(model: str) -> str:
    return COLOURS.get(model, "#555555")


def _told(known: Mapping[str, Quantity], values: Mapping[str, str]) -> str:
    return ", ".join(f"{name} = {_measured(known, name, value)}" for name, value in values.items())


def _measured(known: Mapping[str, Quantity], name: str, value: str) -> str:
    return measured(known[name], Fraction(value)) if name in known else value


@dataclass(frozen=True)
class _Frame:
    """Where values are in a picture: those along a line from left to right, those of lines upwards."""

    along: tuple[float, float]
    across: tuple[float, float]

    def x(self, value: float) -> float:
        low, high = self.along
        return round(_LEFT + (value - low) / (high - low) * (_WIDE - _LEFT), 2)

    def y(self, value: float) -> float:
        low, high = self.across
        return round((_HIGH - _BELOW) * (1 - (value - low) / (high - low or 1)), 2)


def _picture(
    title: str,
    found: Sequence[Plate],
    known: Mapping[str, Quantity],
    along: Sequence[str],
    across: Sequence[str],
) -> Markup:
    """The plates of one choice of fixed values over each other, as SVG."""
    low, high = (float(Fraction(x)) for x in along[1:])
    rows = [float(Fraction(line.at)) for x in found for line in x.lines] or [0.0, 1.0]
    frame = _Frame((low, high), (min(rows), max(rows)))
    edge = {"x": _LEFT, "y": 0, "width": _WIDE - _LEFT, "height": _HIGH - _BELOW}
    told = title or "the plate"
    drawn = tag(
        "svg",
        *(part for x in found for part in _areas(x, frame)),
        tag("rect", **edge, fill="none", class_="frame"),
        _number(known, along[0], low, _LEFT, _HIGH - 16, "start"),
        _number(known, along[0], high, _WIDE, _HIGH - 16, "end"),
        _number(known, across[0], frame.across[0], _LEFT - 3, _HIGH - _BELOW, "end"),
        _number(known, across[0], frame.across[1], _LEFT - 3, 9, "end"),
        tag("text", _label(known, along[0]), x=(_LEFT + _WIDE) / 2, y=_HIGH - 4, text_anchor="middle"),
        viewBox=f"0 0 {_WIDE:g} {_HIGH:g}",
        class_="plate",
        role="img",
        aria_label=f"{told}: where a collision is unpreventable",
    )
    return tag("figure", tag("figcaption", told), drawn)


def _areas(plate: Plate, frame: _Frame) -> Iterator[Markup]:
    """What is unpreventable on each line, and, where lines are exact, its first and last ends joined."""
    colour, stepped = _colour(plate.model), bool(plate.stepped)
    thick = 1.2 if stepped else (_HIGH - _BELOW) / max(1, len(plate.lines) - 1)
    edges: tuple[list[str], list[str]] = ([], [])
    for line in plate.lines:
        middle = frame.y(float(Fraction(line.at)))
        top, bottom = max(0.0, middle - thick / 2), min(_HIGH - _BELOW, middle + thick / 2)
        spans = [(float(a.near), float(b.near)) for a, b in line.unpreventable]
        for begin, end in spans:
            width = max(0.4, frame.x(end) - frame.x(begin))
            place = {"x": frame.x(begin), "y": round(top, 2), "height": round(bottom - top, 2)}
            yield tag("rect", **place, width=round(width, 2), fill=colour, fill_opacity="0.15")
        for points, value in zip(edges, (spans[0][0], spans[-1][1]) if spans else (), strict=False):
            if frame.along[0] < value < frame.along[1]:
                points.append(f"{frame.x(value)},{middle}")
    for points in () if stepped else edges:
        yield tag("polyline", points=" ".join(points), fill="none", stroke=colour)


def _unit(known: Mapping[str, Quantity], name: str) -> tuple[str, float]:
    unit = known[name].unit if name in known else "unitless"
    return unit, float(UNITS[unit][0])


def _label(known: Mapping[str, Quantity], name: str) -> str:
    return f"{name} [{_unit(known, name)[0]}]"


def _number(
    known: Mapping[str, Quantity], name: str, value: float, x: float, y: float, anchor: str
) -> Markup:
    return tag("text", f"{value / _unit(known, name)[1]:.4g}", x=x, y=y, text_anchor=anchor)


def _plate(x: Plate, known: Mapping[str, Quantity], result: Result, context: PageContext) -> Markup:
    """A plate: its formula, some of what it says in words, a drive on each side."""
    fixed = _told(known, x.fixed)
    inside: list[Content] = [tag("p", tag("code", x.formula))]
    inside += [tag("p", note) for note in (x.stepped, x.motion, x.reason) if note]
    rows = [
        (line.at, "; ".join(f"{a.near:g} to {b.near:g}" for a, b in line.unpreventable) or "nowhere")
        for line in x.lines
    ]
    inside.append(folded(("lines, in SI units",), table(("at", "unpreventable"), rows)))
    for y in x.shown:
        said = _told(known, {k: v for k, v in y.at.items() if k in known})
        inner: list[Content] = [tag("p", y.reason)] if y.reason else []
        inner += [tag("p", tag("code", y.formula))]
        inner += evidence_of(result, context, y.drive)
        inside.append(folded((verdict(y.verdict), f" {y.side}: {said}"), *inner))
    name = f" {_title(x.model)}{fixed and f'; {fixed}'}"
    return folded((verdict(x.verdict), tag("b", name)), *inside)
