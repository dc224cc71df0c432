"""Questions: each lists claims and shows their answers; one loop settles them, and one check reads them."""
