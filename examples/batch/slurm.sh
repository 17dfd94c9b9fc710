#!/bin/bash
# A batch on Slurm: an array of shards, and the merge when all of them have ended well.
#
#   slurm.sh LIST FOLDER SHARDS RESULT [OPTION OF SBATCH ...]
#   slurm.sh jobs.txt /shared/results 8 sheet.png --cpus-per-task=2 --mem=2G
#
# The list, the folder and coif (or COIF, its path) must be seen by all nodes under the same names. A shard should take
# from some seconds to some minutes: an empty task costs Slurm half a second. After a failure the same call again does
# only what is not done yet.
set -euo pipefail
list=$1 folder=$2 shards=$3 result=$4
shift 4
mkdir -p "$folder"
export COIF=${COIF:-coif}
here=$(dirname "$(readlink -f "$0")")
array=$(sbatch --parsable "$@" --array="0-$((shards - 1))" --output="$folder/slurm-%a.out" \
    "$here/slurm_shard.sbatch" "$list" "$folder" "$shards")
merge=$(sbatch --parsable "$@" --job-name=coif-merge --output="$folder/slurm-merge.out" \
    --dependency="afterok:$array" --kill-on-invalid-dep=yes \
    "$here/slurm_merge.sbatch" "$list" "$folder" "$result")
echo "$array $merge"
