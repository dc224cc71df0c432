"""Parts of OpenSCENARIO files that are not read, since they do not change how a vehicle moves.

Everything else that is not read is named in the notes of the recording (``Document.left_out``).
"""

from collections.abc import Mapping

_LOOKS = "appearance, which no formula sees"
_WEATHER = "weather and light; vehicles move as the storyboard says in any weather"
_DESCRIPTION = "description for people"
_PHYSICS = "a property of vehicle dynamics; vehicles move as the storyboard says"
_PLAN = "heights, pitch and roll: motion is read in plan"
_SIGNALS = "traffic lights and signs, which move no vehicle that does as the storyboard says"
_NAMES = "a name or a type, which only messages use"

HARMLESS: Mapping[str, str] = {
    "FileHeader": _DESCRIPTION,
    "@name": _NAMES,
    "ParameterDeclaration@parameterType": _NAMES,
    "VariableDeclaration@variableType": _NAMES,
    "CatalogLocations": "folders; a catalogue is read where a CatalogReference names an entry",
    "CatalogReference@catalogName": _NAMES,
    "SceneGraphFile": _LOOKS,
    "TrafficSignals": _SIGNALS,
    "InfrastructureAction": _SIGNALS,
    "UsedArea": "the part of the map that simulators load",
    "EnvironmentAction": _WEATHER,
    "VisibilityAction": _LOOKS,
    "AppearanceAction": _LOOKS,
    "LightStateAction": _LOOKS,
    "Axles": _PHYSICS,
    "Properties": "properties that each simulator defines for itself",
    "MonitorDeclarations": "results for a test bench, which move no vehicle",
    "Vehicle@mass": _PHYSICS,
    "Vehicle@model3d": _LOOKS,
    "Vehicle@role": _NAMES,
    "Pedestrian@mass": _PHYSICS,
    "Pedestrian@model": _LOOKS,
    "Pedestrian@model3d": _LOOKS,
    "Pedestrian@role": _NAMES,
    "Pedestrian@pedestrianCategory": _NAMES,
    "MiscObject@mass": _PHYSICS,
    "MiscObject@model3d": _LOOKS,
    "MiscObject@miscObjectCategory": _NAMES,
    "Dimensions@height": _PLAN,
    "Center@z": _PLAN,
    "@dz": _PLAN,
    "@p": _PLAN,
    "@r": _PLAN,
    "@z": _PLAN,
    "Performance@maxAccelerationRate": _PHYSICS,
    "Performance@maxDecelerationRate": _PHYSICS,
}
