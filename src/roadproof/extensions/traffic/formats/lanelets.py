"""Networks of recordings, whose vehicles are in at most as many lanes as a mask has bits."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.maps import network as maps
from roadproof.extensions.maps.network import Network
from roadproof.extensions.maps.topology import MeasuredLanelet
from roadproof.extensions.traffic.formats.straight import MOST_LANES


def network_of(path: Path, lanelets: Mapping[str, MeasuredLanelet], strict: bool = True) -> Network:
    """The network of the lanelets of ``path``, with the zones in the file beside it.

    Raises ``InputError`` for more than 32 lanes where it is ``strict``.
    """
    network = maps.network_of(path, lanelets)
    if strict and len(network.lanes) > MOST_LANES:
        message = f"{len(network.lanes)} lanes; at most {MOST_LANES} are supported, cut out a part"
        raise InputError(f"{path}: {message}")
    return network


def with_used_lanes(
    network: Network, is_used: Callable[[MeasuredLanelet], bool], name: str
) -> tuple[Network, tuple[str, ...]]:
    """The network with the lanes that ``is_used`` says are used, where it has more than a mask has bits.

    With a note on the others, which no vehicle is ever in. Raises ``InputError``, which begins with ``name``,
    where more are used.
    """
    known = network.lanes
    if len(known) <= MOST_LANES:
        return network, ()
    lanes = tuple(x for x in known if any(is_used(network.lanelets[y]) for y in x.lanelets))
    if len(lanes) > MOST_LANES:
        message = f"vehicles are in {len(lanes)} lanes; at most {MOST_LANES} are supported, cut out a part"
        raise InputError(f"{name}: {message}")
    names = {x.name for x in lanes}
    beside = frozenset(pair for pair in network.beside if pair <= names)
    message = f"left out {len(known) - len(lanes)} of {len(known)} lanes: no vehicle is ever in them"
    return replace(network, lanes=lanes, beside=beside), (message,)
