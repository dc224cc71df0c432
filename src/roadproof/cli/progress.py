"""Progress on stderr: a line for each thing that is done."""

import sys


def tell(line: str) -> None:
    """Say ``line`` to whoever watches; results go to stdout."""
    print(line, file=sys.stderr, flush=True)
