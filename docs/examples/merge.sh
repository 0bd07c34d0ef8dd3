#!/bin/sh
# After array.sh: joins the logs and writes the result. What no part has is computed here.
#SBATCH --job-name=posewright-merge
#SBATCH --cpus-per-task=4
#SBATCH --time=00:30:00
set -eu
posewright merge part*.log -o whole.log
posewright simulate problem.yaml plan.json --draws 1000000 --resume whole.log --json > simulation.json
