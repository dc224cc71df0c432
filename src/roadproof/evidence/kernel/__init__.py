"""Claims checked by Coq's kernel: printed, with a tableau that proves them, and put to ``coqc``.

What has to be believed is in docs/trust.md. The printer (``printer.py``, ``names.py``) is trusted: it says
what Coq proves. Tableaux, and how they are found, are not: Coq checks them.
"""
