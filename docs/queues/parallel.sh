#!/bin/sh
# An ablation by GNU parallel, on this machine or on those of --sshlogin.
#   parallel.sh RECIPE FOLDER
set -u
turnpath ablate "$1" -o "$2" --plan=missing |
    parallel --jobs "${JOBS:-100%}" turnpath ablate "$1" -o "$2" --quiet --only {}
# A run that fails has left its reason in the table.
turnpath ablate "$1" -o "$2" --merge
