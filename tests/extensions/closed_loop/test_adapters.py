"""Controllers in other processes and files: JSON lines, and FMUs where fmpy and pythonfmu are installed."""

import os
import subprocess
import sys
from pathlib import Path
from shlex import quote

import pytest

import roadproof as rp
from extensions.closed_loop.loops import loop_of, problem
from roadproof.extensions.closed_loop.controllers.opening import opened, source_of
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.simulation import ControlLoop, exact_drive

ECHO = Path(__file__).with_name("echo.py")


def command(how: str) -> str:
    return f"{quote(sys.executable)} {quote(str(ECHO))} {how}"


def test_a_command_drives_as_the_same_controller_in_python() -> None:
    asked = problem(4)
    situation = asked.shape.situation(asked.shape.seed)
    expected = exact_drive(loop_of("LateBrake"), situation)
    with opened(source_of(command("brakes")), 0, 20.0) as controller:
        assert exact_drive(ControlLoop(controller, 60.0), situation) == expected


@pytest.mark.parametrize(
    ("how", "told"),
    [
        ("late", "no reply within 0.5 s"),
        ("dies", "its process ended with code 3: out of fuel"),
        ("words", "its reply is no JSON: b'brake!'"),
        ("empty", 'has no number "acceleration"'),
    ],
)
def test_an_error_says_what_the_process_did(how: str, told: str) -> None:
    asked = problem(4)
    with (
        opened(source_of(command(how)), 0, 0.5 if how == "late" else 20.0) as controller,
        pytest.raises(ControllerError) as error,
    ):
        asked.run(ControlLoop(controller, 60.0), [asked.shape.seed])
    assert told in str(error.value)


def test_a_command_is_falsified() -> None:
    answer = rp.falsify(
        command("brakes"), among=4, classes=False, drivers=["careful"], simulations=60, jobs=1
    )
    assert answer.findings == {"scenario_4": "FAILS"}


@pytest.mark.parametrize(("package", "slave"), [("pythonfmu", 2), ("pythonfmu3", 3)])
def test_an_fmu_drives_as_the_same_controller_in_python(package: str, slave: int, tmp_path: Path) -> None:
    """An FMU of FMI 2.0, and one of FMI 3.0; both libraries of FMUs do not share a process."""
    for name in ("fmpy", package):
        pytest.importorskip(name, reason=f"{name} is not installed: FMUs of FMI {slave}.0 are not tried")
    (tmp_path / "latebrake.py").write_text(SLAVES[slave])
    words = [sys.executable, "-c", COMPARISON, package, str(tmp_path)]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment)
    assert done.stdout.splitlines()[-1:] == ["same"], done.stdout + done.stderr


COMPARISON = """
import importlib, sys
from pathlib import Path
package, folder = sys.argv[1], Path(sys.argv[2])
importlib.import_module(f"{package}.builder").FmuBuilder.build_FMU(folder / "latebrake.py", dest=folder)
from extensions.closed_loop.loops import loop_of, problem
from roadproof.extensions.closed_loop.controllers.opening import opened, source_of
from roadproof.extensions.closed_loop.simulation import ControlLoop, exact_drive
asked = problem(4)
situation = asked.shape.situation(asked.shape.seed)
with opened(source_of(str(folder / "LateBrake.fmu")), 0, 20.0) as controller:
    driven = exact_drive(ControlLoop(controller, 60.0), situation)
print("same" if driven == exact_drive(loop_of("LateBrake"), situation) else "another drive")
"""
SLAVES = {
    2: """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class LateBrake(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.gap = 1e6
        self.acceleration = 0.0
        self.register_variable(Real("gap", causality=Fmi2Causality.input))
        self.register_variable(Real("acceleration", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        self.acceleration = -9.0 if self.gap < 8 else 0.0
        return True
""",
    3: """
from pythonfmu3 import CoSimulation, Fmi3Causality, Fmi3Slave, Float64


class LateBrake(Fmi3Slave, CoSimulation):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        self.gap = 1e6
        self.acceleration = 0.0
        self.register_variable(Float64("time", causality=Fmi3Causality.independent))
        self.register_variable(Float64("gap", causality=Fmi3Causality.input))
        self.register_variable(Float64("acceleration", causality=Fmi3Causality.output))

    def do_step(self, current_time, step_size):
        self.acceleration = -9.0 if self.gap < 8 else 0.0
        return True
""",
}
