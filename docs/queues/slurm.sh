#!/bin/sh
# An ablation as a job array of Slurm. The nodes see this folder.
#   slurm.sh RECIPE FOLDER
set -u
mkdir -p "$2"
keys="$2/missing-keys"
turnpath ablate "$1" -o "$2" --plan=missing >"$keys"
count=$(wc -l <"$keys")
if [ "$count" -gt 0 ]; then
    # --requeue makes a run again whose node dies.
    sbatch --wait --requeue --array="1-$count" --cpus-per-task=1 --output=/dev/null \
        --export=ALL,RECIPE="$1",FOLDER="$2",KEYS="$keys" <<'END'
#!/bin/sh
turnpath ablate "$RECIPE" -o "$FOLDER" --quiet --only "$(sed -n "${SLURM_ARRAY_TASK_ID}p" "$KEYS")"
END
fi
rm -f "$keys"
turnpath ablate "$1" -o "$2" --merge
