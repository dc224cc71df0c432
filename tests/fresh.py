"""The README in the hands of a new user: a fresh clone, an empty home, and a login shell that has nothing.

``python -m fresh`` types every command of the README into this shell, in order, and compares what it prints
with the page. It installs roadproof into the clone, so it needs a network and some minutes. Where it runs as
root the shell belongs to ``nobody``.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from console import agree, sessions_of

ROOT = Path(__file__).parents[1]
MARK = "=== exit code"
KNOWN = " answers were known: "
"""In notes on stderr about answers that come with roadproof, which the README leaves out."""
NOBODY = ("runuser", "-u", "nobody", "--") if os.geteuid() == 0 else ()
PATH = "/usr/local/bin:/usr/bin:/bin"


def typed(page: str) -> Iterator[tuple[str, tuple[str, ...] | None]]:
    """The commands of a page in order, with what they print where the page shows it."""
    shown = {session.line: session for session in sessions_of(page)}
    inside = False
    for number, line in enumerate(page.splitlines(), start=1):
        if line.startswith("```"):
            inside = line == "```sh"
        elif inside and (command := line.partition("  #")[0].strip()):
            yield command, None
        elif number in shown:
            yield shown[number].command, shown[number].expected
        yield from ((x, None) for x in re.findall(r"Run `(source [^`]*)`", line) if not inside)


def clone(folder: Path) -> Path:
    """A clone of what is committed, which belongs to the user of the shell."""
    made = folder / "roadproof"
    subprocess.run(["git", "clone", "--quiet", "--no-local", str(ROOT), str(made)], check=True)
    if NOBODY:
        subprocess.run(["chown", "-R", "nobody:", str(folder)], check=True)
    return made


def type_all(page: str, folder: Path) -> list[str]:
    """What differs from the page when its commands are typed in a clone."""
    here = clone(folder)
    login = [*NOBODY, "env", "-i", f"HOME={folder}", f"PATH={PATH}", "TERM=dumb", "bash", "--login"]
    wrong = []
    with subprocess.Popen(
        login, cwd=here, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as shell:
        assert shell.stdin is not None
        assert shell.stdout is not None
        for command, expected in typed(page):
            print(f"$ {command}", flush=True)
            printed, code = answer(shell.stdin, shell.stdout, command)
            if expected is None and code:
                wrong.append("\n".join([f"$ {command}", *printed[-20:], f"[exit {code}]"]))
            elif expected is not None and not agree([*printed, *[f"[exit {code}]"] * bool(code)], expected):
                wrong.append("\n".join([f"$ {command}", *printed, f"[exit {code}]"]))
        shell.stdin.close()
    return wrong


def answer(shell: IO[str], says: IO[str], command: str) -> tuple[list[str], int]:
    """What the shell prints for a command, and its exit code."""
    shell.write(f"{command}\necho '{MARK}' $?\n")
    shell.flush()
    printed: list[str] = []
    for line in says:
        before, mark, code = line.rstrip("\n").partition(MARK)
        printed += [before] if (before or not mark) and KNOWN not in before else []
        if mark:
            return printed, int(code)
    raise RuntimeError(f"the shell ended after: {command}")


def main() -> int:
    folder = Path(tempfile.mkdtemp(prefix="fresh-"))
    folder.chmod(0o755)
    try:
        wrong = type_all((ROOT / "README.md").read_text("utf-8"), folder)
    finally:
        shutil.rmtree(folder)
    print("\n\n".join(wrong) or "every command of the README does what the page says")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
