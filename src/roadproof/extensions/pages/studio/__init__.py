"""The studio: a local web page for writing and trying formulas; worker processes answer its questions."""
