"""Pictures as a whole: nothing is cut off at their edges, and the same picture is the same file."""

from typing import Any

from report.edges import cut_off
from roadproof.frontends.report.figures import (
    as_bytes,
    count_axis,
    legend_beside,
    make_figure,
    name_rows,
    settle,
)


def an_example() -> Any:
    figure, axes = make_figure([2.0, 1.0], 6.0)
    axes[0].plot([0, 1], [0, 3], label="a line with a long name")
    legend_beside(axes[0])
    count_axis(axes[0].yaxis)
    name_rows(axes[1], ["first", "  a name that is moved in and rather long"])
    figure.suptitle("a title\non two lines")
    return figure


def test_nothing_is_cut_off() -> None:
    assert cut_off(an_example()) == []


def test_what_is_cut_off_is_noticed() -> None:
    figure = an_example()
    settle(figure)
    figure.axes[0].text(0.9, 1, "far too long for what is left " * 3)
    assert cut_off(figure) == ["far too long for what is left " * 3]


def test_counts_have_whole_ticks() -> None:
    [axes, _] = an_example().axes
    assert [*axes.get_yticks()] == [int(x) for x in axes.get_yticks()]


def test_the_same_picture_is_the_same_file() -> None:
    assert as_bytes(an_example()) == as_bytes(an_example())
