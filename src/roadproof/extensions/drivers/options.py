"""The options with which a driver model restricts questions of others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from roadproof.frontends.settings.option import Settings, option
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from roadproof.extensions.drivers.restriction import About
    from roadproof.frontends.api.definitions import Among, Definitions, What


def driver_model(side: str, does: str, what: str = "scenarios") -> Any:
    """A driver model that restricts ``what`` to those whose first collision it prevents, or cannot."""
    text = f"only {what} whose first collision a driver model (careful) {does}"
    return option(None, f"--{side} MODEL", text, rare=True)


@dataclass(frozen=True, kw_only=True)
class Prevention(Settings):
    """Driver models that restrict the question."""

    about: ClassVar[About] = "scenarios"
    preventable: str | None = driver_model("preventable", "prevents")
    unpreventable: str | None = driver_model("unpreventable", "cannot prevent")

    def modified(
        self, home: Definitions, among: Among = None, what: Sequence[What] | None = None
    ) -> Definitions:
        """Return the definitions of what begins as a driver model says. Raises as ``restricted``."""
        home = Settings.modified(self, home, among, what)
        if self.preventable is None and self.unpreventable is None:
            return home
        from roadproof.extensions.drivers.restricting import restricted  # loads the models

        return restricted(home, self, among, what, self.about)

    @classmethod
    def with_files(cls, args: argparse.Namespace, files: list[Path]) -> list[Path]:
        """Return specification files with those that the restriction of the command line needs."""
        model = args.preventable or args.unpreventable
        if not model:
            return files
        from roadproof.extensions.drivers.restriction import names_for  # loads the models

        return names_for(files, model)


@dataclass(frozen=True, kw_only=True)
class PreventionOfDrives(Prevention):
    """Driver models that restrict a question about all drives."""

    about: ClassVar[About] = "drives"
    preventable: str | None = driver_model("preventable", "prevents", "drives")
    unpreventable: str | None = driver_model("unpreventable", "cannot prevent", "drives")


def add_drivers(args: argparse.Namespace) -> None:
    """Add the definitions of driver models to the files of ``--spec``."""
    from roadproof.extensions.drivers.models import specifications

    specs = args.specs or []
    args.specs = [*(x for x in map(Path, specifications()) if x not in specs), *specs]
