"""Where the files lie that come with roadproof beside its code: models and proofs."""

from pathlib import Path


def shipped(folder: str) -> Path:
    """The folder ``models`` or ``proofs``, in a checkout as in an installed wheel.

    The wheel carries them inside the package (pyproject.toml, force-include); a checkout has them at
    its root. Raises ``FileNotFoundError`` where neither is there: the installation is broken.
    """
    package = Path(__file__).parents[1]
    for place in (package / folder, package.parents[1] / folder):
        if place.is_dir():
            return place
    raise FileNotFoundError(f"roadproof was installed without its folder '{folder}'")
