#!/bin/sh
# An ablation by HyperQueue. A server runs already, with workers that see this folder:
#   hq server start &  hq worker start &
#   hyperqueue.sh RECIPE FOLDER [OPTION …]
# The options are those of `turnpath ablate`. TURNPATH names another program: "python3 -m turnpath".
set -u
turnpath=${TURNPATH:-turnpath} recipe=$1 folder=$2
shift 2
keys=$(mktemp)
trap 'rm -f "$keys"' EXIT
$turnpath ablate "$recipe" -o "$folder" "$@" --plan=open >"$keys" || exit
if [ -s "$keys" ]; then
    # A task whose worker dies is given to another one. HQ_ENTRY is a line of the file. A worker has the
    # PATH with which it was started, which need not lead to turnpath.
    hq submit --wait --stdout=none --stderr=none --each-line "$keys" --cpus=1 --env "PATH=$PATH" -- \
        sh -c 'turnpath=$0; exec $turnpath ablate "$@" --quiet --only "$HQ_ENTRY"' \
        "$turnpath" "$recipe" -o "$folder" "$@"
fi
$turnpath ablate "$recipe" -o "$folder" "$@" --merge
