"""``roadproof atlas``: write static pages about all scenarios, with the evidence for each statement."""

import argparse

from roadproof.extensions.pages.settings import AtlasSettings
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.options import read_executor
from roadproof.frontends.cli.progress import Counter, clear
from roadproof.frontends.settings.flags import read_keywords

SUMMARY = "write pages about all scenarios, with drives and proofs"

EXAMPLES = """\
examples:
  roadproof atlas --out atlas                             all scenarios of set base: open atlas/index.html
  roadproof atlas --out atlas --set ext                   those of set ext
  roadproof atlas --out atlas --among 1-8 --topics drives,overlaps   a part of it

The pages need no network and no scripts. Known answers take seconds; others are computed, often for long.
`roadproof check atlas/evidence` checks the evidence again.
"""
OPTIONS = AtlasSettings


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.pages.atlas.atlas import atlas

    home = read_definitions(args, AtlasSettings)
    changed = args.specs or args.readings or home.sets != ("base",)
    keywords = read_keywords(args, AtlasSettings) | {"jobs": read_executor(args), "progress": Counter()}
    written = atlas(home if changed else None, **keywords)
    clear()
    print(written)
    return written.exit_code
