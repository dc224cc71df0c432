"""The samples of a test into which a driver model is put, from a batch of one trace."""

from fractions import Fraction

from roadproof.extensions.drivers.sampled_replay import TRACKED, SampledScene, Track
from roadproof.semantics.sampled.batch import Batch
from roadproof.world.road import Road
from roadproof.world.signals import SIZES


def scene_of(batch: Batch, road: Road, vehicles: tuple[str, ...], since: Fraction) -> SampledScene:
    """Return the first trace of a batch as a scene whose scenario holds from ``since`` (s) on."""
    tracks = {name: _track(batch, name) for name in vehicles}
    return SampledScene(tracks, road, vehicles, batch.dt, round(since / batch.dt))


def _track(batch: Batch, name: str) -> Track:
    count = int(batch.lengths[0])
    s, d, v_lon, v_lat, a_lon = (batch.signals[x, name][:count, 0] for x in TRACKED)
    return Track(s, d, v_lon, v_lat, a_lon, *(float(batch.sizes[x, name][0]) for x in SIZES))
