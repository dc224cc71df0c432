"""Runs the storyboards in esmini and keeps the positions.

Call it as python tests/extensions/traffic/esmini_record.py LIBRARY VERSION.
LIBRARY is libesminiLib.so, built without viewer from the public source. Positions are x and y of reference
points in m, and speeds in m/s, every half second; steps are those of the reader.
"""

import ctypes
import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from extensions.traffic.storyboards import BOARDS, EVERY, SECONDS, files

STEP = 0.01
KEPT = Path(__file__).with_name("esmini.json")
_NUMBERS, _WHOLE = ctypes.c_double, ctypes.c_int


class State(ctypes.Structure):
    """SE_ScenarioObjectState of esmini 3.6."""

    _fields_ = [
        *((x, _WHOLE) for x in ("id", "model", "control")),
        *((x, _NUMBERS) for x in ("timestamp", "x", "y", "z", "h", "p", "r")),
        *((x, ctypes.c_uint32) for x in ("road", "junction")),
        ("t", _NUMBERS),
        ("lane", _WHOLE),
        *((x, _NUMBERS) for x in ("offset", "s", "speed", "cx", "cy", "cz", "width", "length", "height")),
        *((x, _WHOLE) for x in ("type", "category")),
        *((x, _NUMBERS) for x in ("wheel_angle", "wheel_turn")),
        ("visible", _WHOLE),
    ]


def run(library: ctypes.CDLL, path: Path) -> dict[str, list[list[float]]]:
    """Rows of x, y and speed by vehicle; of one that is absent fewer."""
    if library.SE_Init(str(path).encode(), 0, 0, 0, 0) != 0:
        raise SystemExit(f"{path}: esmini refuses it; see its log")
    found: dict[str, list[list[float]]] = {}
    each = round(EVERY / STEP)
    for tick in range(round(SECONDS / STEP) + 1):
        for k in range(library.SE_GetNumberOfObjects() if tick % each == 0 else 0):
            number, state = library.SE_GetId(k), State()
            library.SE_GetObjectState(number, ctypes.byref(state))
            name = library.SE_GetObjectName(number).decode()
            found.setdefault(name, []).append([round(x, 3) for x in (state.x, state.y, state.speed)])
        library.SE_StepDT(_NUMBERS(STEP))
    library.SE_Close()
    return found


def main(path: str, version: str) -> None:
    library = ctypes.CDLL(path)
    library.SE_GetObjectName.restype = ctypes.c_char_p
    library.SE_LogToConsole(ctypes.c_bool(False))
    kept = {}
    with tempfile.TemporaryDirectory() as folder:
        library.SE_SetLogFilePath(f"{folder}/log.txt".encode())
        for name in BOARDS:
            kept[name] = run(library, files(Path(folder), name))
    rows = ",\n".join(
        f"{json.dumps(name)}:{json.dumps(x, separators=(',', ':'))}" for name, x in kept.items()
    )
    head = json.dumps({"esmini": version, "step": STEP, "every": EVERY})
    KEPT.write_text(f'{{"made":{head},"boards":{{\n{rows}\n}}}}\n', "utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
