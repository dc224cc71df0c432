"""A controller in another process: it answers each line of JSON with one."""

import json
import sys

for line in sys.stdin:
    message = json.loads(line)
    if "reset" in message:
        print("{}", flush=True)
        continue
    me, others = message["step"]["me"], message["step"]["others"]
    gaps = [x["s"] - x["length"] - me["s"] for x in others if abs(x["d"] - me["d"]) < x["width"]]
    near = any(0 < gap < me["v_lon"] for gap in gaps)
    print(json.dumps({"acceleration": -6.0 if near else 0.0}), flush=True)
