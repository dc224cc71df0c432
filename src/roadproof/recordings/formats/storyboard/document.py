"""OpenSCENARIO files as trees in which parameters, expressions and catalogue entries are replaced.

``$name`` is the value of the nearest ParameterDeclaration above; ``${…}`` is an expression (ASAM
OpenSCENARIO XML 1.3, section 9.1) with numbers, pi, parameters, + - * / %, and functions (``_FUNCTIONS``).
World positions of files whose description begins with ``CARLA:`` have y to the right, as in CARLA.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.recordings.formats.storyboard.distributions import Values, numbered, read_distribution, split
from roadproof.runtime.xml_reader import Element, number_in, read_xml

_NAME = re.compile(r"\$([A-Za-z_][\w.]*)")
_LONGEST = 500
"""Characters of an expression."""
_OPERATORS: Mapping[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Mod: math.fmod,
}
_FUNCTIONS: Mapping[str, Callable[..., float]] = {
    "round": lambda x: float(math.floor(x + 0.5)),
    "floor": lambda x: float(math.floor(x)),
    "ceil": lambda x: float(math.ceil(x)),
    "sqrt": math.sqrt,
    "pow": math.pow,
    "abs": abs,
    "sign": lambda x: float((x > 0) - (x < 0)),
    "min": lambda x, y: min(x, y),
    "max": lambda x, y: max(x, y),
}
_OWNERS = ("ScenarioObject", "ManeuverGroup", "TrajectoryRef", "RouteRef")
"""Elements that may have a CatalogReference in place of an element that is written out."""
_FOLDERS = "CatalogLocations/*/Directory"


def expression_value(text: str) -> float:
    """The value of an expression of numbers. Raises ``ValueError``."""
    if len(text) > _LONGEST:
        raise ValueError(f"more than {_LONGEST} characters")
    try:
        value = _evaluate(ast.parse(text.strip(), mode="eval").body)
    except (SyntaxError, ArithmeticError, TypeError, RecursionError, MemoryError) as error:
        raise ValueError(f"no expression that can be evaluated ({error})") from None
    if not math.isfinite(value):
        raise ValueError("no finite number")
    return value


def _evaluate(node: ast.expr) -> float:
    match node:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_evaluate(left), _evaluate(right))
        case ast.Name(id="pi"):
            return math.pi
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_evaluate(operand)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _evaluate(operand)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*map(_evaluate, args))
    raise ValueError(f"{ast.unparse(node)[:80]} is not supported in an expression")


def replaced(text: str, values: Mapping[str, str]) -> str:
    """``text`` with parameters and expressions replaced. Raises ``ValueError``."""

    def value_of(found: re.Match[str]) -> str:
        if found[1] not in values:
            raise ValueError(f"there is no parameter {found[1]}")
        return values[found[1]]

    if text.startswith("${") and text.endswith("}"):
        return repr(expression_value(_NAME.sub(value_of, text[2:-1])))
    return _NAME.sub(value_of, text)


@dataclass(frozen=True)
class Document:
    """A file and, for each of its elements, where it is in the file.

    ``folder``: where it names other files from. ``told``: which scenario of a distribution it is, if any.
    """

    path: Path
    root: Element
    places: dict[Element, str]
    folder: Path
    told: str

    def error(self, node: Element, rule: str) -> InputError:
        """The error for an element that breaks a rule."""
        return InputError(f"{self.path}: {self.places.get(node, node.tag)}: {rule}")

    def text(self, node: Element, name: str) -> str:
        value = node.get(name)
        if not value:
            raise self.error(node, f"{name} is needed")
        return value

    def number(self, node: Element, name: str, default: float | None = None) -> float:
        if default is not None and node.get(name) is None:
            return default
        return number_in(self.path, self.text(node, name), f"{self.places.get(node, node.tag)}: {name}")

    def child(self, node: Element, way: str) -> Element:
        """The element at ``way`` below ``node``."""
        found = node.find(way)
        if found is None:
            raise self.error(node, f"{way} is needed")
        return found

    def only(self, node: Element) -> Element:
        """The only element inside ``node``."""
        if len(node) != 1:
            raise self.error(node, f"it has {len(node)} elements; one is needed")
        return node[0]


def open_document(path: Path) -> Document:
    """The file with its parameters and catalogues put in. Raises ``InputError``."""
    of_distribution = split(path)
    file, values, told = path, dict[str, str](), ""
    if of_distribution is not None:
        distribution = read_distribution(of_distribution[0])
        file, values = distribution.scenario, dict(distribution.values(of_distribution[1]))
        told = f"values: {', '.join(f'{x}={y}' for x, y in values.items())}; {distribution.told}"
    root = read_xml(file, "OpenSCENARIO")
    if root.find("Catalog") is not None:
        raise InputError(f"{path}: this is a catalogue, which has no storyboard; name a scenario")
    if root.find("ParameterValueDistribution") is not None:
        one = numbered(path, 1).name
        raise InputError(f"{path}: ParameterValueDistribution: name one of its scenarios, such as {one}")
    _assign(path, root, values)
    places = dict[Element, str]()
    _put_values(path, root, {}, "", places)
    document = Document(path, root, places, file.parent, told)
    for owner in [x for x in root.iter() if x.tag in _OWNERS]:
        reference = owner.find("CatalogReference")
        if reference is not None:
            owner.remove(reference)
            owner.append(_entry(document, reference))
    header = root.find("FileHeader")
    if header is not None and header.get("description", "").startswith("CARLA:"):
        for place in root.iter("WorldPosition"):
            for name in ("y", "h"):
                if place.get(name):
                    place.set(name, repr(-document.number(place, name)))
    return document


def _assign(path: Path, root: Element, values: Values) -> None:
    """Give the parameters of a scenario the values of a distribution. Raises ``InputError``."""
    declared = {
        (x.get("name") or "").lstrip("$"): x
        for x in root.findall("ParameterDeclarations/ParameterDeclaration")
    }
    for name, value in values.items():
        if name not in declared:
            raise InputError(f"{path}: the scenario declares no parameter {name}, which is varied")
        declared[name].set("value", value)


def _put_values(
    path: Path, node: Element, values: Mapping[str, str], where: str, places: dict[Element, str]
) -> None:
    """Replace parameters below ``node``, and note where each element is."""
    name = node.get("name") or node.get("entityRef")
    places[node] = where = f"{where}/{node.tag}{f' {name}' if name else ''}" if where else node.tag
    for key, text in node.attrib.items():
        if "$" in text and key != "parameterRef" and node.tag != "ParameterDeclaration":
            try:
                node.set(key, replaced(text, values))
            except ValueError as error:
                if key != "name":  # names may be texts with $ that no one refers to
                    raise InputError(f"{path}: {where}: {key}={text}: {error}") from None
    for declaration in node.findall("ParameterDeclarations/ParameterDeclaration"):
        declared = (declaration.get("name") or "").lstrip("$")
        value = declaration.get("value") or ""
        try:
            values = {**values, declared: replaced(value, values)}
        except ValueError as error:
            raise InputError(f"{path}: {where}: parameter {declared}={value}: {error}") from None
    for child in node:
        _put_values(path, child, values, where, places)


def _entry(document: Document, reference: Element) -> Element:
    """The element of a catalogue that a CatalogReference names."""
    catalog, name = (document.text(reference, x) for x in ("catalogName", "entryName"))
    given = {
        document.text(x, "parameterRef").lstrip("$"): document.text(x, "value")
        for x in reference.findall("ParameterAssignments/ParameterAssignment")
    }
    folders = [document.folder / document.text(x, "path") for x in document.root.findall(_FOLDERS)]
    for file in (file for folder in dict.fromkeys(folders) for file in _files(folder)):
        for known in read_xml(file, "OpenSCENARIO").findall("Catalog"):
            entry = next((x for x in known if x.get("name") == name), None)
            if known.get("name") == catalog and entry is not None:
                for declaration in entry.findall("ParameterDeclarations/ParameterDeclaration"):
                    declared = (declaration.get("name") or "").lstrip("$")
                    declaration.set("value", given.get(declared, declaration.get("value") or ""))
                where = f"{document.places[reference]} {name}"
                _put_values(file, entry, {}, where, document.places)
                return entry
    shown = ", ".join(map(str, folders)) or "CatalogLocations"
    raise document.error(reference, f"no {name} in a catalogue {catalog} in {shown}")


def _files(folder: Path) -> list[Path]:
    return [folder] if folder.suffix == ".xosc" else sorted(folder.glob("*.xosc"))
