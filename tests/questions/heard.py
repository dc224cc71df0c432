"""What a study is asked to settle, in whatever process."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest


class Asked:
    """The pieces that ``study`` settles, a line each as ``said`` tells them; equal to a list of all lines."""

    def __init__(
        self, log: Path, patch: pytest.MonkeyPatch, study: type[Any], said: Callable[[Any], str] = str
    ) -> None:
        self.log = log
        settle = study.settle

        def hear(asked: Any, piece: Any, *more: Any) -> Any:
            with log.open("a") as file:
                file.write(f"{said(piece)}\n")
            return settle(asked, piece, *more)

        patch.setattr(study, "settle", hear)

    def since(self) -> list[str]:
        """The lines since this was asked last."""
        found = self.log.read_text().splitlines() if self.log.exists() else []
        self.log.write_text("")
        return found

    def __eq__(self, other: object) -> bool:
        return (self.log.read_text().splitlines() if self.log.exists() else []) == other

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return self.log.read_text() if self.log.exists() else "nothing"
