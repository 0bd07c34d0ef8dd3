"""Two processes with a slow network between them: latency.py PROGRAM SOURCE. Skipped unless POSEWRIGHT_LATENCY=1 says that
network namespaces may be made here (root, /dev/net/tun); bench/latency.sh makes them and removes them again."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = 77


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if os.environ.get("POSEWRIGHT_LATENCY") != "1" or os.geteuid() != 0:
        print("skipped: a delayed network is set up by hand: POSEWRIGHT_LATENCY=1 as root, which makes two network namespaces")
        return SKIPPED
    problem = source / "examples" / "kr270" / "problem.yaml"
    with tempfile.TemporaryDirectory() as folder:
        plan = pathlib.Path(folder) / "plan.json"
        subprocess.run([program, "plan", problem, "--method", "greedy", "--candidates", "200", "--proof-time", "0", "-o", plan,
                        "--poses-csv", "-"], check=True, stdout=subprocess.DEVNULL)
        done = subprocess.run(["sh", source / "bench" / "latency.sh", program, problem, plan, "600"], capture_output=True, text=True)
    print(done.stdout + done.stderr)
    ways = [float(way) for way in re.findall(r"there and back ([\d.]+) ms", done.stdout)]
    right = done.returncode == 0 and "the same result" in done.stdout and len(ways) == 2 and ways[0] < 1 <= ways[1]
    return 0 if right else 1


sys.exit(main())
