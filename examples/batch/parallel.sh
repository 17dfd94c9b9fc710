#!/bin/sh
# A batch with GNU parallel, on this machine or, by ssh, on several.
#
#   parallel.sh LIST FOLDER SHARDS RESULT [OPTION OF PARALLEL ...]
#   parallel.sh jobs.txt results 8 sheet.png --jobs 2
#   parallel.sh jobs.txt /shared/results 64 sheet.png --sshlogin one,two --workdir .
#
# The folder must be the same on all machines. After a failure the same call again does only what is not done yet.
set -eu
list=$1 folder=$2 shards=$3 result=$4
shift 4
coif=${COIF:-coif}
seq 0 $((shards - 1)) | parallel "$@" "$coif" run "$list" --out "$folder" --shard "{}/$shards" --tries 2
exec "$coif" merge "$list" --out "$folder" -o "$result"
