"""Recordings on straight roads put into the plane in exiD's format, with a Lanelet2 map."""

import math
from pathlib import Path

import numpy as np

from extensions.traffic.planar import Bend, moving, straight
from roadproof.extensions.traffic.formats.recording import Floats, Recording
from roadproof.world.road import Lanelet, Road

LOCATION, RECORDING = 3, 7
META = "recordingId,locationId,frameRate,speedLimit,numTracks,latLocation,lonLocation,xUtmOrigin,yUtmOrigin"
VEHICLES = "recordingId,trackId,initialFrame,finalFrame,numFrames,width,length,class"
SAMPLES = (
    "recordingId,trackId,frame,trackLifetime,xCenter,yCenter,heading,width,length,xVelocity,yVelocity,"
    "xAcceleration,yAcceleration,lonVelocity,latVelocity,lonAcceleration,latAcceleration,traveledDistance,"
    "latLaneCenterOffset,laneWidth,laneletId,laneChange,lonLaneletPos,laneletLength,leadDHW,leadDV,leadTHW,"
    "leadTTC,leadId,rearId,leftLeadId,leftRearId,leftAlongsideId,rightLeadId,rightRearId,rightAlongsideId"
)
ENDS = (-600.0, 900.0)


def write_exid(
    recording: Recording, road: Road, folder: Path, bend: Bend = straight, map_text: str = ""
) -> Path:
    """The files of recording 07 and ``maps/location3.osm``; the path of the samples.

    A box is turned by its motion, and vehicles have numbers from 0 on.
    """
    (folder / "maps").mkdir(parents=True, exist_ok=True)
    (folder / "maps" / f"location{LOCATION}.osm").write_text(map_text or osm_of(road, bend))
    about = f"{RECORDING},{LOCATION},{recording.rate},-1,{recording.vehicles},50.8,6.1,300000,5600000"
    (folder / "07_recordingMeta.csv").write_text(f"{META}\n{about}\n")
    vehicles, samples = [VEHICLES], [SAMPLES]
    for v in range(recording.vehicles):
        first, last = int(recording.first_frame[v]), int(recording.last_frame[v])
        length, width = float(recording.length[v]), float(recording.width[v])
        kind = str(recording.kind[v]).lower()
        vehicles.append(f"{RECORDING},{v},{first},{last},{last - first + 1},{width},{length},{kind}")
        samples += _rows(recording, v, road, bend)
    (folder / "07_tracksMeta.csv").write_text("\n".join(vehicles) + "\n")
    path = folder / "07_tracks.csv"
    path.write_text("\n".join(samples) + "\n")
    return path


def _rows(recording: Recording, v: int, road: Road, bend: Bend) -> list[str]:
    rows = slice(recording.start[v], recording.start[v + 1])
    length, width = recording.length[v], recording.width[v]
    s, d = recording.s[rows] - length / 2, recording.d[rows] - width / 2
    x, y, way = bend(s, d)
    v_lat = recording.v_lat[rows]
    along, rate, yaw = moving(recording, rows, bend, s, d)
    heading = way + np.arctan2(v_lat, along)
    velocity = turned(along, v_lat, way)
    pull = turned(rate - yaw * v_lat, recording.a_lat[rows] + yaw * along, way)
    own = [turned(*vector, -heading) for vector in (velocity, pull)]
    made = []
    for k in range(len(s)):
        here = [str(n) for n, z in numbers(road).items() if holds(road, n, s[k], d[k])]
        values = [
            *(RECORDING, v, int(recording.first_frame[v]) + k, k, x[k], y[k]),
            *(math.degrees(heading[k]) % 360, width, length, *(z[k] for z in (*velocity, *pull))),
            *(z[k] for pair in own for z in pair),
            *(s[k] - s[0], f"{0.0};{0.0}" if len(here) > 1 else 0.0, 3.5, ";".join(here), 0, 0, 400),
            *(-1, -1000, -1, -1, *[-1] * 8),
        ]
        made.append(",".join(f"{z:.5f}" if isinstance(z, float) else str(z) for z in values))
    return made


def turned(along: Floats, across: Floats, by: Floats) -> tuple[Floats, Floats]:
    return along * np.cos(by) - across * np.sin(by), along * np.sin(by) + across * np.cos(by)


def numbers(road: Road) -> dict[int, Lanelet]:
    """Ids of relations; those of ways and nodes begin at 1, too."""
    return dict(enumerate(road.lanelets, start=1))


def holds(road: Road, number: int, s: float, d: float) -> bool:
    x = numbers(road)[number]
    low, high = span(x)
    return low <= s < high and float(x.d[0]) <= d < float(x.d[1])


def span(x: Lanelet) -> tuple[float, float]:
    return ENDS[0] if x.s[0] is None else float(x.s[0]), ENDS[1] if x.s[1] is None else float(x.s[1])


def osm_of(road: Road, bend: Bend = straight, step: float = 10.0, local: bool = True) -> str:
    """Ways are shared by lanelets that have the same span; every second one is drawn backwards."""
    nodes: dict[tuple[float, float], int] = {}
    ways: dict[tuple[float, float, float], tuple[int, list[int]]] = {}
    relations = []
    for number, x in numbers(road).items():
        low, high = span(x)
        members = []
        for role, d in (("right", float(x.d[0])), ("left", float(x.d[1]))):
            if (low, high, d) not in ways:
                at = np.linspace(low, high, 1 + math.ceil((high - low) / step)).tolist()
                refs = [nodes.setdefault((s, d), len(nodes) + 1) for s in at]
                ways[low, high, d] = len(ways) + 1, refs[:: -1 if len(ways) % 2 else 1]
            members.append(f'<member type="way" role="{role}" ref="{ways[low, high, d][0]}"/>')
        tags = '<tag k="type" v="lanelet"/><tag k="subtype" v="highway"/><tag k="one_way" v="yes"/>'
        relations.append(f'<relation id="{number}">{"".join(members)}{tags}</relation>')
    drawn = []
    for (s, d), number in nodes.items():
        x, y, _ = (float(z[0]) for z in bend(np.array([s]), np.array([d])))
        tags = f'<tag k="local_x" v="{x!r}"/><tag k="local_y" v="{y!r}"/>' if local else ""
        lat, lon = (0.0, 0.0) if local else degrees_of(300000 + x, 5600000 + y)
        drawn.append(f'<node id="{number}" lat="{lat!r}" lon="{lon!r}">{tags}</node>')
    for number, refs in ways.values():
        inner = "".join(f'<nd ref="{ref}"/>' for ref in refs)
        drawn.append(f'<way id="{number}">{inner}<tag k="type" v="line_thin"/></way>')
    return '<?xml version="1.0"?>\n<osm version="0.6">\n' + "\n".join((*drawn, *relations)) + "\n</osm>\n"


def degrees_of(east: float, north: float) -> tuple[float, float]:
    """The point of zone 32 with this place in UTM, found by Newton's method."""
    from roadproof.extensions.traffic.formats.exid import utm_of

    point = np.array([50.0, 9.0])
    for _ in range(20):
        here = utm_of(point[:1], point[1:])[0]
        step = 1e-6
        slopes = [
            (utm_of(point[:1] + a * step, point[1:] + b * step)[0] - here) / step for a, b in ((1, 0), (0, 1))
        ]
        point = point + np.linalg.solve(np.array(slopes).T, np.array([east, north]) - here)
    return float(point[0]), float(point[1])
