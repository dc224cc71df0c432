"""``roadproof cache``: what is kept for later runs of this user, how large it is, and how to remove it."""

import argparse

from roadproof.errors import InputError
from roadproof.verdict import ExitCode

SUMMARY = "show or remove the answers that are kept for later runs"

EXAMPLES = """\
examples:
  roadproof cache                      the folder, and how many answers it keeps
  roadproof cache --clear              remove them; they are computed again when they are asked for
  ROADPROOF_CACHE=off roadproof ...    keep nothing, and read nothing that was kept
  XDG_CACHE_HOME=DIR roadproof ...     another place than ~/.cache

An answer counts again for the same question, version, options and limits, as long as the definitions and
parameters that it uses have not changed. The oldest are removed beyond 200 MB, and after 60 days without use.
`roadproof check` never reads them.
"""
_FOLDERS = {
    "answers": "answers",
    "judged": "judged answers",
    "checked": "accepted files",
    "made": "texts that were read",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--clear", action="store_true", help="remove what is kept")


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.runtime.cache import files, private_folder

    home = private_folder("answers")
    if home is None:
        print("nothing is kept: the cache is off, or others may write into its folder")
        return ExitCode.AS_EXPECTED
    print(home.parent)
    for name, what in _FOLDERS.items():
        stored = files(name)
        size = sum(status.st_size for status in stored.values())
        for path in stored if args.clear else ():
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                raise InputError(f"cannot remove {path}: {error.strerror}") from None
        print(f"{len(stored):>6} {what}, {size / 1e6:.1f} MB" + (", removed" if args.clear else ""))
    return ExitCode.AS_EXPECTED
