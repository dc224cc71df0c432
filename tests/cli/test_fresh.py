"""The README as a new user types it (tests/fresh.py); the whole of it with ROADPROOF_FRESH=1."""

import os
from pathlib import Path

import pytest

import fresh

PAGE = """Text.

```sh
make demo                # installs
.venv/bin/tool 1  # a first answer
```

Run `source it` once, and `tool` suffices.

```console
$ echo one
one
$ pwd; false
…
[exit 1]
```
"""


def test_commands_are_typed_in_order_with_what_they_print() -> None:
    assert list(fresh.typed(PAGE)) == [
        ("make demo", None),
        (".venv/bin/tool 1", None),
        ("source it", None),
        ("echo one", ("one",)),
        ("pwd; false", ("…", "[exit 1]")),
    ]


def test_a_difference_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tmp_path.chmod(0o755)
    monkeypatch.setattr(fresh, "clone", lambda folder: folder)
    monkeypatch.setattr(fresh, "NOBODY", ())
    page = "```sh\nmissing-command\n```\n```console\n$ echo two\none\n$ echo $HOME; false\n…\n[exit 1]\n```\n"
    missing, two = fresh.type_all(page, tmp_path)
    assert missing.startswith("$ missing-command\n")
    assert missing.endswith("[exit 127]")
    assert two == "$ echo two\ntwo\n[exit 0]"


@pytest.mark.skipif(
    "ROADPROOF_FRESH" not in os.environ, reason="installs roadproof anew: set ROADPROOF_FRESH=1"
)
def test_a_new_user_types_the_readme() -> None:
    assert fresh.main() == 0
