"""A package of others that is broken, or takes a name that is taken, is refused by name."""

import os
import subprocess
import sys
from inspect import signature
from pathlib import Path

import pytest

from roadproof.extension import CORE, KEYS, PLAIN, SHARED, Extension, core, installed_extensions
from roadproof.extensions.traffic.formats import sources
from roadproof.frontends.cli import completion

ROOT = Path(__file__).parents[2]
HEAD = "from roadproof.extension import Extension\nEXTENSION = Extension(title='mine', audience='testers', "
# The text of a package, the name of its entry point, a command, and what is said.
BAD = {
    "does not import": ("import nowhere", "mine", "list", "ModuleNotFoundError: No module named 'nowhere'"),
    "is no Python": ("x =", "mine", "list", "SyntaxError"),
    "raises": ("1 / 0", "mine", "--help", "ZeroDivisionError"),
    "has no record": ("x = 1", "mine", "list", "has no EXTENSION of the class Extension"),
    "has an unknown slot": (f"{HEAD}colour='x')", "mine", "list", "unexpected keyword argument 'colour'"),
    "has no such audience": (f"{HEAD[:-11]}'all')", "mine", "list", "theirs: audience='all' is none of"),
    "has no such label": (f"{HEAD}label='old')", "mine", "list", "theirs: label='old' is none of stable"),
    "needs what is not there": (f"{HEAD}needs=('absent',))", "mine", "list", "it needs absent"),
    "has the name of ours": (f"{HEAD})", "traffic", "list", "roadproof.extensions.traffic and theirs both"),
    "has a tuple for a mapping": (
        f"{HEAD}formats=('a:b',))",
        "mine",
        "list",
        "formats=('a:b',) is no mapping",
    ),
    "names what is not there": (
        f"{HEAD}checked_files={{'.x': 'theirs.none:f'}})",
        "mine",
        "check file.x",
        "theirs.none:f is named, but not there",
    ),
}


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    paths = os.pathsep.join([str(ROOT / "src"), str(folder)])
    environment = {**os.environ, "PYTHONPATH": paths, "XDG_CACHE_HOME": str(folder / "cache")}
    return subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True
    )


def install(folder: Path, package: str, name: str, text: str) -> None:
    about = folder / f"{package}-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(f"[roadproof.extensions]\n{name} = {package}\n")
    (folder / package).mkdir()
    (folder / package / "__init__.py").write_text(text)


@pytest.mark.parametrize("kind", BAD)
def test_it_is_refused_by_name(kind: str, tmp_path: Path) -> None:
    text, name, command, said = BAD[kind]
    (tmp_path / "file.x").write_text("x")
    install(tmp_path, "theirs", name, text)
    told = run(tmp_path, "-m", "roadproof", *command.split())
    assert (told.returncode, told.stdout) == (3, ""), told
    assert told.stderr.startswith("roadproof: extension '")
    assert said in told.stderr
    assert len(told.stderr.splitlines()) == 1


def test_two_of_others_have_one_name(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD})")
    install(tmp_path, "others", "mine", f"{HEAD})")
    told = run(tmp_path, "-m", "roadproof", "list")
    assert told.returncode == 3
    assert "extension 'mine': others and theirs both have this name" in told.stderr


def taken_keys() -> list[tuple[str, str, str]]:
    """Return for each slot with keys one that the core has and one that an extension has, with the owner."""
    found: dict[tuple[str, bool], tuple[str, str, str]] = {}
    for x in (core(), *installed_extensions().values()):
        for slot, key in x.record.own_keys():
            owner = "the core" if x.name == CORE else f"'{x.name}'"
            found.setdefault((slot, x.name == CORE), (slot, key, owner))
    return [*found.values()]


@pytest.mark.parametrize(("slot", "key", "owner"), taken_keys())
def test_a_key_that_is_taken(slot: str, key: str, owner: str, tmp_path: Path) -> None:
    value = {key: "theirs:f"} if key else ("theirs:f",)
    install(tmp_path, "theirs", "mine", f"{HEAD}{slot}={value!r})")
    told = run(tmp_path, "-m", "roadproof", "list")
    entry = f"{slot}={key!r}" if key else slot
    assert (told.returncode, told.stdout) == (3, "")
    assert told.stderr == f"roadproof: extension 'mine': {entry} is in {owner} already; uninstall theirs\n"


