#!/bin/sh
# An ablation by HyperQueue. A server runs already, with workers that see this folder:
#   hq server start &  hq worker start &
#   hyperqueue.sh RECIPE FOLDER
set -u
keys=$(mktemp)
trap 'rm -f "$keys"' EXIT
turnpath ablate "$1" -o "$2" --plan=missing >"$keys"
if [ -s "$keys" ]; then
    # A task whose worker dies is given to another one. HQ_ENTRY is a line of the file.
    hq submit --wait --stdout=none --stderr=none --each-line "$keys" --cpus=1 -- \
        sh -c 'turnpath ablate "$0" -o "$1" --quiet --only "$HQ_ENTRY"' "$1" "$2"
fi
turnpath ablate "$1" -o "$2" --merge
