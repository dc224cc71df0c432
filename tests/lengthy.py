"""Tests that take long: ``make test`` leaves them to ``make long``, and CI runs both.

A test is here when it takes more than about eight seconds of an idle core, and a quicker one beside it
asks the same of less: what it adds is breadth. Entries are beginnings of node ids.
"""

LENGTHY = (
    "tests/analysis/test_catalogue_completing.py::test_forged_classes_of_gaps_are_refused",
    "tests/analysis/test_classify.py::test_a_specification_beside_evidence_may_only_add",
    "tests/analysis/test_coverage_settling.py::test_an_empty_class_is_proved_and_the_certificate_checked",
    "tests/cli/test_book.py::test_page[attacks-",
    "tests/cli/test_book.py::test_page[book-classifying",
    "tests/cli/test_book.py::test_page[book-exploring",
    "tests/cli/test_book.py::test_page[book-recordings",
    "tests/cli/test_book.py::test_page[catalogue-README",
    "tests/cli/test_book.py::test_page[docs-interop",
    "tests/cli/test_book.py::test_page[docs-language",
    "tests/cli/test_book.py::test_page[motion-README",
    "tests/cli/test_book.py::test_page[python-README",
    "tests/cli/test_book.py::test_page[signals-README",
    "tests/cli/test_book.py::test_page[traffic-README",
    "tests/evidence/test_forged_folders.py::test_no_change_is_accepted_that_changes_what_is_said",
    "tests/fuzz/test_fuzz.py::test_a_fault_is_found_and_kept",
    "tests/kernel/test_accept.py",
    "tests/kernel/test_refused.py",
    "tests/proving/test_motion.py::test_a_planted_fault_in_what_is_assumed_is_noticed",
    "tests/traffic/test_exid.py::test_by_hand",
)