def test_two_of_others_have_one_key(tmp_path: Path) -> None:
    install(tmp_path, "others", "first", f"{HEAD}traces={{'.tsv': 'others:f'}})")
    install(tmp_path, "theirs", "mine", f"{HEAD}traces={{'.tsv': 'theirs:f'}})")
    told = run(tmp_path, "-m", "roadproof", "list")
    assert told.stderr == "roadproof: extension 'mine': traces='.tsv' is in 'first' already; uninstall one\n"


def test_every_slot_has_a_key_or_a_reason_for_none() -> None:
    assert {*KEYS} == {*signature(Extension).parameters} - {*PLAIN}
    assert {slot for slot, key in KEYS.items() if key == "none"} == {*SHARED}
    keyed = {slot for slot, _, _ in taken_keys()}
    assert keyed == {*KEYS} - {*SHARED}


def test_names_that_a_record_reserves_are_those_that_its_code_handles() -> None:
    own = core().record.reserved
    package = ROOT / "src/roadproof"
    modules = {x.stem for x in package.iterdir() if x.is_dir() or x.suffix == ".py"}
    assert {*own["functions"]} == {x for x in modules if not x.startswith("__")}
    assert {*own["completions"]} == {*completion._VALUES}
    assert {*own["specifications"]} == {x.stem for x in (package / "library/sets/on_request").glob("*.spec")}
    traffic = installed_extensions()["traffic"].record.reserved
    assert {*traffic["formats"]} == {x.name for x in (*sources._MEASURED, *sources._TABLES)}


def test_an_option_that_a_command_has(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD}options={{'witness': 'options:Own'}})")
    text = (
        "from roadproof.frontends.settings.option import Settings, option\n"
        "from roadproof.runtime.records import dataclass\n"
        "@dataclass(frozen=True, kw_only=True)\n"
        "class Own(Settings):\n    other: int = option(1, '--horizon S')\n"
    )
    (tmp_path / "theirs/options.py").write_text(text)
    told = run(tmp_path, "-m", "roadproof", "witness", "4")
    assert (told.returncode, told.stdout) == (3, "")
    assert "extension 'mine': options='witness': --horizon of theirs.options:Own is there" in told.stderr


def test_a_schema_that_is_described(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD}schemas=('data:TITLES',))")
    text = (
        "from typing import Literal\nfrom roadproof.runtime.records import dataclass\n@dataclass\n"
        "class Own:\n    schema: Literal['roadproof/verdicts/2']\nTITLES = {Own: 'mine'}\n"
    )
    (tmp_path / "theirs/data.py").write_text(text)
    path = f"import sys; sys.path.append({str(ROOT / 'tests')!r})"
    told = run(tmp_path, "-c", f"{path}; from documents.schemas import titles; titles()")
    assert "InputError: extension 'mine': verdicts.json of theirs.data:TITLES is described" in told.stderr


def test_a_driver_model_that_calls_itself_otherwise(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD}drivers={{'other': 'row:CAREFUL'}})")
    (tmp_path / "theirs/row.py").write_text("from roadproof.extensions.drivers.laws import CAREFUL\n")
    told = run(tmp_path, "-m", "roadproof", "preventable", "cut-in")
    assert told.returncode == 3
    assert "extension 'mine': drivers='other' calls itself 'careful'; give it one name" in told.stderr


def test_a_command_that_is_there_already(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD})")
    (tmp_path / "theirs/commands").mkdir()
    (tmp_path / "theirs/commands/prove.py").write_text('SUMMARY = "prove otherwise"\n')
    told = run(tmp_path, "-m", "roadproof", "prove", "P4")
    assert (told.returncode, told.stdout) == (3, "")
    assert "the command prove is there already; uninstall theirs" in told.stderr
