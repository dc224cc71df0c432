"""Faults planted in the text of a module or of a specification."""

import inspect
import sys
from types import ModuleType

import pytest

from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Library, Source


def plant_fault(monkeypatch: pytest.MonkeyPatch, module: ModuleType, old: str, new: str) -> None:
    """Give ``module`` the functions that it would have with ``old``, once in its text, replaced."""
    text = inspect.getsource(module)
    assert text.count(old) == 1, f"{module.__name__} has {text.count(old)} times {old!r}"
    faulty = ModuleType(module.__name__)
    monkeypatch.setitem(sys.modules, module.__name__, faulty)  # dataclasses look their module up
    exec(compile(text.replace(old, new), str(module.__file__), "exec"), faulty.__dict__)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    users = [user for name, user in sys.modules.items() if name.startswith("roadproof.")]
    for name, value in vars(faulty).items():
        if inspect.isfunction(value) and value.__module__ == module.__name__:
            honest = getattr(module, name)
            for user in users:
                if getattr(user, name, None) is honest:
                    monkeypatch.setattr(user, name, value)


def faulty_library(old: str, new: str) -> Library:
    """The bundled library with ``old`` (once in its text) replaced by ``new``."""
    sources = {x.name: x for x in bundled_library().sources.values()}.values()
    assert sum(source.text.count(old) for source in sources) == 1, old
    return build_library([Source(x.name, x.text.replace(old, new)) for x in sources])
