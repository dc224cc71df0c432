"""Writes requirements with their states as ReqIF 1.2, for a requirements tool."""

import hashlib
from collections.abc import Iterator, Mapping
from datetime import datetime

from roadproof.extensions.assurance.answers.trace import TraceData, TracedRequirement
from roadproof.extensions.assurance.requirements.requirement import FIELDS, SOURCE_FIELDS
from roadproof.extensions.maps.xml_writer import Element, document, element
from roadproof.runtime.version import VERSION

_NAMESPACE = "http://www.omg.org/spec/ReqIF/20110401/reqif.xsd"
_XHTML = "http://www.w3.org/1999/xhtml"
_STRINGS = (
    "ReqIF.ForeignID",
    "ReqIF.Name",
    "roadproof.state",
    *(f"roadproof.{x}" for x in (*SOURCE_FIELDS, *FIELDS)),
)
_TEXT = "ReqIF.Text"
_LONGEST = "100000"
# The schema of ReqIF 1.2 allows no other REQ-IF-VERSION than 1.0.


def as_reqif(answer: TraceData, title: str, changed: datetime, identifiers: Mapping[str, str]) -> bytes:
    """Return a .reqif file: an object for each requirement, its parents as relations, its links as
    attributes.

    ``changed``: the time of the last change of the requirements. ``identifiers``: object identifiers of
    requirements that came from ReqIF, which let a tool recognise them.
    """
    return _ReqifWriter(changed.isoformat(timespec="seconds"), identifiers).file(answer, title)


class _ReqifWriter:
    """Writes ReqIF elements that carry the time of the last change."""

    def __init__(self, changed: str, identifiers: Mapping[str, str]) -> None:
        self.changed = changed
        self.identifiers = identifiers

    def file(self, answer: TraceData, title: str) -> bytes:
        """Return the whole document."""
        content = element(
            "REQ-IF-CONTENT",
            element("DATATYPES", *self._datatypes()),
            element("SPEC-TYPES", *self._types()),
            element("SPEC-OBJECTS", *map(self._object, answer.requirements)),
            element("SPEC-RELATIONS", *self._relations(answer)),
            element("SPECIFICATIONS", self._specification(answer, title)),
        )
        root = element(
            "REQ-IF",
            element("THE-HEADER", self._header(title)),
            element("CORE-CONTENT", content),
            xmlns=_NAMESPACE,
            **{"xmlns:xhtml": _XHTML},
        )
        return document(root)

    def _header(self, title: str) -> Element:
        return element(
            "REQ-IF-HEADER",
            element("CREATION-TIME", text=self.changed),
            element("REQ-IF-TOOL-ID", text=f"roadproof {VERSION}"),
            element("REQ-IF-VERSION", text="1.0"),
            element("SOURCE-TOOL-ID", text="roadproof"),
            element("TITLE", text=title),
            IDENTIFIER=_id("header", title),
        )

    def _datatypes(self) -> Iterator[Element]:
        yield self._named("DATATYPE-DEFINITION-STRING", "type", "String", **{"MAX-LENGTH": _LONGEST})
        yield self._named("DATATYPE-DEFINITION-XHTML", "type", "XHTML")

    def _types(self) -> Iterator[Element]:
        strings = (self._definition("STRING", "String", name) for name in _STRINGS)
        attributes = element("SPEC-ATTRIBUTES", *strings, self._definition("XHTML", "XHTML", _TEXT))
        yield self._named("SPEC-OBJECT-TYPE", "type", "Requirement", attributes)
        yield self._named("SPEC-RELATION-TYPE", "type", "derived from")
        yield self._named("SPECIFICATION-TYPE", "type", "Requirements")

    def _definition(self, kind: str, datatype: str, name: str) -> Element:
        reference = element(f"DATATYPE-DEFINITION-{kind}-REF", text=_id("type", datatype))
        return self._named(f"ATTRIBUTE-DEFINITION-{kind}", "attribute", name, element("TYPE", reference))

    def _object(self, requirement: TracedRequirement) -> Element:
        links = {
            f"roadproof.{name}": "\n".join(
                " ".join(y.target.split()) for y in requirement.links if y.kind == kind
            )
            for name, kind in FIELDS.items()
        }
        attributes = {
            "ReqIF.ForeignID": requirement.id,
            "ReqIF.Name": requirement.title,
            "roadproof.edition": requirement.edition,
            "roadproof.clause": requirement.clause,
            "roadproof.state": str(requirement.state),
        } | links
        values = [_string(name, value) for name, value in attributes.items() if value]
        return self._identified(
            "SPEC-OBJECT",
            self._object_id(requirement.id),
            element("TYPE", element("SPEC-OBJECT-TYPE-REF", text=_id("type", "Requirement"))),
            element("VALUES", *values, _formatted(requirement.text)),
        )

    def _object_id(self, name: str) -> str:
        return self.identifiers.get(name) or _id("object", name)

    def _relations(self, answer: TraceData) -> Iterator[Element]:
        for x in answer.requirements:
            for parent in x.parents:
                yield self._identified(
                    "SPEC-RELATION",
                    _id("relation", f"{x.id}\n{parent}"),
                    element("TYPE", element("SPEC-RELATION-TYPE-REF", text=_id("type", "derived from"))),
                    element("SOURCE", element("SPEC-OBJECT-REF", text=self._object_id(x.id))),
                    element("TARGET", element("SPEC-OBJECT-REF", text=self._object_id(parent))),
                )

    def _specification(self, answer: TraceData, title: str) -> Element:
        places = (
            self._identified(
                "SPEC-HIERARCHY",
                _id("place", x.id),
                element("OBJECT", element("SPEC-OBJECT-REF", text=self._object_id(x.id))),
            )
            for x in answer.requirements
        )
        kind = element("TYPE", element("SPECIFICATION-TYPE-REF", text=_id("type", "Requirements")))
        return self._named("SPECIFICATION", "document", title, kind, element("CHILDREN", *places))

    def _named(self, tag: str, kind: str, name: str, *children: Element, **more: str) -> Element:
        made = self._identified(tag, _id(kind, name), *children, **more)
        made.set("LONG-NAME", name)
        return made

    def _identified(self, tag: str, identifier: str, *children: Element, **more: str) -> Element:
        return element(tag, *children, IDENTIFIER=identifier, **{"LAST-CHANGE": self.changed}, **more)


def _string(name: str, value: str) -> Element:
    reference = element("ATTRIBUTE-DEFINITION-STRING-REF", text=_id("attribute", name))
    return element("ATTRIBUTE-VALUE-STRING", element("DEFINITION", reference), **{"THE-VALUE": value})


def _formatted(text: str) -> Element:
    """Return a text as XHTML with its line breaks."""
    first, *lines = text.split("\n")
    block = element("xhtml:div", text=first)
    for line in lines:
        cut = element("xhtml:br")
        cut.tail = element("x", text=line).text
        block.append(cut)
    reference = element("ATTRIBUTE-DEFINITION-XHTML-REF", text=_id("attribute", _TEXT))
    return element("ATTRIBUTE-VALUE-XHTML", element("DEFINITION", reference), element("THE-VALUE", block))


def _id(kind: str, name: str) -> str:
    """Return a reproducible identifier of letters and digits, as XML requires."""
    return f"{kind}-{hashlib.sha256(name.encode()).hexdigest()[:20]}"
