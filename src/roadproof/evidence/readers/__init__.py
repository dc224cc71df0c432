"""Readers of the files of answers, one for each kind of evidence."""
