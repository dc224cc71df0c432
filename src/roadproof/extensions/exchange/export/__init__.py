"""Drives in the formats of other tools: OpenSCENARIO, OpenDRIVE, CommonRoad, highD, CSV."""
