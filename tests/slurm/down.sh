#!/bin/bash
# Ends what up.sh started, by the process numbers that it wrote, and waits for it.
#
#   down.sh FOLDER
folder=$1
for daemon in slurmd slurmctld munge; do
    [[ -s $folder/$daemon.pid ]] || continue
    process=$(<"$folder/$daemon.pid")
    kill "$process" 2>/dev/null || continue
    for _ in $(seq 50); do
        kill -0 "$process" 2>/dev/null || continue 2
        sleep 0.1
    done
    kill -9 "$process" 2>/dev/null
done
true
