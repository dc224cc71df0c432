"""All of the package is imported before the first test, and random cases are the same in every run.

Tests that take long (``lengthy.txt``) are marked ``long``.

A module that is imported while a test has replaced something would keep the replacement for good. New
random cases are for ``make fuzz``. Answers are computed, not taken from those that are known. Compiled files
are kept, whatever the shell says: tests start hundreds of commands. They hear Ctrl-C, also where the shell
has the tests ignore it (``nohup make test &``): what is ignored is inherited.
"""

import gc
import os
import pkgutil
import signal
import sys
from collections.abc import Iterator
from importlib import import_module

import pytest
from hypothesis import settings

import roadproof
from cached_search import ask_once
from lengthy import COLLECTED, LENGTHY
from one_process import work_here
from roadproof.runtime.worker import collect_rarely
from sharing import HOMES

os.environ["ROADPROOF_KNOWN"] = "off"
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
work_here()
gc.disable()  # until all tests are collected: what is imported stays
settings.register_profile("same", derandomize=True, deadline=None)
settings.load_profile("same")

for _each in pkgutil.walk_packages(roadproof.__path__, "roadproof."):
    if not _each.name.endswith("__main__"):
        import_module(_each.name)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    config.stash[COLLECTED] = [*items]
    for item in items:
        if item.nodeid.startswith(LENGTHY):
            item.add_marker("long")


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    gc.freeze()
    gc.enable()
    collect_rarely()


@pytest.fixture(scope="session", autouse=True)
def shared(tmp_path_factory: pytest.TempPathFactory) -> None:
    """The folder of a worker lies in that of the run."""
    home = tmp_path_factory.getbasetemp()
    HOMES.append((home.parent if "PYTEST_XDIST_WORKER" in os.environ else home) / "shared")


@pytest.fixture(scope="module")
def searched_once() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("roadproof.engines.search.drive_search._search_drive", ask_once)
        yield
