#!/bin/sh
# The shards of a batch as a list of commands, one a line, as OpenCue's cuecmd and other queues of commands take them:
#
#   opencue.sh LIST FOLDER SHARDS > commands.txt
#   cuecmd commands.txt --chunk 1
#
# LIST and FOLDER as the farm's machines see them. When the job has ended: coif merge LIST --out FOLDER -o RESULT.
set -eu
list=$1 folder=$2 shards=$3
shard=0
while [ "$shard" -lt "$shards" ]; do
    echo "${COIF:-coif} run $list --out $folder --shard $shard/$shards --tries 2"
    shard=$((shard + 1))
done
