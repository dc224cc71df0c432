"""The drives of scenarios that are shipped with roadproof, as candidates against a claim."""

import json
from collections.abc import Iterator
from typing import Any

from roadproof.core_record import DRIVES
from roadproof.evidence.drive_file import read_drive
from roadproof.runtime.archives import shipped_answers
from roadproof.world.drive import Drive


def shipped_drives() -> Iterator[Drive]:
    """Yield each drive of a shipped answer of ``witness``, once."""
    seen: list[Drive] = []
    for key, text in shipped_answers("witness").items():
        content: Any = json.loads(text)
        if content.get("schema") in DRIVES:
            drive = read_drive(content, key).drive
            if drive not in seen:
                seen.append(drive)
                yield drive
