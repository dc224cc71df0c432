"""Conjunctions and disjunctions: what is decided is seen at once, and nothing is nested without need."""

from roadproof.engines.encode.circuit import All, AnyOf, Leaf, all_of, any_of

A, B, C = Leaf("a"), Leaf("b"), Leaf("c")
TRUE, FALSE = All(()), AnyOf(())


def test_parts_of_the_same_kind_are_flattened():
    assert all_of([A, all_of([B, C])]).parts == (A, B, C)
    assert any_of([any_of([A, B]), C]).parts == (A, B, C)
    assert all_of([A, any_of([B, C])]).parts[0] is A


def test_what_is_decided_leaves_no_trace():
    assert all_of([TRUE, A, TRUE]) is any_of([FALSE, A, FALSE]) is A
    assert all_of([A, FALSE]) is FALSE
    assert any_of([A, TRUE]) is TRUE
    assert any_of([A, all_of([TRUE, TRUE])]).parts == ()


def test_the_same_part_is_there_once():
    assert all_of([A, A]) is any_of([A, A]) is A
