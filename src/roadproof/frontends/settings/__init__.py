"""The options of each question, defined once: flags and keyword arguments are made from the definitions."""
