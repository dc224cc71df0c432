"""Answers of surveys to look at."""
