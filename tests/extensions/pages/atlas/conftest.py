"""An atlas that the tests of this folder share."""

import pytest

import roadproof as rp


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory):
    """An atlas of three scenarios, from known answers where there are any."""
    folder = tmp_path_factory.mktemp("atlas")
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("ROADPROOF_KNOWN")
        return rp.atlas(out=folder, among="1,2,4", topics=("proofs", "drives", "overlaps"), jobs=1)
