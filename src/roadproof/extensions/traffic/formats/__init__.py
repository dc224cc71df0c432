"""Recordings in foreign formats as samples on lanes, checked for plausibility."""
