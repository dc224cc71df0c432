"""Drives for other programs."""
