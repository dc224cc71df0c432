"""Explorations: values of parameters and limits with a drive, and extremes of a measure."""
