"""The entry point of the program: prints its help at once, and leaves all else to ``cli.main``."""

import sys

from roadproof.frontends.cli.streams import make_streams_lenient


def main() -> int:
    """Run the command line of this process and return its exit code."""
    make_streams_lenient()
    try:
        from roadproof.frontends.cli.overview import overview
    except Exception as error:
        return _refuse(error)
    if sys.argv[1:] in (["--help"], ["-h"]):
        try:
            print(overview(), end="", flush=True)
            return 0
        except OSError:
            pass  # tried again, and told
    from roadproof.frontends.cli.main import main as run

    return run()


def _refuse(error: Exception) -> int:
    """Print which extension cannot be used; return the exit code."""
    from roadproof.errors import RoadproofError

    if not isinstance(error, RoadproofError):
        raise error
    print(f"roadproof: {error}", file=sys.stderr)
    return int(error.exit_code)
