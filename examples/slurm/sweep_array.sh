#!/bin/sh
# SPDX-License-Identifier: MIT
# A sweep as an array of jobs under Slurm, a part a job:
#
#     sbatch --array=1-16 examples/slurm/sweep_array.sh sambeek-performance results
#     gnomon merge results/part-*.sqlite -o all.sqlite --report report      when all have ended
#
# A job that was cut short by its time limit goes on where it stopped when it is submitted again: nothing is lost, and nothing
# is measured twice. Parts share no file, so that no file system has to lock any. Times compare only between machines that are
# alike: ask for such nodes, and for all of a node.
#SBATCH --job-name=gnomon-sweep
#SBATCH --array=1-4
#SBATCH --ntasks=1
#SBATCH --exclusive
#SBATCH --time=08:00:00
#SBATCH --requeue
set -eu

sweep=${1:?usage: sweep_array.sh SWEEP FOLDER [OPTIONS OF gnomon sweep...]}
folder=${2:?usage: sweep_array.sh SWEEP FOLDER [OPTIONS OF gnomon sweep...]}
shift 2

part=${SLURM_ARRAY_TASK_ID:?is set by sbatch --array}
parts=${SLURM_ARRAY_TASK_COUNT:?is set by sbatch --array}
mkdir -p "$folder"

# exec: the signal that Slurm sends before a limit reaches the command, which then ends after the run at hand.
exec "${GNOMON:-gnomon}" sweep "$sweep" --shard "$part/$parts" -o "$folder/part-$part.sqlite" "$@"
