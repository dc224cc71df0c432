"""examples/traffic does what its output says."""

import os
import subprocess
import sys
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples" / "traffic"


def test_the_example_prints_its_output(tmp_path: Path) -> None:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["sh", str(EXAMPLE / "run.sh"), str(tmp_path)],
        env={**os.environ, "PATH": path, "PYTHONIOENCODING": "utf-8"},
        stdout=subprocess.PIPE,
        timeout=120,
        check=True,
    )
    printed = done.stdout.decode()
    assert "scenario_" in printed
    assert printed == (EXAMPLE / "output.txt").read_text("utf-8")
