#!/bin/sh
# job=$(sbatch --parsable array.sh) && sbatch --dependency=afterok:"$job" merge.sh
# Forty jobs that know nothing of each other; no MPI is needed.
#SBATCH --job-name=posewright-part
#SBATCH --array=1-40
#SBATCH --cpus-per-task=16
#SBATCH --time=01:00:00
set -eu
part=$SLURM_ARRAY_TASK_ID
posewright simulate problem.yaml plan.json --draws 1000000 --threads "$SLURM_CPUS_PER_TASK" \
  --shard "$part/40" --resume "part$part.log"
