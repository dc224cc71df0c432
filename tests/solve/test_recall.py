"""Replies that are recalled are those that z3 gives, whatever was asked before and symbols are called."""

import random

import pytest

from roadproof.engines.solve import recall
from roadproof.engines.solve.recall import RecallingSession, Replies
from roadproof.engines.solve.smt import Session
from roadproof.runtime.budget import Effort


@pytest.fixture
def runs(monkeypatch):
    """What z3 is told from now on; nothing is known yet."""
    told = []
    run = Session._run

    def noted(self, commands):
        told.append(commands)
        return run(self, commands)

    monkeypatch.setattr(Session, "_run", noted)
    monkeypatch.setattr(recall, "REPLIES", Replies())
    return told


def dialogue(session, symbols, meter, *further):
    """Answers, cores and values in a session about numbers in an order; ``further``: what is told at last."""
    a, b, c = (f"|{x}|" for x in symbols)
    session.tell(f"(declare-const {a} Real)(declare-const {b} Real)(declare-const {c} Real)")
    session.tell(f"(declare-const up Bool)(declare-const down Bool)(assert (=> up (< {a} {b} {c})))")
    yield session.check(["up"], meter)
    yield session.values([a, f"(+ {b} 1.0)", f"(< {c} {a})"])
    session.tell(f"(assert (=> down (> {a} {c})))")
    yield session.check(["up", "down"], meter)
    yield session.core()
    for command in further:
        session.tell(command)
    yield session.check(["down"], meter)
    yield session.values([a, c])


def test_the_same_words_are_not_put_to_z3_again(runs):
    meters = [Effort(5).meter() for _ in range(2)]
    first = list(dialogue(RecallingSession(), "xyz", meters[0]))
    assert runs
    assert (first[0], first[2], set(first[3])) == ("sat", "unsat", {"up", "down"})
    runs.clear()
    assert list(dialogue(RecallingSession(), "xyz", meters[1])) == first
    assert runs == []
    assert meters[0].spent == meters[1].spent > 0


def test_symbols_may_be_called_otherwise_but_not_exchanged(runs):
    first = list(dialogue(RecallingSession(), ["x", "y", "z"], Effort(5).meter()))
    runs.clear()
    assert list(dialogue(RecallingSession(), ["main (a)", "merge (b)", "x"], Effort(5).meter())) == first
    assert runs == []
    session = RecallingSession()
    session.tell("(declare-const |x| Real)(declare-const |y| Real)(assert (< |x| |y|))")
    assert session.check([], Effort(5).meter()) == "sat"
    assert runs
    assert session.values(["(< |y| |x|)", "(< |x| |y|)"]) == [False, True]


def test_a_session_that_departs_from_another_gets_what_z3_says(runs):
    list(dialogue(RecallingSession(), "xyz", Effort(5).meter()))
    plain, recalling = (
        list(dialogue(session, "xyz", Effort(5).meter(), "(assert (> |x| 7.0))", "(assert (< |z| (- 1.0)))"))
        for session in (Session(), RecallingSession())
    )
    assert [recalling[k] for k in (0, 2, 4)] == [plain[k] for k in (0, 2, 4)]
    high, low = recalling[5]
    assert high > 7
    assert low < -1


def test_less_work_than_an_answer_took_does_not_give_it(runs):
    hard = "\n".join(clauses(100, 420))
    meter = Effort(50).meter()
    session = RecallingSession()
    session.tell(hard)
    answer = session.check([], meter)
    assert answer != "unknown"
    assert meter.spent > 0.02
    little = RecallingSession()
    little.tell(hard)
    assert little.check([], Effort(0.001).meter()) == "unknown"
    again = RecallingSession()
    again.tell(hard)
    assert again.check([], Effort(50).meter()) == answer


def clauses(names, count):
    """So many clauses of three literals, drawn at random."""
    source = random.Random(7)
    yield from (f"(declare-const |p{k}| Bool)" for k in range(names))
    for _ in range(count):
        literals = (
            f"|p{k}|" if source.random() < 0.5 else f"(not |p{k}|)" for k in source.sample(range(names), 3)
        )
        yield f"(assert (or {' '.join(literals)}))"


def test_what_is_kept_is_bounded(monkeypatch):
    monkeypatch.setattr(recall, "_MOST_CHARACTERS", 10)
    replies = Replies()
    for k in range(5):
        replies.store(bytes([k]), "sat" * 2)
    assert [replies.find(bytes([k])) for k in range(5)] == [None, None, None, None, "satsat"]
