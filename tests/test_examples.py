"""Every example does what its output says."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted(path.parent for path in Path(__file__).parents[1].glob("examples/*/run.sh"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda folder: folder.name)
def test_an_example_prints_its_output(example: Path, tmp_path: Path) -> None:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["sh", str(example / "run.sh"), str(tmp_path)],
        env={**os.environ, "PATH": path, "PYTHONIOENCODING": "utf-8"},
        stdout=subprocess.PIPE,
        timeout=240,
        check=True,
    )
    printed = done.stdout.decode()
    assert printed.strip()
    assert printed == (example / "output.txt").read_text("utf-8")


def test_there_are_examples() -> None:
    assert {folder.name for folder in EXAMPLES} >= {"time-to-collision", "traffic"}
