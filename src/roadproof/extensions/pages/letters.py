"""The widths of texts in drawings, so that labels are placed without a font being read.

The widths are those of Helvetica (Adobe's font metrics), which Arial and Liberation Sans share. A little is
added for other fonts.
"""

from roadproof.extensions.pages.shapes import LETTER

_FIRST = 32
_WIDTHS = (
    *(278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278),
    *(556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556),
    *(1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778),
    *(667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556),
    *(333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556),
    *(556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584),
)
"""The widths of the characters from the space to the tilde, in thousandths of their size."""
_WIDEST, _ROOM = 1000, 1.08


def width_of(text: str, size: float = LETTER) -> float:
    """Return how wide a text is at most, in px; ``size``: that of its letters in px."""
    codes = (ord(x) - _FIRST for x in text)
    thousandths = sum(_WIDTHS[k] if 0 <= k < len(_WIDTHS) else _WIDEST for k in codes)
    return thousandths / 1000 * size * _ROOM


def lines_of(text: str, width: float, size: float = LETTER) -> list[str]:
    """Return a text in lines of at most that width (px), broken at spaces, or within words that are wider."""
    lines, line = list[str](), ""
    for word in text.split():
        joined = f"{line} {word}" if line else word
        if width_of(joined, size) <= width:
            line = joined
            continue
        lines += [line] if line else []
        while width_of(word, size) > width:
            count = next(k for k in range(len(word), 0, -1) if k == 1 or width_of(word[:k], size) <= width)
            lines.append(word[:count])
            word = word[count:]
        line = word
    return [*lines, line] if line else lines


def fitted(text: str, width: float, size: float = LETTER) -> str:
    """Return a text that is at most so wide (px): of a wider one the beginning, and an ellipsis."""
    if width_of(text, size) <= width:
        return text
    count = next((k for k in range(len(text), 0, -1) if width_of(f"{text[:k]}…", size) <= width), 0)
    return f"{text[:count]}…"
