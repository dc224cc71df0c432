"""One fault on trial: made in a copy of the project, the tests that see its line run there."""

import os
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from mutants.edits import Edit

COPIED = ("src", "tests", "models", "proofs", "examples", "docs", "README.md", "pyproject.toml")
MEMORY = 12 << 30  # bytes of address space; a fault may ask for more without end
FIRST = 15.0  # seconds of tests that are run before the others: most faults need no more
PATIENCE = 3.0
LEAST_PATIENCE = 25.0
"""Seconds of processor time for each recorded second, and in all: beyond that the fault hangs."""

WAITING = 20.0  # of wall clock for each of them, for what hangs and does nothing


@dataclass(frozen=True)
class Outcome:
    """``caught`` by a test that fails, ``hung``, ``survived``, or ``unreached``: no test runs the line."""

    verdict: str
    by: str
    tests: int
    seconds: float


class Bench:
    """A copy of the project in which one fault at a time stands, and one without any beside it."""

    def __init__(self, root: Path, folder: Path, clean: Path) -> None:
        self.folder, self.clean = folder, clean
        self.stamp = int(time.time())
        self.sound: set[str] = set()
        copy_project(root, folder)

    def try_fault(self, edit: Edit, tests: list[str], seconds: Mapping[str, float]) -> Outcome:
        """Run ``tests`` with the fault, a few first; ``seconds`` is what each takes without it.

        A failure counts only where the same test has passed on the copy without a fault.
        """
        begun = time.monotonic()

        def outcome(verdict: str, by: str = "") -> Outcome:
            return Outcome(verdict, by, len(tests), round(time.monotonic() - begun, 1))

        file = self.folder / "src/roadproof" / edit.file
        text = file.read_text("utf-8")
        left = _first_and_rest(tests, seconds)
        try:
            self._write(file, edit.apply(text))
            while left:
                if not left[0]:
                    left.pop(0)
                    continue
                patience = LEAST_PATIENCE + PATIENCE * sum(seconds[test] for test in left[0])
                code, failed = run_tests(self.folder, left[0], patience)
                if code is None:
                    return outcome("hung")
                if code == 0:
                    left.pop(0)
                elif not failed:  # the tests cannot even be collected, or the interpreter died
                    sound = self._is_sound(left[0][0])
                    return outcome("caught" if sound else "broken", f"pytest ends with {code}")
                elif self._is_sound(failed):
                    return outcome("caught", failed)
                else:
                    left[0].remove(failed)
            return outcome("survived" if tests else "unreached")
        finally:
            self._write(file, text)

    def _is_sound(self, test: str) -> bool:
        """Whether the test passes without a fault."""
        if test not in self.sound and run_tests(self.clean, [test], LEAST_PATIENCE + PATIENCE * 60)[0] == 0:
            self.sound.add(test)
        return test in self.sound

    def _write(self, file: Path, text: str) -> None:
        """A time stamp of its own for each version, so that no compiled file is taken for another's."""
        file.write_text(text, "utf-8")
        self.stamp += 1
        os.utime(file, (self.stamp, self.stamp))


def _first_and_rest(tests: list[str], seconds: Mapping[str, float]) -> list[list[str]]:
    spent = 0.0
    for i, test in enumerate(tests):
        spent += seconds[test]
        if spent > FIRST:
            return [tests[: i + 1], tests[i + 1 :]]
    return [list(tests)]


def copy_project(root: Path, folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in COPIED:
        source = root / name
        if source.is_dir():
            shutil.copytree(
                source, folder / name, ignore=shutil.ignore_patterns("__pycache__", ".hypothesis")
            )
        else:
            shutil.copy2(source, folder / name)


def _limit(seconds: int) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))


def run_tests(folder: Path, tests: list[str], seconds: float) -> tuple[int | None, str]:
    """pytest's exit code, None where it did not end in time, and the first test that failed."""
    listed = folder / f"tests-{threading.get_ident()}.txt"
    listed.write_text("\n".join(tests), "utf-8")
    options = ["-x", "-q", "-p", "no:xdist", "-p", "no:cacheprovider", "--tb=no", "-rfE", "--no-header"]
    path = f"{folder / 'src'}{os.pathsep}{folder / 'tests'}"
    environment = {**os.environ, "PYTHONPATH": path, "ROADPROOF_EXAMPLES": "full"}
    process = subprocess.Popen(
        [sys.executable, "-m", "pytest", *options, f"@{listed.name}"],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
        preexec_fn=lambda: _limit(int(seconds)),
    )
    try:
        printed = process.communicate(timeout=WAITING * seconds)[0].decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        return None, ""
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    if process.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return None, ""
    for line in printed.splitlines():
        word, _, rest = line.partition(" ")
        if word in ("FAILED", "ERROR") and "::" in rest:
            named = rest.partition(" - ")[0]
            return process.returncode, next((test for test in tests if test == named), "")
    return process.returncode, ""
