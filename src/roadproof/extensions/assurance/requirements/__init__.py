"""Requirements, and the claims, drives, tests and plates that show each of them."""
