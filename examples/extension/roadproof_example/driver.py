"""A driver model of one's own: one row, and its definitions in ``alert.spec``."""

from fractions import Fraction

from roadproof.extensions.drivers.driver_model import DriverModel, Law
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.response import Response, Scene

_NONE = Fraction(0)


def _respond(manoeuvre: ManoeuvreName, scene: Scene, settings: DriverSettings) -> Response | None:
    """Return full braking a fixed time after POV begins to brake."""
    begins = scene.braking(_NONE)
    if begins is None:
        return None
    phase = (None, -settings.values["alert_braking"], _NONE)
    return Response(begins + settings.values["alert_delay"], (phase,))


ALERT = DriverModel(
    name="alert",
    title="alert driver",
    source="an example",
    manoeuvres=("deceleration",),
    phrase="{a}, driven by an alert driver,",
    colour=("#555555", "var(--five)"),
    law=Law(
        respond=_respond,
        braking="alert_braking",
        specification="alert",
        restriction="alert_prevention",
        parameters=("alert_delay", "alert_braking"),
    ),
)
