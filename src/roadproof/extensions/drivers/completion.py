"""Names of driver models for the completion of a shell."""

from collections.abc import Mapping

from roadproof.extensions.drivers.models import MODELS


def models() -> Mapping[str, str]:
    """Driver models with their titles."""
    return {name: model.title for name, model in MODELS.items()}
