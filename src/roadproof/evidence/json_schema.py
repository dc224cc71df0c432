"""JSON Schemas of answers, derived from their definitions (``evidence.codec``)."""

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from enum import StrEnum
from fractions import Fraction
from types import NoneType, UnionType
from typing import Literal, Union, get_args, get_origin

from roadproof.evidence.codec import ABSENT, LACKING, Doc, Field, Rule, bare, fields_of, notes_of
from roadproof.evidence.strict import Json, JsonObject
from roadproof.reasons import Reason
from roadproof.runtime.records import dataclass

DRAFT = "https://json-schema.org/draft/2020-12/schema"
COMMON = "common.json"
_NAMES: Mapping[object, str] = {
    str: "string",
    Reason: "string",
    int: "integer",
    float: "number",
    bool: "boolean",
}


@dataclass(frozen=True)
class Shared:
    """The last note of a type that several answers share: its name among the definitions of common.json."""

    name: str


@dataclass(frozen=True)
class Plain:
    """A value that Python holds as plain JSON: the type that describes it."""

    kind: object


@dataclass(frozen=True)
class Other:
    """A file of evidence is named, or stands here itself: the schemas of which it has one."""

    schemas: tuple[str, ...]


@dataclass(frozen=True)
class Whole:
    """Evidence stands here itself: its schema."""

    schema: str


def schema_of(kind: type, name: str, title: str) -> JsonObject:
    """Return the schema of a file ``name`` that a definition describes."""
    below = {x.__name__: x for x in _definitions(kind, set()) if x is not kind}
    definitions: JsonObject = {_called(x): _object(below[x]) for x in sorted(below)}
    made: JsonObject = {"$schema": DRAFT, "$id": name, "title": title, **_object(kind)}
    return made | ({"$defs": definitions} if below else {})


def tagged_schema(kinds: tuple[type, ...], name: str, title: str) -> JsonObject:
    """The schema of a file of one of several kinds, of which ``schema`` says which."""
    below = {_called(x.__name__): x for kind in kinds for x in _definitions(kind, set())}
    words = [word for kind in kinds for word in get_args(fields_of(kind)[0].type)]
    return {
        "$schema": DRAFT,
        "$id": name,
        "title": title,
        "properties": {"schema": {"enum": words}},
        "oneOf": [_plain(kind) for kind in kinds],
        "$defs": {called: _object(below[called]) for called in sorted(below)},
    }


def shared_schemas(kinds: Mapping[str, object]) -> JsonObject:
    """The definitions of common.json, of types by name, and those that they are made of."""
    every = [x for kind in kinds.values() for x in _definitions(kind, set())]
    shared = {_shape(kind) for kind in kinds.values() if is_dataclass(_shape(kind))}
    below = {_called(x.__name__): _object(x) for x in every if x not in shared}
    made = below | {name: _shared_schema(kind) for name, kind in kinds.items()}
    return dict(sorted(made.items()))


def _shape(kind: object) -> object:
    """The type that describes a value, without its annotation."""
    return next((bare(x.kind) for x in notes_of(kind) if isinstance(x, Plain)), bare(kind))


def _shared_schema(kind: object) -> JsonObject:
    inner = _shape(kind)
    if not (is_dataclass(inner) and isinstance(inner, type)):
        return _inline(kind, {})
    told = [x.text for x in notes_of(kind) if isinstance(x, Doc)]
    return _object(inner) | ({"description": told[-1]} if told else {})


def _definitions(kind: object, seen: set[object]) -> Iterator[type]:
    """A definition and those below it, each once; shared ones are left out."""
    inner = _shape(kind)
    if is_dataclass(inner) and isinstance(inner, type):
        if inner in seen:
            return
        seen.add(inner)
        yield inner
        for x in fields_of(inner):
            if not _shared(x.notes):
                yield from _definitions(x.type, seen)
        return
    for x in get_args(inner):
        if not _shared(notes_of(x)):
            yield from _definitions(x, seen)


def _object(kind: type) -> JsonObject:
    """The schema of a definition: an object that has its fields and no others."""
    every = fields_of(kind)
    required: list[Json] = [x.key for x in every if x.is_written and not x.has(LACKING)]
    return {
        "type": "object",
        **_told(kind.__doc__ or ""),
        "required": required,
        "additionalProperties": False,
        "properties": {x.key: _of_field(x) for x in every},
    }


