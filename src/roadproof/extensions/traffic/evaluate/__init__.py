"""Scenarios in recordings: how often each occurs, with results that can be checked."""
