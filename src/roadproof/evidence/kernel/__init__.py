"""Claims checked by Coq's kernel: printed, with a tableau that proves them, and put to ``coqc``.

docs/explanation/trust.md lists what is trusted. The printer (``printer.py``, ``names.py``) is: it says
what Coq proves. Tableaux, and how they are found, are not: Coq checks them.
"""
