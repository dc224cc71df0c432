"""The heading of every answer: schema, version of roadproof, and fingerprint of the definitions."""

import re
from typing import Any

from roadproof.errors import InputError
from roadproof.evidence.strict import Fields
from roadproof.library.specification import Library
from roadproof.runtime.version import VERSION

_FINGERPRINT = re.compile("[0-9a-f]{16}")


def heading(schema: str, library: Library) -> dict[str, Any]:
    """Return the first fields of an answer that was made with a library.

    ``signals`` describes the custom signals that are not derived, if there are any.
    """
    signals = {"signals": library.freedom} if library.freedom else {}
    return {"schema": schema, "roadproof": VERSION, "library": library.fingerprint, **signals}


def library_of(data: Fields) -> str:
    """Return the fingerprint of the definitions of an index.

    Raises ``InputError`` if the fingerprint or the version is missing or malformed.
    """
    data.text("roadproof")
    fingerprint = data.text("library")
    if not _FINGERPRINT.fullmatch(fingerprint):
        raise InputError(
            f"{data.where}: library='{fingerprint[:60]}' is no fingerprint of 16 digits from 0 to f"
        )
    return fingerprint
