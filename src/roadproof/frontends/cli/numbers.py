"""Numbers on the command line: how much work, how long, how many processes; one meaning everywhere."""

import argparse
import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.cli.options import add_quiet_option

if TYPE_CHECKING:
    from roadproof.runtime.budget import Effort
    from roadproof.runtime.executors import Executor

_DECIMAL = re.compile(r"[0-9]{1,12}(\.[0-9]{1,12})?")
_WHOLE = re.compile(r"[0-9]{1,20}")
MOST = 1_000_000
LARGEST_SEED = 2**64 - 1


def add_effort_options(
    parser: argparse.ArgumentParser, units: float = 60.0, each: str = "a question"
) -> None:
    """``--effort`` and ``--timeout``, which ``read_effort`` understands; ``each``: what they are given to."""
    parser.add_argument(
        "--effort",
        type=decimal("--effort"),
        default=units,
        metavar="N",
        help=f"units of work for {each}, each about a second of a solver; counted, so the answer is the same "
        f"on every machine (default: {units:g})",
    )
    parser.add_argument(
        "--timeout",
        type=decimal("--timeout"),
        metavar="S",
        help="seconds after which the clock cuts one search off, whatever work is left; the answer then says "
        "so (default: 60 a unit of work, at least 600)",
    )


def read_effort(args: argparse.Namespace) -> "Effort":
    """What ``--effort`` and ``--timeout`` allow for one search."""
    from roadproof.runtime.budget import Effort

    return Effort(args.effort, args.timeout)


def add_working_options(parser: argparse.ArgumentParser) -> None:
    """``--jobs``: how many processes; ``--quiet``."""
    parser.add_argument(
        "--jobs", type=whole("--jobs", 1), metavar="N", help="processes (default: one a core)"
    )
    add_quiet_option(parser)


def add_sharing_options(parser: argparse.ArgumentParser) -> None:
    """``--shard``, ``--cluster`` and who may speak to it, which ``read_hands`` understands."""
    parser.add_argument(
        "--shard",
        metavar="K/N",
        help="the K-th of N shares, of runs that share --out; when all are done, ask once more without",
    )
    parser.add_argument(
        "--cluster",
        metavar="SCHEDULER|local:N",
        help="work on a cluster of dask, such as tcp://host:8786; or on one of N processes here",
    )
    for name, what in (("ca", "authority"), ("cert", "our certificate"), ("key", "its key")):
        parser.add_argument(
            f"--tls-{name}", metavar="FILE", help=f"{what}, for a cluster that is spoken to with TLS"
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


def decimal(option: str) -> Callable[[str], float]:
    """A reader of numbers greater than 0, which raises ``UsageError`` by the option's name."""

    def read(text: str) -> float:
        value = float(text) if _DECIMAL.fullmatch(text) else 0.0
        if not 0 < value <= MOST:
            raise UsageError(
                f"{option} {text[:40]}: write a decimal number greater than 0 and at most {MOST}, such as 20"
            )
        return value

    return read


def whole(option: str, least: int, most: int = MOST) -> Callable[[str], int]:
    """A reader of whole numbers from ``least`` to ``most``; it raises ``UsageError`` by the option's name."""

    def read(text: str) -> int:
        value = int(text) if _WHOLE.fullmatch(text) else least - 1
        if not least <= value <= most:
            rule = "greater than 0" if least == 1 else f"not below {least}"
            raise UsageError(f"{option} {text[:40]}: write a whole number {rule} and at most {most}")
        return value

    return read
