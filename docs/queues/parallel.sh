#!/bin/sh
# An ablation by GNU parallel, on this machine, or on those that PARALLEL="--sshlogin …" names, which
# see this folder.
#   parallel.sh RECIPE FOLDER [OPTION …]
# The options are those of `turnpath ablate`. TURNPATH names another program: "python3 -m turnpath".
set -u
turnpath=${TURNPATH:-turnpath} recipe=$1 folder=$2
shift 2
keys=$($turnpath ablate "$recipe" -o "$folder" "$@" --plan=open) || exit
printf '%s\n' "$keys" |
    parallel --no-run-if-empty --quote --workdir . --jobs "${JOBS:-100%}" \
        $turnpath ablate "$recipe" -o "$folder" "$@" --quiet --only {}
# A run that fails has left its reason in the table.
$turnpath ablate "$recipe" -o "$folder" "$@" --merge
