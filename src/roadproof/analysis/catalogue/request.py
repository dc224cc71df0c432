"""What is asked of a catalogue: which tests, and what of them is looked at."""

from dataclasses import dataclass

from roadproof.analysis.catalogue.showing import Freedom
from roadproof.drivers.models import MODELS
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answers.catalogue_index import KeptRequest, Look
from roadproof.evidence.codec import read
from roadproof.library.specification import unknown

_CHOICES = ("roles", "lanes", "start")


@dataclass(frozen=True)
class Request:
    """``paths``: folders of tests, and tests. ``sets``: spec sets, of which the first is asked about.

    ``classes``, ``gaps``, ``explore``: whether classes of scenarios, classes of gaps and ranges are asked
    about too. ``roles``, ``lanes``, ``start``: whether those are looked at that a test fixes, or "any".
    ``near``: how far apart tests that say the same may begin, in m and m/s. ``drivers``: the models that are
    asked what becomes of tests. Raises ``UsageError``.
    """

    paths: tuple[str, ...]
    sets: tuple[str, ...] = ("base",)
    classes: bool = True
    gaps: bool = False
    explore: bool = False
    roles: Look = "fixed"
    lanes: Look = "fixed"
    start: Look = "fixed"
    near: float = 0.5
    drivers: tuple[str, ...] = tuple(MODELS)

    def __post_init__(self) -> None:
        for name in _CHOICES:
            if getattr(self, name) not in ("fixed", "any"):
                raise UsageError(f"{name}={getattr(self, name)!r}: write 'fixed' or 'any'")
        for name in self.drivers:
            if name not in MODELS:
                raise UsageError(f"drivers={','.join(self.drivers)}: {unknown('driver model', name, MODELS)}")
        if not self.near >= 0:
            raise UsageError(f"near={self.near}: write a number, 0 or more")

    @property
    def freedom(self) -> Freedom:
        """What is looked at beside what a test fixes."""
        return Freedom(self.roles == "any", self.lanes == "any", self.start == "any")

    @property
    def kept(self) -> KeptRequest:
        """As an index has it."""
        return KeptRequest(**vars(self))


def read_request(content: object, where: str) -> Request:
    """A request as an index has it. Raises ``InputError``."""
    try:
        return Request(**vars(read(KeptRequest, content, where)))
    except UsageError as error:
        raise InputError(f"{where}: {error}") from None
