"""XML as exports write it: attributes in the order given, decimals without exponent."""

import re
import xml.etree.ElementTree as ElementTree
from decimal import Decimal
from fractions import Fraction

Element = ElementTree.Element
_ILLEGAL = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def element(tag: str, *children: Element, text: str = "", **attributes: str) -> Element:
    """An element with its attributes as they are given, its text, and its children."""
    made = Element(tag, {name: legal(value) for name, value in attributes.items()})
    made.text = legal(text) or None
    made.extend(children)
    return made


def legal(text: str) -> str:
    """``text`` with a question mark for what no XML file may hold (XML 1.0, 2.2)."""
    return _ILLEGAL.sub("?", text)


def decimal(value: Fraction | float) -> str:
    """The shortest decimal that is read as the same float, without exponent (as ``xs:decimal`` wants it).

    >>> decimal(Fraction(1, 40000000)), decimal(3.5), decimal(Fraction(7))
    ('0.000000025', '3.5', '7')
    """
    text = format(Decimal(repr(float(value) + 0.0)), "f")
    return text.rstrip("0").rstrip(".") if "." in text else text


def document(root: Element) -> bytes:
    """An XML file in UTF-8, indented."""
    ElementTree.indent(root)
    made: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return made + b"\n"
