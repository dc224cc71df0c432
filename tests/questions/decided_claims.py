"""A record of the claims that engines decide, in whatever process."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest


class Asked:
    """The claims that ``study`` decides, a line each by ``said``; equal to a list of all lines."""

    def __init__(
        self, log: Path, patch: pytest.MonkeyPatch, study: type[Any], said: Callable[[Any], str] = str
    ) -> None:
        self.log = log
        answer_claim = study.answer_claim

        def hear(asked: Any, piece: Any, *more: Any) -> Any:
            with log.open("a") as file:
                file.write(f"{said(piece)}\n")
            return answer_claim(asked, piece, *more)

        patch.setattr(study, "answer_claim", hear)

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
