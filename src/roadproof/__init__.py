"""Driving scenarios, compiled to proofs, witnesses and monitors.

>>> import roadproof as rp
>>> rp.prove("danger(SV,POV) -> danger(SV,POV)", jobs=1).verdict
<Verdict.PROVED: 'PROVED'>

What is here: definitions (``load``), formulas built with operators (``SV POV L F G U some every …``),
questions (``prove witness compare overlap order redundancy coverage classify explore catalogue preventable
monitor compile evaluate simulate check``, and ``ask`` for studies of yours), drives that are given (``motion
drive``), ``export`` for other tools, and the errors that they raise. Each is imported when it is first used:
the records of the core and of the extensions name its module, and ``__init__.pyi`` shows it to editors.
"""

from typing import Any

from roadproof.runtime.version import VERSION

__version__ = VERSION


def __getattr__(name: str) -> Any:
    from roadproof.core_record import EXTENSION
    from roadproof.extension import entries, import_entry

    if name in EXTENSION.functions:
        return import_entry(f"roadproof.{EXTENSION.functions[name]}")
    if name == "__all__":
        return [*entries("functions"), "__version__"]
    if name.startswith("__"):
        raise AttributeError(f"module 'roadproof' has no attribute '{name}'")
    names = entries("functions")
    if name not in names:
        raise AttributeError(f"module 'roadproof' has no attribute '{name}'; there are {', '.join(names)}")
    return import_entry(names[name])


def __dir__() -> list[str]:
    from roadproof.extension import entries

    return sorted((*entries("functions"), "__version__"))
