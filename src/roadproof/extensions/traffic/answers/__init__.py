"""The JSON documents of answers about recordings and traces."""
