#!/bin/sh
# sbatch processes.sh: one command, shared by a process on each of eight machines.
#SBATCH --job-name=posewright
#SBATCH --nodes=8
#SBATCH --ntasks-per-node=1
#SBATCH --cpus-per-task=16
#SBATCH --time=02:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
set -eu
# Started again after a failure it goes on from the log.
srun posewright simulate problem.yaml plan.json --draws 1000000 --threads "$SLURM_CPUS_PER_TASK" --resume draws.log
