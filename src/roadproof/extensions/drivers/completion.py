"""What a shell completes names of driver models with."""

from collections.abc import Mapping

from roadproof.extensions.drivers.models import MODELS


def models() -> Mapping[str, str]:
    """Driver models with their titles."""
    return {name: model.title for name, model in MODELS.items()}