def _told(text: str) -> JsonObject:
    return {"description": " ".join(text.split())} if text else {}


def _of_field(field: Field) -> JsonObject:
    """The schema of a field; one that is left out is never null."""
    inner = bare(field.type)
    if field.is_written or field.default is ABSENT or get_origin(inner) not in (Union, UnionType):
        return _schema(field.type)
    return _schema(next(x for x in get_args(inner) if x is not NoneType))


def _schema(kind: object) -> JsonObject:
    """The schema of a type: a reference where it is shared, with what is said of it here."""
    notes = notes_of(kind)
    shared = _shared(notes)
    if shared is None:
        return _inline(kind, {})
    own = notes[notes.index(shared) + 1 :]
    told = [x.text for x in own if isinstance(x, Doc)]
    return {"$ref": f"{COMMON}#/$defs/{shared.name}", **({"description": told[-1]} if told else {})}


def _shared(notes: tuple[object, ...]) -> Shared | None:
    return next((x for x in notes if isinstance(x, Shared)), None)


def _inline(kind: object, made: JsonObject) -> JsonObject:
    made |= _plain(_shape(kind))
    told = [y for x in notes_of(kind) for y in ((*notes_of(x.kind), x) if isinstance(x, Plain) else (x,))]
    for note in told:
        match note:
            case Doc(text):
                made |= {"description": text}
            case Rule():
                made |= _facets(note, made.get("type"))
            case Whole(schema):
                made = {"$ref": schema, **made}
            case Other(schemas):
                file: Json = {"$ref": "#/$defs/file"}
                each: list[Json] = [{"$ref": x} for x in schemas]
                made = {"anyOf": [{"type": "null"}, file, *each], **made}
    return made


def _facets(rule: Rule, kind: object) -> JsonObject:
    least = {"array": "minItems", "object": "minProperties"}.get(str(kind), "minLength")
    found: JsonObject = {"pattern": rule.pattern} if rule.pattern else {}
    found |= {"minimum": rule.minimum} if rule.minimum is not None else {}
    found |= {} if rule.most is None else {least.replace("min", "max"): rule.most}
    found |= {"uniqueItems": True} if rule.unique else {}
    return found | ({least: rule.least} if rule.least else {})


def _plain(kind: object) -> JsonObject:
    if kind in _NAMES:
        return {"type": _NAMES[kind]}
    if kind is Fraction:
        return {"$ref": f"{COMMON}#/$defs/rational"}
    if kind is object:
        return {}
    if is_dataclass(kind) and isinstance(kind, type):
        return {"$ref": f"#/$defs/{_called(kind.__name__)}"}
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return {"enum": [*map(str, kind)]}
    origin, inside = get_origin(kind), get_args(kind)
    if origin is Literal:
        words = [str(x) if isinstance(x, StrEnum) else x for x in inside]
        return {"const": words[0]} if len(words) == 1 else {"enum": words}
    if origin is tuple and Ellipsis not in inside:
        every: list[Json] = [_schema(x) for x in inside]
        alike = every == every[:1] * len(every)
        items: JsonObject = {"items": every[0]} if alike else {"prefixItems": every}
        return {"type": "array", **items, "minItems": len(every), "maxItems": len(every)}
    if origin is tuple:
        return {"type": "array", "items": _schema(inside[0])}
    if origin in (Union, UnionType):
        several: list[Json] = [_schema(x) for x in inside if x is not NoneType]
        return {"anyOf": [{"type": "null"}, *several]} if NoneType in inside else {"oneOf": several}
    rules = [x.pattern for x in notes_of(inside[0]) if isinstance(x, Rule)]
    names: JsonObject = {"propertyNames": {"pattern": rules[0]}} if rules else {}
    return {"type": "object", **names, "additionalProperties": _schema(inside[1])}


def _called(name: str) -> str:
    """``PairAnswer`` as ``pair_answer``."""
    return "".join(f"_{x.lower()}" if x.isupper() else x for x in name).lstrip("_")
