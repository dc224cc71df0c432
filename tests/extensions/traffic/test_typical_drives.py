"""The drives that come with roadproof are 24 different recordings."""

import pytest

import roadproof as rp


def test_evaluate_reads_the_24_drives_as_recordings(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before, it rejected them, since the drives of 9 and 17 were that of 1."""
    monkeypatch.delenv("ROADPROOF_KNOWN")
    drives = [x.drives[0] for x in rp.witness(jobs=1).outcomes]
    rp.export(drives, "csv", tmp_path / "csv")
    evaluation = rp.evaluate(tmp_path / "csv", jobs=1)
    assert not evaluation.failed
    assert len(evaluation.findings) == 24
