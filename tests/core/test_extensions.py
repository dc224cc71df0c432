"""What extensions declare is what they are: imports, entries, labels."""

import json
import re
from pathlib import Path

import grimp
import pytest
from jsonschema import validate

from roadproof.extension import (
    AUDIENCES,
    GROUP,
    KEYS,
    OWN_NAMES,
    core,
    import_entry,
    imported,
    installed_extensions,
)
from roadproof.frontends.cli.main import main
from roadproof.frontends.cli.overview import COMMANDS

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("roadproof", cache_dir=None, exclude_type_checking_imports=True)


def home(module: str) -> str:
    """The extension of a module, or core."""
    return module.split(".")[2] if module.startswith(f"{GROUP}.") else "core"


def test_extensions_import_those_that_they_say(graph: grimp.ImportGraph) -> None:
    found: dict[str, set[str]] = {name: set() for name in installed_extensions()}
    for module in graph.modules:
        mine = home(module)
        others = {home(x) for x in graph.find_modules_directly_imported_by(module)} - {mine, "core"}
        if mine != "core":
            found[mine] |= others
        elif module != GROUP:
            assert not others, module
    assert found == {name: {*x.record.needs} for name, x in installed_extensions().items()}


def test_the_core_imports_no_extension_even_for_types() -> None:
    whole = grimp.build_graph("roadproof", cache_dir=None)
    core_modules = {x for x in whole.modules if home(x) == "core" and x != GROUP}
    wrong = {x for x in core_modules for y in whole.find_modules_directly_imported_by(x) if home(y) != "core"}
    assert "roadproof" in core_modules
    assert wrong == set()


@pytest.mark.parametrize("slot", KEYS)
def test_every_entry_is_there(slot: str) -> None:
    for x in (core(), *installed_extensions().values()):
        named = getattr(x.record, slot)
        if slot == "specifications":
            assert all((Path(x.folder) / file).is_file() for file in named.values())
            continue
        found = named.values() if isinstance(named, dict) else named
        assert all(import_entry(x.whole(entry)) is not None for entry in found)
        if slot in OWN_NAMES:
            assert all(imported(slot, name) is not None for name in named)


def test_every_extension_says_for_whom_it_is() -> None:
    for name, x in installed_extensions().items():
        assert x.record.audience in AUDIENCES
        doc = import_entry(f"{x.package}:__doc__")
        assert re.search(r"\bfor (those|whom)", doc), name


def test_commands_of_extensions_are_found() -> None:
    mine = {name for name, x in COMMANDS.items() if x.extension is not None}
    files = (ROOT / "src/roadproof/extensions").glob("*/commands/*.py")
    assert mine == {x.stem for x in files if x.stem != "__init__"}


def test_the_list_of_extensions_is_what_its_schema_says(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["extensions", "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    validate(said, json.loads((ROOT / "docs/schema/extensions.json").read_text("utf-8")))
    assert [x["name"] for x in said["extensions"]] == [*installed_extensions()]
    assert main(["extensions"]) == 0
    told = capsys.readouterr().out
    assert all(f"  {name} " in told for name in installed_extensions())
    assert "incubating: storyboards of OpenSCENARIO, which are run here" in told


def test_every_room_has_a_module() -> None:
    homes = [x.parent for x in (ROOT / "src/roadproof").glob("*/__init__.py")]
    assert homes
    assert [x.name for x in homes if not any(y.name != "__init__.py" for y in x.rglob("*.py"))] == []
