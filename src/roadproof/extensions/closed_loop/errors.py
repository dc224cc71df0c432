"""The error of a vehicle under test: what it did, and when."""

from roadproof.errors import InputError


class ControllerError(InputError):
    """A controller that cannot be started, ends, is late, is not deterministic, or demands no number."""
