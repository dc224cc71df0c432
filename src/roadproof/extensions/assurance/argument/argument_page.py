"""An assurance case as one HTML page without scripts: states, open points, picture, evidence and limits."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element as XmlElement

from roadproof.extensions.assurance.answers.assurance import ArgumentElement, AssuranceData
from roadproof.extensions.assurance.argument.drawing import STYLE, as_markup
from roadproof.extensions.assurance.argument.layout import SHEETS, Rectangle, scale_on
from roadproof.extensions.pages.page.templates import Sign, page_style, render

_SIGNS: Mapping[str, Sign] = {
    "holds": Sign("✓", "proof"),
    "broken": Sign("✗", "against"),
    "undecided": Sign("?", "doubt"),
    "undeveloped": Sign("◇", "none"),
}


@dataclass(frozen=True)
class ArgumentRow:
    """An element in a nested list; ``depth`` counts levels below the top goal, ``again`` marks one whose
    support is listed above.
    """

    depth: int
    element: ArgumentElement
    again: bool


def argument_page(answer: AssuranceData, picture: XmlElement) -> str:
    """Return the HTML page of a checked case with its picture; printed on A3, in the orientation that fits
    the picture best.
    """
    width, height = (float(picture.get(x, "1")) for x in ("width", "height"))
    frame = Rectangle(0, 0, width, height)
    elements = {x.id: x for x in answer.elements}
    return render(
        "assurance.html",
        answer=answer,
        elements=elements,
        rows=[*_rows(answer.top, elements, 0, set())],
        solutions=[x for x in answer.elements if x.solution is not None],
        limited=[x for x in answer.elements if x.limits],
        picture=as_markup(picture),
        sheet=max(SHEETS, key=lambda x: scale_on(frame, x)),
        signs=_SIGNS,
        style=f"{page_style()}\n{STYLE}",
    )


def _rows(
    name: str, elements: Mapping[str, ArgumentElement], depth: int, seen: set[str]
) -> Iterator[ArgumentRow]:
    """Yield an element and all elements below it; support that was listed before is left out."""
    element, again = elements[name], name in seen
    yield ArgumentRow(depth, element, again)
    if again:
        return
    seen.add(name)
    for below in element.supported_by:
        yield from _rows(below, elements, depth + 1, seen)
