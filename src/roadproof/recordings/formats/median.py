"""The median of more numbers than are to be held in memory."""

import tempfile
from typing import BinaryIO, cast

import numpy as np

from roadproof.recordings.formats.recording import Floats


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
            self._put_away()

    def _put_away(self) -> BinaryIO:
        if self.file is None:
            self.file = cast(BinaryIO, tempfile.TemporaryFile())  # noqa: SIM115
        for part in self.held:
            self.file.write(np.ascontiguousarray(part).tobytes())
        self.held = []
        self.file.flush()
        return self.file

    def value(self) -> float:
        """As ``np.median`` of them all; there must be one."""
        if self.file is None:
            return float(np.median(np.concatenate(self.held)))
        numbers = np.memmap(self._put_away(), np.float64)
        middle = [(self.count - 1) // 2, self.count // 2]
        numbers.partition(middle)
        return float(np.mean(numbers[middle]))
