#!/usr/bin/env python3
"""An ablation by dask.distributed: on two workers of this machine, or on a cluster that sees this folder.

dask_queue.py [--scheduler ADDRESS] RECIPE FOLDER [OPTION ...]

The options are those of `turnpath ablate`. TURNPATH names another program: "python3 -m turnpath".
"""

import os
import shlex
import subprocess
import sys

from dask.distributed import Client, as_completed


def turnpath(call, folder, *more):
    # A worker of a cluster starts in a folder of its own.
    return subprocess.run([*call, *more], cwd=folder, capture_output=True, text=True)


if __name__ == "__main__":
    scheduler = [sys.argv[2]] if sys.argv[1] == "--scheduler" else []
    recipe, out, *options = sys.argv[1 + 2 * len(scheduler):]
    here = os.getcwd()
    call = [*shlex.split(os.environ.get("TURNPATH", "turnpath")), "ablate", recipe, "-o", out, *options]
    planned = turnpath(call, here, "--plan=open")
    if planned.returncode:
        sys.exit(planned.stderr)
    client = Client(*scheduler) if scheduler else Client(n_workers=2, threads_per_worker=1)
    # A run whose worker dies is given to another one.
    runs = [client.submit(turnpath, call, here, "--quiet", "--only", key, retries=2, pure=False)
            for key in planned.stdout.split()]
    for run in as_completed(runs):
        print(run.result().stderr, end="", file=sys.stderr)
    client.close()
    merged = turnpath(call, here, "--merge")
    print(merged.stdout, end="")
    sys.exit(merged.returncode)
