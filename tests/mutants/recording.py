"""A pytest plugin that records which lines of roadproof each test runs, and how long it takes.

``pytest FILE -p mutants.recording`` with ``MUTANTS_RECORD`` naming the JSON file to write. A line is kept
by its function and its text, not by its number, so that a record outlives changes elsewhere in the file.
"""

import ast
import functools
import gc
import json
import os
import signal
from pathlib import Path
from types import FrameType

import coverage
import pytest

import roadproof
from mutants.places import places_of

PACKAGE = Path(roadproof.__file__).parent
TOO_SLOW = 30
"""Seconds of processor time (with recording) after which a test is given up: too slow to be run on faults."""


class TooSlow(BaseException):
    """Raised in a test that is given up; no ``except Exception`` of ours stops it, and pytest reports it."""


def give_up(_signal: int, _frame: FrameType | None) -> None:
    raise TooSlow(f"slower than {TOO_SLOW} s")


class Recorder:
    def __init__(self) -> None:
        self.coverage = coverage.Coverage(data_file=None, source=[str(PACKAGE)], config_file=False)
        self.seconds: dict[str, float] = {}
        self.failed: set[str] = set()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> object:
        for kept in gc.get_objects():
            if isinstance(kept, functools._lru_cache_wrapper) and is_ours(kept):
                kept.cache_clear()  # what an earlier test left there would hide the lines this one needs
        self.coverage.switch_context(item.nodeid)
        signal.signal(signal.SIGPROF, give_up)
        signal.setitimer(signal.ITIMER_PROF, TOO_SLOW)
        begun = spent()
        try:
            return (yield)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            self.seconds[item.nodeid] = spent() - begun

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if not report.passed:
            self.failed.add(report.nodeid)

    def write(self, path: Path) -> None:
        """{"places": [[file, place]], "tests": {test: {"seconds", "places"}}} of the tests that passed."""
        data = self.coverage.get_data()
        numbers: dict[tuple[str, str], int] = {}
        run: dict[str, set[int]] = {}
        for name in sorted(data.measured_files()):
            places = places_of(ast.parse(text := Path(name).read_text("utf-8")), text)
            file = str(Path(name).relative_to(PACKAGE))
            for line, tests in data.contexts_by_lineno(name).items():
                number = numbers.setdefault((file, places.get(line, "")), len(numbers))
                for test in tests:
                    run.setdefault(test, set()).add(number)
        kept = {
            test: {"seconds": round(seconds, 2), "places": sorted(run.get(test, ()))}
            for test, seconds in sorted(self.seconds.items())
            if test not in self.failed
        }
        path.parent.mkdir(parents=True, exist_ok=True)
        found = {"places": list(numbers), "tests": kept, "left out": sorted(self.failed)}
        path.write_text(json.dumps(found, separators=(",", ":")), "utf-8")


def spent() -> float:
    """Seconds of processor time, of ended child processes too: a busy machine does not change them."""
    return sum(os.times()[:4])


def is_ours(kept: object) -> bool:
    """Whether this cache keeps what a target computes; the grammar, which is slow to build, may stay."""
    module = getattr(kept, "__module__", None) or ""
    return module.startswith("roadproof.") and module != "roadproof.logic.parse"


def pytest_configure(config: pytest.Config) -> None:
    recorder = Recorder()
    recorder.coverage.start()
    config.pluginmanager.register(recorder, "recorder")


def pytest_unconfigure(config: pytest.Config) -> None:
    recorder = config.pluginmanager.get_plugin("recorder")
    assert recorder is not None
    recorder.coverage.stop()
    recorder.write(Path(os.environ["MUTANTS_RECORD"]))
