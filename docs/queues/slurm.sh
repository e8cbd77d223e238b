#!/bin/sh
# An ablation as a job array of Slurm. The nodes see this folder.
#   slurm.sh RECIPE FOLDER [OPTION …]
# The options are those of `turnpath ablate`. TURNPATH names another program: "python3 -m turnpath".
# TASKS is the most tasks of an array, 1000 unless given; a task makes several runs where there are more.
set -u
turnpath=${TURNPATH:-turnpath} recipe=$1 folder=$2
shift 2
if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    # A task of the array: every run of the list whose number is its own, counted round.
    awk -v own="$SLURM_ARRAY_TASK_ID" -v all="$TASKS" 'NR % all == own % all' "$KEYS" |
        while read -r key; do
            $turnpath ablate "$recipe" -o "$folder" "$@" --quiet --only "$key" </dev/null
        done
    exit
fi
mkdir -p "$folder/slurm"
KEYS=$(mktemp "$folder/slurm/keys.XXXXXX")
$turnpath ablate "$recipe" -o "$folder" "$@" --plan=open >"$KEYS" || exit
count=$(wc -l <"$KEYS")
TASKS=$((count < ${TASKS:-1000} ? count : ${TASKS:-1000}))
export KEYS TASKS
if [ "$count" -gt 0 ]; then
    # --requeue makes a run again whose node dies. What a task says is in a file beside the keys.
    sbatch --wait --requeue --array="1-$TASKS" --cpus-per-task=1 --output="$folder/slurm/%A-%a.txt" \
        "$0" "$recipe" "$folder" "$@"
fi
rm -f "$KEYS"
$turnpath ablate "$recipe" -o "$folder" "$@" --merge
