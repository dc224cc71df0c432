"""Signatures that show the keyword arguments of a question to ``help()``."""

import dataclasses
import inspect
from collections.abc import Callable
from typing import TypeVar

from roadproof.frontends.settings.option import Settings

F = TypeVar("F", bound=Callable[..., object])


def takes(settings: type[Settings]) -> Callable[[F], F]:
    """Marks a function whose ``**options`` are those of ``settings``."""

    def show(function: F) -> F:
        kinds, options = inspect.Parameter, settings.options()
        signature = inspect.signature(function)
        own = [x for x in signature.parameters.values() if x.kind is not kinds.VAR_KEYWORD]
        more = [
            kinds(x.name, kinds.KEYWORD_ONLY, default=x.default, annotation=x.type)
            for x in dataclasses.fields(settings)
            if options[x.name].keyword
        ]
        vars(function).update(__signature__=signature.replace(parameters=[*own, *more]))
        return function

    return show
