"""No text of a drawing is wider than its box."""

import re

import pytest

from documents.drawings import DRAWINGS


@pytest.mark.parametrize("name", DRAWINGS)
def test_texts_fit_into_their_boxes(name: str) -> None:
    box: tuple[float, float, float, float] | None = None
    texts = 0
    for line in DRAWINGS[name]().splitlines():
        if found := re.match(r'<rect class="\w+" x="(\S+)" y="(\S+)" width="(\S+)" height="54"', line):
            x, y, width = map(float, found.groups())
            box = (x, y, x + width, y + 54)
        elif found := re.match(r'<text x="(\S+)" y="(\S+)" font-size="14" .*>(.*)</text>', line):
            assert box is not None
            half = 3.9 * len(found[3])  # a letter is about 7.6 pixels wide
            assert box[0] + half <= float(found[1]) <= box[2] - half, found[3]
            assert box[1] + 12 <= float(found[2]) <= box[3], found[3]
            texts += 1
    assert texts > 8
