"""The templates of the page: this module alone imports jinja2, and only when a page is written."""

from functools import cache
from typing import TYPE_CHECKING

from roadproof.frontends.report.page.pieces import counted, in_unit, notes, short, sign

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, PackageLoader, StrictUndefined

    made = Environment(
        loader=PackageLoader("roadproof.frontends.report.page"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {"counted": counted, "in_unit": in_unit, "notes": notes, "short": short, "sign": sign}
    return made


def render(template: str, **values: object) -> str:
    """A template of the folder ``templates`` as HTML; it escapes every text in ``values``."""
    return _environment().get_template(template).render(values)
