"""Options are defined once: flags, keyword arguments and signatures follow the definitions."""

import inspect
from typing import get_args

import pytest

import roadproof as rp
from roadproof.engines.search.question import Engine, Objective
from roadproof.frontends.settings import keywords_file
from roadproof.frontends.settings.questions import Witness


def test_the_file_of_keyword_arguments_follows_the_definitions() -> None:
    remake = "run: python -m roadproof.frontends.settings.keywords_file"
    assert keywords_file.FILE.read_text("utf-8") == keywords_file.text(), remake


@pytest.mark.parametrize("question", keywords_file.all_questions(), ids=lambda x: x.__name__)
def test_a_function_shows_its_options(question: type) -> None:
    parameters = inspect.signature(getattr(rp, question.__name__.lower())).parameters
    shown = {name: x for name, x in parameters.items() if x.kind is x.KEYWORD_ONLY}
    for name, option in question.options().items():
        assert (name in shown) == option.keyword
        if option.keyword:
            assert shown[name].default == getattr(question, name)


def test_an_unknown_keyword_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'horizn'"):
        rp.witness(4, horizn=6)
    with pytest.raises(TypeError, match="unexpected keyword argument 'tls_ca'"):
        rp.witness(4, tls_ca="x")


def test_choices_are_those_of_the_types() -> None:
    options = Witness.options()
    assert options["engine"].choices == get_args(Engine)
    assert options["objective"].choices == get_args(Objective)
