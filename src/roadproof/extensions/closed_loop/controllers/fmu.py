"""A controller as a co-simulation FMU of FMI 2.0 or 3.0, run by fmpy.

Real inputs with these names are set: ``s``, ``d``, ``v_lon``, ``v_lat``, ``a_lon``, ``plan`` of the vehicle
under test; ``gap`` and ``closing`` (m, m/s) to the vehicle ahead, 1e6 and 0 where there is none; and for each
other vehicle ``POV.s`` and so on. The real output ``acceleration`` is read, and ``lateral`` if there is one.
"""

import hashlib
import shutil
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, MissingSolverError
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.protocol import OBSERVED, Answer, ControllerInput

_FAR = 1e6
_REAL = ("Real", "Float64")


def fmu_digest(path: Path) -> str:
    """Return the SHA-256 of an FMU. Raises ``InputError``."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}; name an existing FILE.fmu") from None


class FmuController:
    """An instance of an FMU."""

    def __init__(self, path: Path) -> None:
        try:
            import fmpy
        except ImportError:
            raise MissingSolverError("an FMU needs fmpy: pip install fmpy") from None
        try:
            self._about: Any = fmpy.read_model_description(str(path))
            self._folder = fmpy.extract(str(path))
            self._fmu: Any = fmpy.instantiate_fmu(self._folder, self._about, "CoSimulation")
        except Exception as error:  # whatever fmpy raises about a file
            raise ControllerError(f"{path}: {type(error).__name__}: {error}") from error
        self._is_third = str(self._about.fmiVersion).startswith("3")
        real = [x for x in self._about.modelVariables if x.type in _REAL]
        self._inputs = {x.name: x.valueReference for x in real if x.causality == "input"}
        outputs = {x.name: x.valueReference for x in real if x.causality == "output"}
        if "acceleration" not in outputs:
            self.close()
            raise InputError(
                f"{path} has no real output 'acceleration'; it has {', '.join(outputs) or 'none'}"
            )
        self._outputs = [outputs[x] for x in ("acceleration", "lateral") if x in outputs]
        self._is_fresh = True

    def reset(self, observation: ControllerInput) -> None:
        """Begin a simulation in this state."""
        if not self._is_fresh:
            self._fmu.reset()
        self._is_fresh = False
        if self._is_third:
            self._fmu.enterInitializationMode(startTime=0.0)
        else:
            self._fmu.setupExperiment(startTime=0.0)
            self._fmu.enterInitializationMode()
        self._set(observation)
        self._fmu.exitInitializationMode()

    def step(self, observation: ControllerInput, dt: float) -> Answer:
        """Return the outputs after a step of ``dt`` seconds with the inputs of this instant."""
        self._set(observation)
        self._fmu.doStep(currentCommunicationPoint=observation.time, communicationStepSize=dt)
        read = self._fmu.getFloat64 if self._is_third else self._fmu.getReal
        values = [float(x) for x in read(self._outputs)]
        return values[0], values[1] if len(values) > 1 else None

    def _set(self, observation: ControllerInput) -> None:
        ahead = observation.ahead()
        known = {x: getattr(observation.me, x) for x in OBSERVED}
        known |= {"plan": observation.plan, "gap": _FAR, "closing": 0.0}
        if ahead is not None:
            known |= {"gap": ahead[0], "closing": observation.me.v_lon - ahead[1].v_lon}
        for other in observation.others:
            known |= {f"{other.name}.{x}": getattr(other, x) for x in OBSERVED}
        named = [(self._inputs[name], value) for name, value in known.items() if name in self._inputs]
        if named:
            write = self._fmu.setFloat64 if self._is_third else self._fmu.setReal
            write([x for x, _ in named], [x for _, x in named])

    def close(self) -> None:
        """End the instance, and remove its files."""
        self._fmu.terminate()
        self._fmu.freeInstance()
        shutil.rmtree(self._folder, ignore_errors=True)
