"""The studio: a local page that asks questions through the API, in worker processes."""
