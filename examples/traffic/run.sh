#!/bin/sh
# Simulated traffic with two judged drives planted, evaluated; then one of the planted pairs.
# Usage: examples/traffic/run.sh FOLDER   (FOLDER is for recordings and results; see output.txt)
set -e
drives=$(cd "$(dirname "$0")" && pwd)/drives
mkdir -p "${1:?name a folder}" && cd "$1"
roadproof simulate --out traffic --recordings 1 --seconds 40 --seed 7 --plant "$drives" 2>/dev/null
cat traffic/planted.csv
roadproof evaluate traffic --out results --no-pictures --json - 2>/dev/null \
  | grep -E '"(recordings|violating|matching|traces)":'
head -4 results/matches.csv
row=$(sed -n 2p traffic/planted.csv)
pair=$(echo "$row" | cut -d, -f2,3)
frames=$(echo "$row" | cut -d, -f6,7 | tr , -)
roadproof monitor "$(echo "$row" | cut -d, -f10)" "traffic/01_tracks.csv:$pair" --frames "$frames"
