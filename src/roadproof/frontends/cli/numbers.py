"""Executors of long questions, by the flags that say who does the work."""

import argparse
from typing import TYPE_CHECKING

from roadproof.errors import UsageError

if TYPE_CHECKING:
    from roadproof.runtime.executors import Executor


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
        raise UsageError(f"{named[0]} requires --cluster SCHEDULER")
    if address is not None and args.jobs is not None:
        raise UsageError("--jobs and --cluster exclude each other: omit one of them")
    if share is not None and args.json is not None:
        raise UsageError("--shard gives a part of the answer: use --json in the run without --shard")
    cluster = None if address is None else Cluster(address, files["ca"], files["cert"], files["key"], note)
    return Executor(args.jobs, cluster, None if share is None else Shard.read(share))
