"""Answers that the code of another package decides are known only to the same version of it."""

import json
import shutil
from pathlib import Path

import pytest

from core.test_bad_extensions import ROOT, run

EXAMPLE = ROOT / "examples/extension/roadproof_example"
KEYS = """\
import json
import roadproof as rp
from roadproof.extensions.drivers import restriction
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.preventable.claims import Lines
from roadproof.library.loading import load_library
from roadproof.evidence.claim import Valid, claim_of
from roadproof.library.elaborate import read_claim
from roadproof.questions.store import Store
from roadproof.runtime.budget import Work

def key(kind, home, mode=Valid()):
    claim = claim_of(home, read_claim(home, "true"), mode, {})
    return Store(None, kind, Work()).key(claim)

def restricted(model):
    library = load_library(restriction.files_for((), model))
    return library.select("base", restriction.Restriction("preventable", model).options)

class Plate:
    def __init__(self, model):
        self.model = model

def plate(model):
    return Lines(Plate(model)).relies_on

plain = rp.load().specification
keys = {"plain": key("witness", plain), "careful": key("witness", restricted("careful"))}
if "alert" in MODELS:
    keys |= {"alert": key("witness", restricted("alert")), "alone": key("alone", plain)}
    assert plate("alert") == ("roadproof_example.driver:ALERT",)
print(json.dumps(keys))
"""

ASK = """\
import os
os.environ.pop("ROADPROOF_KNOWN", None)
import roadproof as rp
from roadproof.questions import store
from roadproof_example.question import Alone

origins, recall = [], store.recall

def recorded(kind, key):
    known = recall(kind, key)
    origins.append(known and known.origin)
    return known

store.recall = recorded
rp.ask(Alone, "4", effort=3, jobs=1)
print({*origins})
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copytree(EXAMPLE, tmp_path / "roadproof_example", ignore=shutil.ignore_patterns("__pycache__"))
    install(tmp_path, "1.0")
    return tmp_path


def install(folder: Path, version: str) -> None:
    for former in folder.glob("*.dist-info"):
        shutil.rmtree(former)
    about = folder / f"roadproof_example-{version}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: roadproof-example\nVersion: {version}\n")
    (about / "entry_points.txt").write_text("[roadproof.extensions]\nexample = roadproof_example\n")


def keys(folder: Path) -> dict[str, str]:
    told = run(folder, "-c", KEYS)
    assert told.returncode == 0, told.stderr
    found: dict[str, str] = json.loads(told.stdout)
    return found


def test_keys_change_with_a_foreign_package_where_it_decides(folder: Path, tmp_path: Path) -> None:
    first = keys(folder)
    install(folder, "1.1")
    second = keys(folder)
    file = folder / "roadproof_example/driver.py"
    file.write_text(file.read_text() + "\n# changed without a new version\n")
    third = keys(folder)
    for name in ("alert", "alone"):
        assert len({first[name], second[name], third[name]}) == 3
    shutil.rmtree(next(folder.glob("*.dist-info")))
    without = keys(folder)
    assert {*without} == {"plain", "careful"}
    for name in without:
        assert first[name] == second[name] == third[name] == without[name]


def asks_again(folder: Path) -> bool:
    told = run(folder, "-c", ASK)
    assert told.returncode == 0, told.stderr
    assert told.stdout in ("{None}\n", "{'cache'}\n")
    return told.stdout == "{None}\n"


def test_another_version_asks_again(folder: Path) -> None:
    assert asks_again(folder)
    assert not asks_again(folder)
    install(folder, "1.1")
    assert asks_again(folder)
    assert not asks_again(folder)
