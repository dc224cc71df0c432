"""``python -m roadproof``: the command line."""

import sys

from roadproof.frontends.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
