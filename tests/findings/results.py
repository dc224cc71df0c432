"""Commands are run once, in a folder of their own, and what they did is kept for the same program."""

import hashlib
import json
import re
import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import IO

from console import environment, run
from findings.figures import Outcome

ROOT = Path(__file__).parents[2]
PROGRAM = ("src", "models", "proofs")
US101 = "../shared/data/us101"  # as pages name it, beside the checkout


@cache
def digest_of_program() -> str:
    """A short text that changes with any file that answers depend on."""
    digest = hashlib.sha256()
    for path in sorted(p for top in PROGRAM for p in (ROOT / top).rglob("*") if p.is_file()):
        if path.suffix != ".pyc":
            digest.update(f"{path.relative_to(ROOT)}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:12]


class Results:
    """A folder with a folder for each chain of commands; of another program, all are asked again."""

    def __init__(self, folder: Path, us101: Path = ROOT / US101) -> None:
        self.folder = folder.resolve() / digest_of_program()
        self.us101 = us101.resolve()

    def lacks_data(self, commands: Sequence[str]) -> bool:
        """Whether the commands need recordings that are not there."""
        return any(US101 in c for c in commands) and not self.us101.is_dir()

    def has(self, commands: Sequence[str]) -> bool:
        """Whether all of the commands have been run."""
        return self.file_of(commands).is_file()

    def folder_of(self, commands: Sequence[str]) -> Path:
        """Where commands are run: those that begin with the same command share a folder."""
        return self._named(commands[0], commands[0])

    def file_of(self, commands: Sequence[str]) -> Path:
        """What the last of the commands did."""
        more = "" if len(commands) == 1 else f"-{_digest(chr(10).join(commands))}"
        return self.folder_of(commands) / f"{len(commands)}{more}.json"

    def ask(self, commands: Sequence[str]) -> Outcome:
        """What the last command does; one that was broken off goes on in its folder."""
        work = self.folder_of(commands) / "work"
        work.mkdir(parents=True, exist_ok=True)
        for number, command in enumerate(commands, start=1):
            target = self.file_of(commands[:number])
            if not target.is_file():
                with target.with_suffix(".complaints").open("wb") as complaints:
                    self._run(command, work, target, complaints)
        data = json.loads(self.file_of(commands).read_text("utf-8"))
        return Outcome(data["printed"], data["exit"], work)

    def _named(self, name: str, text: str) -> Path:
        words = re.sub(r"[^\w]+", "-", name)[:60].strip("-")
        return self.folder / f"{words}-{_digest(text)}"

    def _run(self, command: str, work: Path, target: Path, complaints: IO[bytes]) -> None:
        begun = time.monotonic()
        done = subprocess.run(
            ["bash", "-c", self._here(command)],
            cwd=work,
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=complaints,
        )
        data = {
            "command": command,
            "exit": done.returncode,
            "seconds": round(time.monotonic() - begun, 1),
            "printed": done.stdout.decode("utf-8").replace(str(self.us101), US101),
        }
        target.write_text(json.dumps(data, indent=1, ensure_ascii=False), "utf-8")

    def _here(self, command: str) -> str:
        """A command of a page, which is run elsewhere than in the checkout."""
        return command.replace(US101, str(self.us101)).replace("benchmarks/", f"{ROOT}/benchmarks/")

    def has_session(self, commands: Sequence[str]) -> bool:
        """Whether the page has been run."""
        return (self._session(commands) / f"{len(commands)}.json").is_file()

    def _session(self, commands: Sequence[str]) -> Path:
        return self._named(commands[-1], "\n".join(commands))

    def session(
        self, commands: Sequence[str], files: Mapping[str, str], beside: Sequence[Path]
    ) -> list[list[str]]:
        """What each command of a page prints, all in one folder with the page's files and those beside it."""
        folder = self._session(commands)
        target = folder / f"{len(commands)}.json"
        if not target.is_file():
            shutil.rmtree(folder, ignore_errors=True)
            work = folder / "work"
            work.mkdir(parents=True)
            for path in beside:
                (shutil.copytree if path.is_dir() else shutil.copy)(path, work / path.name)
            for name, text in files.items():
                (work / name).write_text(text, "utf-8")
            printed = [run(command, work) for command in commands]
            target.write_text(json.dumps(printed, indent=1, ensure_ascii=False), "utf-8")
        lines: list[list[str]] = json.loads(target.read_text("utf-8"))
        return lines


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:8]
