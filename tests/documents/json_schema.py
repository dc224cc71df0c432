"""JSON Schemas of answers, derived from their definitions (``evidence.codec``)."""

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from enum import StrEnum
from fractions import Fraction
from types import NoneType, UnionType
from typing import Literal, Union, get_args, get_origin

from roadproof.evidence.codec import ABSENT, LACKING, Doc, Field, Rule, bare, fields_of, notes_of
from roadproof.evidence.schema_notes import DescribedBy, EvidenceSchema, FileOrEvidence, SharedType
from roadproof.evidence.strict import Json, JsonObject
from roadproof.reasons import Reason

DRAFT = "https://json-schema.org/draft/2020-12/schema"
COMMON = "common.json"
_NAMES: Mapping[object, str] = {
    str: "string",
    Reason: "string",
    int: "integer",
    float: "number",
    bool: "boolean",
}


def schema_of(kind: type, name: str, title: str) -> JsonObject:
    """Return the JSON Schema of a definition, with the file ``name`` as its ``$id``."""
    definitions_below = {x.__name__: x for x in _definitions(kind, set()) if x is not kind}
    definitions: JsonObject = {
        _snake_case(x): _object_schema(definitions_below[x]) for x in sorted(definitions_below)
    }
    schema: JsonObject = {"$schema": DRAFT, "$id": name, "title": title, **_object_schema(kind)}
    return schema | ({"$defs": definitions} if definitions_below else {})


def tagged_schema(kinds: tuple[type, ...], name: str, title: str) -> JsonObject:
    """Return the JSON Schema of a file of one of several kinds; its field ``schema`` says which."""
    below = {_snake_case(x.__name__): x for kind in kinds for x in _definitions(kind, set())}
    words = [word for kind in kinds for word in get_args(fields_of(kind)[0].type)]
    return {
        "$schema": DRAFT,
        "$id": name,
        "title": title,
        "properties": {"schema": {"enum": words}},
        "oneOf": [_type_schema(kind) for kind in kinds],
        "$defs": {called: _object_schema(below[called]) for called in sorted(below)},
    }


def shared_schemas(kinds: Mapping[str, object]) -> JsonObject:
    """Return the definitions of common.json: shared types by name, and the definitions that they use."""
    definitions = [x for kind in kinds.values() for x in _definitions(kind, set())]
    shared = {_shape(kind) for kind in kinds.values() if is_dataclass(_shape(kind))}
    definitions_below = {_snake_case(x.__name__): _object_schema(x) for x in definitions if x not in shared}
    schemas = definitions_below | {name: _shared_schema(kind) for name, kind in kinds.items()}
    return dict(sorted(schemas.items()))


def _shape(kind: object) -> object:
    """Return the type that describes a value, without its annotations."""
    return next((bare(x.kind) for x in notes_of(kind) if isinstance(x, DescribedBy)), bare(kind))


def _shared_schema(kind: object) -> JsonObject:
    inner = _shape(kind)
    if not (is_dataclass(inner) and isinstance(inner, type)):
        return _inline(kind, {})
    descriptions = [x.text for x in notes_of(kind) if isinstance(x, Doc)]
    return _object_schema(inner) | ({"description": descriptions[-1]} if descriptions else {})


def _definitions(kind: object, seen: set[object]) -> Iterator[type]:
    """Yield a definition and all that it uses, each once, without shared ones."""
    inner = _shape(kind)
    if is_dataclass(inner) and isinstance(inner, type):
        if inner in seen:
            return
        seen.add(inner)
        yield inner
        for field in fields_of(inner):
            if not _shared_type(field.notes):
                yield from _definitions(field.type, seen)
        return
    for argument in get_args(inner):
        if not _shared_type(notes_of(argument)):
            yield from _definitions(argument, seen)


def _object_schema(kind: type) -> JsonObject:
    """Return the schema of a definition: an object with its fields and no others."""
    fields_of_kind = fields_of(kind)
    required: list[Json] = [x.key for x in fields_of_kind if x.is_written and not x.has(LACKING)]
    return {
        "type": "object",
        **_description(kind.__doc__ or ""),
        "required": required,
        "additionalProperties": False,
        "properties": {x.key: _field_schema(x) for x in fields_of_kind},
    }


