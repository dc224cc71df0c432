"""Monitors of scenarios in C say what the monitor says, on traffic and on all witnesses."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.exchange.streaming.c_programs import (
    STRICT,
    TRUE,
    build,
    differences,
    needs_compiler,
    parted,
    said,
)
from extensions.traffic.monitoring.cases import DT, random_traffic
from roadproof.extensions.exchange.streaming.c_files import compile_c
from roadproof.extensions.traffic.evaluate.one_trace import sample_drive
from roadproof.library.bind import bind
from roadproof.semantics.sampled import compile

pytestmark = needs_compiler


@pytest.mark.parametrize("rss_form", ["boolean", "robust"])
def test_scenarios_on_ten_thousand_traces(rss_form: str, tmp_path: Path) -> None:
    home = rp.load("ext", options={"rss_form": rss_form}, params={"minSafe": "80 ms", "minDanger": "80 ms"})
    numbers = (1, 3, 4, 5, 6, 7, 8)
    compiled = rp.compile([*numbers, "danger(SV,POV)", "dangerArises(SV,POV)"], using=home).source
    roots = [home.read(n).formula for n in numbers]
    program = build(compiled, tmp_path)
    batch = random_traffic(roots, traces=5_000, longest=24)
    assert list(differences(compiled, program, batch)) == []
    verdicts = said(compiled, program, batch)
    assert all(np.any(verdicts[f"scenario_{n}"][:, 0] == TRUE) for n in (1, 4, 5, 6, 8))


# --- All witnesses ----------------------------------------------------------------------------------


@pytest.mark.parametrize("set_name", ["base", "extA", "ext"])
def test_all_witnesses(set_name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROADPROOF_KNOWN")
    home = rp.load(set_name)
    drives = {n: x.file for n, x in rp.known_drives(range(1, 25), home).items()}
    assert len(drives) == 24
    read, values = {n: home.read(n).formula for n in drives}, home.all_values()
    bound = {n: bind(read[n], x.road, x.lanes, values) for n, x in drives.items()}
    source = compile_c({f"scenario_{n}": (str(n), x) for n, x in bound.items()}, DT, "monitor", 65_536)
    flags = rp.compile("1-24", using=home).source
    program, with_flags = build(source, tmp_path / "bound", STRICT), build(flags, tmp_path / "flags", STRICT)
    for monitor, free, (n, file) in zip(source.monitors, flags.monitors, drives.items(), strict=True):
        batch = sample_drive(file.drive, file.road, file.horizon, DT, "drive").batch
        found = said(source, program, batch)[monitor.identifier]
        assert list(parted(monitor, batch, found)) == []
        assert found[-1, 2, 0] == TRUE  # a witness, with samples, too
        leaves = {x: bind(x, file.road, file.lanes, {}) for x in free.plan.leaves}
        truth = compile(leaves).evaluate(batch, at="all").answers
        given = {x: answer.true for x, answer in truth.items()}
        same = said(flags, with_flags, replace(batch, given=given))[free.identifier]
        assert np.array_equal(same, found), n
