"""Motions of vehicles in an OpenSCENARIO file whose storyboard has actions and triggers."""