def _description(text: str) -> JsonObject:
    return {"description": " ".join(text.split())} if text else {}


def _field_schema(field: Field) -> JsonObject:
    """Return the schema of a field; one that may be left out is never null."""
    inner = bare(field.type)
    if field.is_written or field.default is ABSENT or get_origin(inner) not in (Union, UnionType):
        return _schema(field.type)
    return _schema(next(x for x in get_args(inner) if x is not NoneType))


def _schema(kind: object) -> JsonObject:
    """Return the schema of a type: if it is shared, a reference and the notes that follow it."""
    notes = notes_of(kind)
    shared = _shared_type(notes)
    if shared is None:
        return _inline(kind, {})
    own_notes = notes[notes.index(shared) + 1 :]
    descriptions = [x.text for x in own_notes if isinstance(x, Doc)]
    return {
        "$ref": f"{COMMON}#/$defs/{shared.name}",
        **({"description": descriptions[-1]} if descriptions else {}),
    }


def _shared_type(notes: tuple[object, ...]) -> SharedType | None:
    return next((x for x in notes if isinstance(x, SharedType)), None)


def _inline(kind: object, described: JsonObject) -> JsonObject:
    described |= _type_schema(_shape(kind))
    notes = [
        y for x in notes_of(kind) for y in ((*notes_of(x.kind), x) if isinstance(x, DescribedBy) else (x,))
    ]
    for note in notes:
        match note:
            case Doc(text):
                described |= {"description": text}
            case Rule():
                described |= _facets(note, described.get("type"))
            case EvidenceSchema(schema):
                described = {"$ref": schema, **described}
            case FileOrEvidence(schemas):
                file: Json = {"$ref": f"{COMMON}#/$defs/file"}
                each: list[Json] = [{"$ref": x} for x in schemas]
                described = {"anyOf": [{"type": "null"}, file, *each], **described}
    return described


def _facets(rule: Rule, kind: object) -> JsonObject:
    least = {"array": "minItems", "object": "minProperties"}.get(str(kind), "minLength")
    facets: JsonObject = {"pattern": rule.pattern} if rule.pattern else {}
    facets |= {"minimum": rule.minimum} if rule.minimum is not None else {}
    facets |= {} if rule.most is None else {least.replace("min", "max"): rule.most}
    facets |= {"uniqueItems": True} if rule.unique else {}
    return facets | ({least: rule.least} if rule.least else {})


def _type_schema(kind: object) -> JsonObject:
    if kind in _NAMES:
        return {"type": _NAMES[kind]}
    if kind is Fraction:
        return {"$ref": f"{COMMON}#/$defs/rational"}
    if kind is object:
        return {}
    if is_dataclass(kind) and isinstance(kind, type):
        return {"$ref": f"#/$defs/{_snake_case(kind.__name__)}"}
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return {"enum": [*map(str, kind)]}
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Literal:
        words = [str(x) if isinstance(x, StrEnum) else x for x in arguments]
        return {"const": words[0]} if len(words) == 1 else {"enum": words}
    if origin is tuple and Ellipsis not in arguments:
        item_schemas: list[Json] = [_schema(x) for x in arguments]
        uniform = item_schemas == item_schemas[:1] * len(item_schemas)
        items: JsonObject = {"items": item_schemas[0]} if uniform else {"prefixItems": item_schemas}
        return {"type": "array", **items, "minItems": len(item_schemas), "maxItems": len(item_schemas)}
    if origin is tuple:
        return {"type": "array", "items": _schema(arguments[0])}
    if origin in (Union, UnionType):
        members: list[Json] = [_schema(x) for x in arguments if x is not NoneType]
        return {"anyOf": [{"type": "null"}, *members]} if NoneType in arguments else {"oneOf": members}
    rules = [x.pattern for x in notes_of(arguments[0]) if isinstance(x, Rule)]
    names: JsonObject = {"propertyNames": {"pattern": rules[0]}} if rules else {}
    return {"type": "object", **names, "additionalProperties": _schema(arguments[1])}


def _snake_case(name: str) -> str:
    """Return ``pair_answer`` for ``PairAnswer``."""
    return "".join(f"_{x.lower()}" if x.isupper() else x for x in name).lstrip("_")
