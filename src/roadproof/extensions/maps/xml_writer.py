"""XML as exports write it: attributes in the order given, decimals without exponent."""

import re
import xml.etree.ElementTree as ElementTree

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


def document(root: Element) -> bytes:
    """An XML file in UTF-8, indented."""
    ElementTree.indent(root)
    made: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return made + b"\n"
