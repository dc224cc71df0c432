"""Answers about traffic to look at."""
