"""Where the program starts: prints its help at once, and leaves all else to ``cli.main``."""

import sys

from roadproof.frontends.cli.overview import overview
from roadproof.frontends.cli.streams import make_streams_lenient


def main() -> int:
    """Run the command line of this process and return its exit code."""
    if sys.argv[1:] in (["--help"], ["-h"]):
        make_streams_lenient()
        try:
            print(overview(), end="", flush=True)
            return 0
        except OSError:
            pass  # tried again, and told
    from roadproof.frontends.cli.main import main as run

    return run()
