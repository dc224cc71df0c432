"""Numbers on the command line: how much work, how long, how many processes; one meaning everywhere."""

import argparse
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.settings.flags import mark_rare
from roadproof.frontends.settings.readers import decimal

if TYPE_CHECKING:
    from roadproof.runtime.executors import Executor


def add_effort_options(
    parser: argparse.ArgumentParser, units: float = 60.0, each: str = "a question"
) -> None:
    """``--effort`` and ``--timeout``, which ``read_effort`` understands; ``each``: what they are given to."""
    parser.add_argument(
        "--effort",
        type=decimal("--effort"),
        default=units,
        metavar="N",
        help=f"about N solver seconds for {each} (default: {units:g}); counted, so the answer is the same on "
        "every machine",
    )
    mark_rare(
        parser.add_argument(
            "--timeout",
            type=decimal("--timeout"),
            metavar="S",
            help="seconds after which the clock ends a search, whatever work is left; the answer then says "
            "so (default: 60 for each unit of --effort, at least 600)",
        )
    )


def read_hands(args: argparse.Namespace) -> "Executor":
    """Who does the work, by ``--jobs``, and where a command has them ``--shard`` and ``--cluster``.

    Raises ``UsageError``.
    """
    from roadproof.frontends.cli.progress import note
    from roadproof.runtime.executors import Cluster, Executor, Shard

    said = vars(args)
    files = {name: said.get(f"tls_{name}") for name in ("ca", "cert", "key")}
    address, share = said.get("cluster"), said.get("shard")
    named = [f"--tls-{name}" for name, file in files.items() if file is not None]
    if named and address is None:
        raise UsageError(f"{named[0]} is for a cluster: name its scheduler with --cluster")
    if address is not None and args.jobs is not None:
        raise UsageError("--jobs says how many processes work here: ask for it or for --cluster")
    if share is not None and args.json is not None:
        raise UsageError("--shard has no answer to the whole: leave --json to the run without it")
    cluster = None if address is None else Cluster(address, files["ca"], files["cert"], files["key"], note)
    return Executor(args.jobs, cluster, None if share is None else Shard.read(share))
