#!/bin/sh
# The scenarios with another notion of danger: proofs, and a drive of scenario 1 under it.
# Usage: examples/time-to-collision/run.sh FOLDER   (FOLDER is for the drive; see output.txt)
set -e
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "${1:?name a folder}" && cd "$1"
roadproof show rssViolation --spec "$here/ttc.spec" | head -4
roadproof prove --spec "$here/ttc.spec" --claims "$here/claims.txt" | grep -E '^[A-Z]'
roadproof witness 1 --spec "$here/ttc.spec" --out drives --no-pictures | cut -c1-54
roadproof check drives --spec "$here/ttc.spec"
