#!/bin/sh
# bench/scaling.sh [PROGRAM]: time and peak memory of `select` on Gaussian blocks of 9 × 33 from 10,000 to 1,000,000 of
# them, N = 18, certificate included. Needs python3-numpy, GNU time, 5 GiB of disk and 4 GiB of memory.
set -eu
program=${1:-build/release/bin/posewright}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo "blocks,seconds,peak MiB,blocks MiB,efficiency"
for n in 10000 31623 100000 316228 1000000; do
  # Written piece by piece: numpy need not hold it all.
  python3 - "$folder/blocks.npy" "$n" <<'PY'
import sys, numpy as np
n = int(sys.argv[2])
out = np.lib.format.open_memmap(sys.argv[1], mode="w+", dtype="<f8", shape=(n, 9, 33))
random = np.random.default_rng(20240005)
for first in range(0, n, 20000):
    out[first:first + 20000] = random.standard_normal((min(20000, n - first), 9, 33))
out.flush()
PY
  /usr/bin/time -f "%e %M" -o "$folder/time" "$program" select "$folder/blocks.npy" --poses 18 --restarts 10 \
    -o "$folder/plan.json" --quiet --force >/dev/null
  python3 - "$folder/plan.json" "$folder/time" "$n" <<'PY'
import json, sys
seconds, peak = open(sys.argv[2]).read().split()
n = int(sys.argv[3])
plan = json.load(open(sys.argv[1]))
print(f"{n},{seconds},{int(peak) / 1024:.0f},{n * 9 * 33 * 8 / 2**20:.0f},"
      f"{plan['certificate']['candidates']['efficiency']:.4f}")
PY
  rm -f "$folder/blocks.npy" "$folder/plan.json"
done
