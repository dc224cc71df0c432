"""The median of more numbers than are to be held in memory."""

import tempfile
from collections.abc import Iterator
from typing import BinaryIO, cast

import numpy as np

from roadproof.recordings.formats.recording import Floats

_BINS = 1 << 12


class Median:
    """Numbers that are added bit by bit; more than ``most`` are put into a file without a name."""

    def __init__(self, most: int) -> None:
        self.most = most
        self.count = 0
        self.held: list[Floats] = []
        self.file: BinaryIO | None = None

    def add(self, numbers: Floats) -> None:
        self.count += len(numbers)
        self.held.append(numbers)
        if sum(map(len, self.held)) > self.most:
            if self.file is None:
                self.file = cast(BinaryIO, tempfile.TemporaryFile())  # noqa: SIM115
            for part in self.held:
                self.file.write(np.ascontiguousarray(part).tobytes())
            self.held = []

    def value(self) -> float:
        """As ``np.median`` of them all; there must be one."""
        if self.file is None:
            return float(np.median(np.concatenate(self.held)))
        low, high = (self._ordered(k) for k in ((self.count - 1) // 2, self.count // 2))
        return (low + high) / 2

    def _parts(self) -> Iterator[Floats]:
        assert self.file is not None
        self.file.seek(0)
        while content := self.file.read(8 * min(self.most, 1 << 20)):
            yield np.frombuffer(content)
        yield from self.held

    def _ordered(self, place: int) -> float:
        """The number at ``place`` in order: the range that it is in is narrowed until that can be held."""
        low = min(float(x.min()) for x in self._parts() if len(x))
        high = max(float(x.max()) for x in self._parts() if len(x))
        while low < high:
            edges = np.unique(np.linspace(low, high, _BINS + 1))
            counts = np.zeros(len(edges), np.int64)
            for part in self._parts():
                within = part[(part >= low) & (part <= high)]
                counts += np.bincount(np.searchsorted(edges, within, "left"), minlength=len(edges))
            below = sum(int(np.count_nonzero(part < low)) for part in self._parts())
            k = int(np.searchsorted(np.cumsum(counts), place - below, "right"))
            low, high = (edges[k], edges[k]) if k == 0 else (np.nextafter(edges[k - 1], np.inf), edges[k])
            if counts[k] <= self.most:
                inside = np.concatenate([x[(x >= low) & (x <= high)] for x in self._parts()])
                before = below + int(counts[:k].sum())
                return float(np.partition(inside, place - before)[place - before])
        return low
