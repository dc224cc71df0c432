"""``python -m roadproof``: the command line."""

import sys

from roadproof.frontends.cli.entry import main

if __name__ == "__main__":
    sys.exit(main())
