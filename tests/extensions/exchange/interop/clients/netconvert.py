"""SUMO's netconvert on OpenDRIVE files: lanes, widths and speeds of the network, against what is expected."""

import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

WIDEST, FASTEST = 0.005, 0.005
"""A network has two decimals."""


def check(path: str, expected: dict) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        network = Path(folder) / "net.xml"
        command = [str(Path(sys.executable).parent / "netconvert"), "--opendrive-files", path]
        found = subprocess.run([*command, "-o", str(network)], capture_output=True, text=True)
        told = [x for x in found.stderr.splitlines() if x.strip()]
        if found.returncode or told:
            return told or [f"exit code {found.returncode}"]
        read = ElementTree.parse(network).getroot()
        return list(on_bends(read) if expected["bends"] else differences(read, expected["sections"]))


def on_bends(network):
    """Sections are not in the order of x there, and roads of others have lanes in both directions."""
    if not [x for x in network.iter("edge") if x.get("function") != "internal"]:
        yield "no edge"


def differences(network, sections: list):
    edges = [x for x in network.iter("edge") if x.get("function") != "internal"]
    edges.sort(key=lambda x: float(x.find("lane").get("shape").split(",")[0]))
    if len(edges) != len(sections):
        yield f"{len(edges)} edges for {len(sections)} sections"
        return
    for edge, section in zip(edges, sections, strict=True):
        lanes = sorted(edge.iter("lane"), key=lambda x: -int(x.get("index")))  # from the left
        if len(lanes) != len(section["lanes"]):
            yield f"edge {edge.get('id')}: {len(lanes)} lanes, where the road has {len(section['lanes'])}"
            continue
        for lane, told in zip(lanes, section["lanes"], strict=True):
            name, width, speed = lane.get("id"), float(lane.get("width")), float(lane.get("speed"))
            if abs(width - told["width"]) > WIDEST:
                yield f"lane {name}: width {width}, where the road has {told['width']}"
            if abs(speed - told["speed"]) > FASTEST:
                yield f"lane {name}: speed {speed}, where the road has {told['speed']:.3f}"
            if lane.get("type") != told["type"]:
                yield f"lane {name}: type {lane.get('type')}, where the road has {told['type']}"


if __name__ == "__main__":
    asked, answer = map(Path, sys.argv[1:])
    files = json.loads(asked.read_text("utf-8"))
    answer.write_text(json.dumps({x: check(x, told) for x, told in files.items()}), "utf-8")
