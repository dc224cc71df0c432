"""Classes of scenarios that exclude each other: a drive for each, and what is proved of them."""
