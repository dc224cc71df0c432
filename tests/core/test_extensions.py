"""What extensions declare is what they are: imports, entries, labels."""

import json
import re
from inspect import signature
from pathlib import Path

import grimp
import pytest
from jsonschema import validate

from roadproof.extension import AUDIENCES, GROUP, Extension, added, entries, imported, installed, listed
from roadproof.frontends.cli.main import main
from roadproof.frontends.cli.overview import COMMANDS

ROOT = Path(__file__).parents[2]
_PLAIN = ("title", "audience", "label", "needs", "incubating")
SLOTS = [x for x in signature(Extension).parameters if x not in _PLAIN]


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("roadproof", cache_dir=None, exclude_type_checking_imports=True)


def home(module: str) -> str:
    """The extension of a module, or core."""
    return module.split(".")[2] if module.startswith(f"{GROUP}.") else "core"


def test_extensions_import_those_that_they_say(graph: grimp.ImportGraph) -> None:
    found: dict[str, set[str]] = {name: set() for name in installed()}
    for module in graph.modules:
        mine = home(module)
        others = {home(x) for x in graph.find_modules_directly_imported_by(module)} - {mine, "core"}
        if mine != "core":
            found[mine] |= others
        elif module != GROUP:
            assert not others, module
    assert found == {name: {*x.record.needs} for name, x in installed().items()}


@pytest.mark.parametrize("slot", SLOTS)
def test_every_entry_is_there(slot: str) -> None:
    for name in installed():
        named = getattr(installed()[name].record, slot)
        known = [x for key in named for x in added(slot, key)] if isinstance(named, dict) else listed(slot)
        assert all(imported(entry) is not None for entry in known)


def test_no_two_extensions_have_one_name_in_a_slot() -> None:
    for slot in SLOTS:
        if slot != "options":
            named = [getattr(x.record, slot) for x in installed().values()]
            keys = [key for x in named if isinstance(x, dict) for key in x]
            assert len(keys) == len({*keys}), slot
            assert {*entries(slot)} == {*keys} if keys else True


def test_every_extension_says_for_whom_it_is() -> None:
    for name, x in installed().items():
        assert x.record.audience in AUDIENCES
        doc = imported(f"{x.package}:__doc__")
        assert re.search(r"\bfor (those|whom)", doc), name


def test_commands_of_extensions_are_found() -> None:
    mine = {name for name, x in COMMANDS.items() if x.extension is not None}
    files = (ROOT / "src/roadproof/extensions").glob("*/commands/*.py")
    assert mine == {x.stem for x in files if x.stem != "__init__"}


def test_the_list_of_extensions_is_what_its_schema_says(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["extensions", "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    validate(said, json.loads((ROOT / "docs/schema/extensions.json").read_text("utf-8")))
    assert [x["name"] for x in said["extensions"]] == [*installed()]
    assert main(["extensions"]) == 0
    told = capsys.readouterr().out
    assert all(f"  {name} " in told for name in installed())
    assert "incubating: storyboards of OpenSCENARIO, which are run here" in told


def test_every_room_has_a_module() -> None:
    homes = [x.parent for x in (ROOT / "src/roadproof").glob("*/__init__.py")]
    assert homes
    assert [x.name for x in homes if not any(y.name != "__init__.py" for y in x.rglob("*.py"))] == []
