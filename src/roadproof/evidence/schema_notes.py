"""Notes on types and fields that the JSON Schemas of answers show (``make generated``)."""

from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class SharedType:
    """The last note of a type that several answers share: its name among the definitions of common.json."""

    name: str


@dataclass(frozen=True)
class DescribedBy:
    """A note on a field that Python holds as plain JSON: the type that describes it."""

    kind: object


@dataclass(frozen=True)
class FileOrEvidence:
    """A note on a field with a file of evidence, or the evidence itself: its possible schemas."""

    schemas: tuple[str, ...]


@dataclass(frozen=True)
class EvidenceSchema:
    """A note on a field that holds evidence itself: its schema."""

    schema: str
