"""Results of any kind as one page that needs no network."""
