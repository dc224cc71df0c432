"""The drives of scenarios that are shipped with roadproof, as candidates against a claim."""

import json
from collections.abc import Iterator

from roadproof.analysis.study.known import shipped_answers
from roadproof.evidence.drive_file import SCHEMAS_READ, read_drive
from roadproof.world.drive import Drive


def shipped_drives() -> Iterator[Drive]:
    """Each drive of a shipped answer of ``witness``, once."""
    seen: set[str] = set()
    for answer in shipped_answers("witness"):
        for name, text in sorted(answer.files.items()):
            content = json.loads(text)
            if text in seen or content.get("schema") not in SCHEMAS_READ:
                continue
            seen.add(text)
            yield read_drive(content, name).drive
