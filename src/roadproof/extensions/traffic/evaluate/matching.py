"""A match: a scenario that happens in a recording; and one that may, as places are off."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Match:
    """One row of matches.csv; ``min_danger`` is an index into the settings', ids are the recording's.

    ``uncertain``: on a measured road, it depends on less than places may be off (``boundary``). Where driver
    models were asked for that speak of the scenario (``foretelling``): ``begun`` is the frame at which its
    manoeuvre begins, ``labels`` what becomes of it, in the order of the settings' drivers, empty where one
    says nothing of it.
    """

    sv: int
    pov: int
    pov2: int | None
    lane: str
    start_frame: int
    end_frame: int
    min_danger: int
    set_name: str
    scenario: int
    uncertain: bool = field(default=False, compare=False)
    begun: int | None = field(default=None, compare=False)
    labels: tuple[str, ...] = field(default=(), compare=False)

    @property
    def pair(self) -> tuple[int, int]:
        """The unordered pair that the match counts for: SV and its POV, or POV2 where there is one."""
        other = self.pov if self.pov2 is None else self.pov2
        return min(self.sv, other), max(self.sv, other)


@dataclass(frozen=True)
class PossibleMatch:
    """A scenario of two cars that a trace does not match, but may: places decide that are off by as much.

    ``first``, ``second``: the pair as in its trace (``Trace``); ``min_danger`` as in ``Match``.
    """

    first: int
    second: int
    min_danger: int
    set_name: str
    scenario: int

    @property
    def pair(self) -> tuple[int, int]:
        """The unordered pair."""
        return min(self.first, self.second), max(self.first, self.second)
