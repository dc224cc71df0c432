"""The text of ``src/roadproof/__init__.pyi``, in which editors find public names (``make generated``)."""

from pathlib import Path

from roadproof.extension import core, installed_extensions

FILE = Path(__file__).parents[2] / "src/roadproof/__init__.pyi"
_HEAD = '''"""The public names of the core and of each extension; made by make generated."""

'''


def text() -> str:
    """The text of the file: an import of each name, from the module that its record names."""
    entries = [
        x.whole(entry).split(":")
        for x in (core(), *installed_extensions().values())
        if not x.is_foreign
        for entry in x.record.functions.values()
    ]
    lines = [f"from {module} import {name} as {name}\n" for module, name in sorted(entries, key=_isort)]
    return f"{_HEAD}{''.join(lines)}\n__all__: list[str]\n__version__: str\n"


def _isort(entry: list[str]) -> tuple[str, int, str]:
    """The order in which ruff sorts imports: constants, classes, then functions."""
    module, name = entry
    rank = 0 if name.isupper() and len(name) > 1 else 1 if name[0].isupper() else 2
    return module, rank, name
