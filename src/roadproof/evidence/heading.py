"""How answers begin as plain data: what kind of answer, which version gave it, what the definitions said."""

import re
from typing import Any

from roadproof.errors import InputError
from roadproof.evidence.strict import Fields
from roadproof.library.specification import Library
from roadproof.runtime.version import VERSION

_FINGERPRINT = re.compile("[0-9a-f]{16}")


def heading(schema: str, library: Library) -> dict[str, Any]:
    """The first fields of an answer; ``library`` has the definitions that it was given with.

    ``signals`` tells what is supposed of own signals, where there are some that are not derived.
    """
    free = {"signals": library.freedom} if library.freedom else {}
    return {"schema": schema, "roadproof": VERSION, "library": library.fingerprint, **free}


def library_of(data: Fields) -> str:
    """Return the fingerprint of the definitions of an index.

    Raises ``InputError`` where that, or the version, is missing or none.
    """
    data.text("roadproof")
    found = data.text("library")
    if not _FINGERPRINT.fullmatch(found):
        raise InputError(f"{data.where}: library='{found[:60]}' is no fingerprint of 16 digits from 0 to f")
    return found
