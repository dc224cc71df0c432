"""Which scenarios imply which: every implication proved, every other one refuted by a drive."""
