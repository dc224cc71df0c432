"""A controller in a Python file: a class with ``step`` and perhaps ``reset``, or a function."""

import ast
import hashlib
import inspect
import sys
from collections.abc import Iterator
from contextlib import redirect_stdout
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

from roadproof.errors import InputError
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.protocol import ControllerInput, VehicleController

_PREFIX = "roadproof_controller_"


class _Stepping:
    """A function, or an object without ``reset``, as a controller."""

    def __init__(self, step: Any) -> None:
        self.step = step

    def reset(self, observation: ControllerInput) -> None:
        """Begin a simulation: a function remembers nothing."""


def python_controller(path: Path, name: str, seed: int) -> VehicleController:
    """Return the controller of a name in a file.

    A class is called without arguments, or with ``seed=`` where it takes one. Raises ``InputError``.
    """
    made = _named(path, name)
    if inspect.isclass(made):
        try:
            takes_seed = "seed" in inspect.signature(made).parameters
            make: Any = made
            made = make(seed=seed) if takes_seed else make()
        except Exception as error:  # whatever the code of a user does
            raise ControllerError(f"{path}:{name}() raises {type(error).__name__}: {error}") from error
    elif callable(made) and not hasattr(made, "step"):
        return _checked(path, name, _Stepping(made))
    return _checked(path, name, made)


def _checked(path: Path, name: str, made: Any) -> VehicleController:
    if not callable(getattr(made, "step", None)):
        raise InputError(f"{path}:{name} has no method step(observation, dt): add one, or name a function")
    controller: VehicleController = made if callable(getattr(made, "reset", None)) else _Stepping(made.step)
    return controller


def digest_of(path: Path, name: str) -> str:
    """Return a digest of a name in a file, of the file, and of the modules in its folder that it imports.

    Raises ``InputError``.
    """
    _named(path, name)
    total = hashlib.sha256(name.encode())
    for x in _files(path.resolve()):
        total.update(hashlib.sha256(x.read_bytes()).digest())
    return total.hexdigest()


def _files(path: Path) -> list[Path]:
    """Return a file, and the files beside it that it imports by name, at any depth."""
    files, waiting = [path], [path]
    while waiting:
        for name in _imported(waiting.pop()):
            place = path.parent / name.replace(".", "/")
            for x in (place.with_suffix(".py"), place / "__init__.py"):
                if x.is_file() and x not in files:
                    files.append(x)
                    waiting.append(x)
    return [path, *sorted(files[1:])]


def _imported(path: Path) -> Iterator[str]:
    """Yield the names of the modules that the statements of a file import."""
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            yield from (x.name for x in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{x.name}" for x in node.names)


def _named(path: Path, name: str) -> Any:
    module = _module(path)
    if not hasattr(module, name):
        names = [
            x for x, value in vars(module).items() if callable(value) and value.__module__ == module.__name__
        ]
        raise InputError(f"{path} has no '{name}'; it has {', '.join(names) or 'no class or function'}")
    return getattr(module, name)


def _module(path: Path) -> ModuleType:
    """Return a file as a module, which is run once in a process as long as it does not change."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}; name an existing FILE.py:NAME") from None
    name = _PREFIX + hashlib.sha256(str(path.resolve()).encode() + content).hexdigest()[:16]
    if name in sys.modules:
        return sys.modules[name]
    spec = spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)
    sys.modules[name] = module
    try:
        with redirect_stdout(sys.stderr):  # standard output is for answers
            spec.loader.exec_module(module)
    except Exception as error:  # whatever the code of a user does
        del sys.modules[name]
        raise ControllerError(f"{path} cannot be run: {type(error).__name__}: {error}") from error
    return module
