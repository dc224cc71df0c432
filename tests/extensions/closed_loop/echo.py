"""A controller in another process: a command that speaks JSON lines, and some that do not."""

import json
import sys
import time

how = sys.argv[1]
for count, line in enumerate(sys.stdin):
    message = json.loads(line)
    if "reset" in message:
        assert message["reset"]["lanes"]
        print("{}", flush=True)
        continue
    others = message["step"]["others"]
    gap = others[0]["s"] - others[0]["length"] - message["step"]["me"]["s"]
    if how == "late":
        time.sleep(60)
    if how == "dies" and count > 20:
        print("out of fuel", file=sys.stderr)
        sys.exit(3)
    if how == "words":
        print("brake!", flush=True)
        continue
    if how == "empty":
        print("{}", flush=True)
        continue
    print(json.dumps({"acceleration": -9.0 if 0 < gap < 8 else 0.0, "lateral": None}), flush=True)
