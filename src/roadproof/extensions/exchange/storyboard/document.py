"""OpenSCENARIO files as trees in which parameters, expressions and catalogue entries are replaced.

``$name`` is the value of the nearest ParameterDeclaration above; ``${…}`` is an expression.
World positions of files whose description begins with ``CARLA:`` have y to the right, as in CARLA.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.distributions import (
    Values,
    check_constraints,
    numbered_scenario_path,
    read_distribution,
    split,
)
from roadproof.extensions.exchange.storyboard.expressions import replace_parameters
from roadproof.extensions.exchange.storyboard.harmless import HARMLESS
from roadproof.extensions.maps.xml_reader import Element, number_in, parts_not_read, read_xml, summary_of
from roadproof.runtime.records import dataclass

_OWNERS = ("ScenarioObject", "ManeuverGroup", "TrajectoryRef", "RouteRef")
"""Elements that may have a CatalogReference in place of an element that is written out."""
_FOLDERS = "CatalogLocations/*/Directory"
_TRUTHS = {"true": True, "1": True, "false": False, "0": False}


@dataclass(frozen=True)
class Document:
    """A file and, for each of its elements, where it is in the file.

    ``folder``: where it names other files from. ``distribution_note``: which scenario of a distribution it
    is, if any.
    ``references``: elements that entries of catalogues have replaced.
    """

    path: Path
    root: Element
    places: dict[Element, str]
    folder: Path
    distribution_note: str
    references: tuple[Element, ...] = ()

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
        child = node.find(way)
        if child is None:
            raise self.error(node, f"{way} is needed")
        return child

    def only(self, node: Element) -> Element:
        """The only element inside ``node``."""
        if len(node) != 1:
            raise self.error(node, f"it has {len(node)} elements; one is needed")
        node[0].note()
        return node[0]

    def flag(self, node: Element, name: str, default: bool = False) -> bool:
        """A truth value. Raises ``InputError`` for other texts."""
        text = node.get(name)
        if not text:
            return default
        if text not in _TRUTHS:
            raise self.error(node, f"{name}={text}: true or false is needed")
        return _TRUTHS[text]

    def pass_over(self, node: Element, name: str, value: str) -> None:
        """Count an attribute as read if it has the value that the reader supports; others are named."""
        if node.peek(name) == value:
            node.note(name)

    def left_out(self) -> tuple[str, ...]:
        """Parts of the file that were not read and that may have an effect, a line for each kind."""
        parts = [part for root in (self.root, *self.references) for part in parts_not_read(root, HARMLESS)]
        return summary_of(tuple(parts))


def open_document(path: Path) -> Document:
    """The file with its parameters and catalogues put in. Raises ``InputError``."""
    distribution_number = split(path)
    file, values, note = path, dict[str, str](), ""
    if distribution_number is not None:
        distribution = read_distribution(distribution_number[0])
        file, values = distribution.scenario, dict(distribution.values(distribution_number[1]))
        note = f"values: {', '.join(f'{x}={y}' for x, y in values.items())}; {distribution.note}"
    root = read_xml(file, "OpenSCENARIO")
    if root.find("Catalog") is not None:
        raise InputError(f"{path}: this is a catalogue, which has no storyboard; name a scenario")
    if root.find("ParameterValueDistribution") is not None:
        one = numbered_scenario_path(path, 1).name
        raise InputError(f"{path}: ParameterValueDistribution: name one of its scenarios, such as {one}")
    _assign_parameters(path, root, values)
    places = dict[Element, str]()
    _replace_parameters_below(path, root, {}, "", places)
    document = Document(path, root, places, file.parent, note)
    references = []
    for owner in [x for x in root.iter() if x.tag in _OWNERS]:
        reference = owner.find("CatalogReference")
        if reference is not None:
            owner.remove(reference)
            owner.append(_catalogue_entry(document, reference))
            references.append(reference)
    document = replace(document, references=tuple(references))
    header = root.find("FileHeader")
    if header is not None and header.get("description", "").startswith("CARLA:"):
        for place in root.iter("WorldPosition"):
            for name in ("y", "h"):
                if place.get(name):
                    place.set(name, repr(-document.number(place, name)))
    return document


def _assign_parameters(path: Path, root: Element, values: Values) -> None:
    """Set the parameters of a scenario to the values of a distribution. Raises ``InputError``."""
    declared = {
        (x.get("name") or "").lstrip("$"): x
        for x in root.findall("ParameterDeclarations/ParameterDeclaration")
    }
    for name, value in values.items():
        if name not in declared:
            raise InputError(f"{path}: the scenario declares no parameter {name}, which is varied")
        declared[name].set("value", value)


def _replace_parameters_below(
    path: Path, node: Element, values: Mapping[str, str], where: str, places: dict[Element, str]
) -> None:
    """Replace parameters below ``node``, and note where each element is."""
    name = node.peek("name") or node.peek("entityRef")
    places[node] = where = f"{where}/{node.tag}{f' {name}' if name else ''}" if where else node.tag
    for key, text in node.attrib.items():
        if "$" in text and key != "parameterRef" and node.tag != "ParameterDeclaration":
            try:
                node.set(key, replace_parameters(text, values))
            except ValueError as error:
                if key != "name":  # names may be texts with $ that no one refers to
                    raise InputError(f"{path}: {where}: {key}={text}: {error}") from None
    for declaration in node.findall("ParameterDeclarations/ParameterDeclaration"):
        declared = (declaration.get("name") or "").lstrip("$")
        value = declaration.get("value") or ""
        try:
            values = {**values, declared: replace_parameters(value, values)}
        except ValueError as error:
            raise InputError(f"{path}: {where}: parameter {declared}={value}: {error}") from None
        check_constraints(path, declaration, declared, values)
    for child in node:
        _replace_parameters_below(path, child, values, where, places)


def _catalogue_entry(document: Document, reference: Element) -> Element:
    """The element of a catalogue that a CatalogReference names."""
    catalog, name = (document.text(reference, x) for x in ("catalogName", "entryName"))
    arguments = {
        document.text(x, "parameterRef").lstrip("$"): document.text(x, "value")
        for x in reference.findall("ParameterAssignments/ParameterAssignment")
    }
    folders = _folders(document)
    for file in catalogues_of(document):
        for known in read_xml(file, "OpenSCENARIO").findall("Catalog"):
            entry = next((x for x in known if x.peek("name") == name), None)
            if known.get("name") == catalog and entry is not None:
                for declaration in entry.findall("ParameterDeclarations/ParameterDeclaration"):
                    declared = (declaration.get("name") or "").lstrip("$")
                    declaration.set("value", arguments.pop(declared, declaration.get("value") or ""))
                if arguments:
                    raise document.error(reference, f"{name} declares no parameter {', '.join(arguments)}")
                where = f"{document.places[reference]} {name}"
                _replace_parameters_below(file, entry, {}, where, document.places)
                return entry
    shown = ", ".join(map(str, folders)) or "CatalogLocations"
    raise document.error(reference, f"no {name} in a catalogue {catalog} in {shown}")


def _folders(document: Document) -> list[Path]:
    return [document.folder / document.text(x, "path") for x in document.root.findall(_FOLDERS)]


def catalogues_of(document: Document) -> tuple[Path, ...]:
    """Every file that an entry of a catalogue may be in, in the order in which they are read."""
    folders = dict.fromkeys(_folders(document))
    return tuple(x for folder in folders for x in _files(folder))


def _files(folder: Path) -> list[Path]:
    return [folder] if folder.suffix == ".xosc" else sorted(folder.glob("*.xosc"))
