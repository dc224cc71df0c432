"""Searches that tests ask again and again: each is made once, for all modules that say so.

For tests of what is done with answers; tests of searches make theirs. A search is the same when all that is
handed over is. A module says ``pytestmark = pytest.mark.usefixtures("searched_once")``.
"""

from collections.abc import Hashable

from roadproof.engines.search.drive_search import _search_drive
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.setting import Search

_KNOWN: dict[Hashable, SearchOutcome] = {}


def ask_once(search: Search) -> SearchOutcome:
    """As ``engines.search.drive_search._search_drive``, of which it takes the place."""
    home, query = search.specification, search.query
    definitions = (home.library.fingerprint, home.set_name, *home.options.items())
    rest = repr((search.setting, search.search_options, search.unlike, search.scenario))
    key = (definitions, query.formula, query.text, query.written, query.vehicles, query.lanes, rest)
    if key not in _KNOWN:
        _KNOWN[key] = _search_drive(search)
    return _KNOWN[key]
