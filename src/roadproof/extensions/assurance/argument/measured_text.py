"""Estimates the width of texts without a font file, and wraps texts at a width.

The widths are those of DejaVu Sans, rounded up. System fonts are narrower, so texts never leave their box.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

_BY_WIDTH = {
    0.3: "'IJijl", 0.35: " ,./:;\\|", 0.4: "()-[]ft", 0.45: "!r", 0.5: '"*_`', 0.55: "?csz", 0.6: "FLkvxy",
    0.65: "$0123456789EPSTYabdeghnopqu{}", 0.7: "ABCKRVXZ", 0.75: "NU", 0.8: "&DGHOQ", 0.85: "#+<=>^w~",
    0.9: "M", 1.0: "%@Wm",
}  # fmt: skip
_WIDTHS = {letter: width for width, letters in _BY_WIDTH.items() for letter in letters}
_OTHER = 1.0  # em, of letters that the table lacks
_BOLD = 1.2
_SEAMS = "/_-."
"""Characters after which a long word may be divided."""
FONT, LEADING = 12.0, 15.0


def width_of(text: str, bold: bool = False) -> float:
    """Return an upper bound of the width of a text in px."""
    em = sum(_WIDTHS.get(letter, _OTHER) for letter in text)
    return em * FONT * (_BOLD if bold else 1)


def wrap(text: str, most: float) -> list[str]:
    """Return the lines of a text, each at most ``most`` px wide; longer words are divided."""
    lines = [""]
    for word in text.split():
        for piece in _pieces(word, most):
            joined = f"{lines[-1]} {piece}".strip()
            if width_of(joined) <= most:
                lines[-1] = joined
            else:
                lines.append(piece)
    return [x for x in lines if x]


def _pieces(word: str, most: float) -> Iterator[str]:
    while width_of(word) > most:
        fits = [k for k in range(1, len(word)) if k == 1 or width_of(word[:k]) <= most]
        cut = next((k for k in reversed(fits) if word[k - 1] in _SEAMS), fits[-1])
        yield word[:cut]
        word = word[cut:]
    yield word


@dataclass(frozen=True)
class TextBlock:
    """Lines of centred text below a first line in bold."""

    head: str
    lines: Sequence[str]

    @property
    def width(self) -> float:
        """The width in px."""
        return max([width_of(self.head, bold=True), *map(width_of, self.lines)])

    @property
    def height(self) -> float:
        """The height in px."""
        return LEADING * (1 + len(self.lines))
