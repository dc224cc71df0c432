"""All of the package is imported before the first test.

A module that is imported while a test has replaced something would keep the replacement for good.
"""

import pkgutil
from importlib import import_module

import roadproof

for _each in pkgutil.walk_packages(roadproof.__path__, "roadproof."):
    if not _each.name.endswith("__main__"):
        import_module(_each.name)
