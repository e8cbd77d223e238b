#!/usr/bin/env python3
"""An ablation by dask.distributed: on two workers of this machine, or on a cluster.

dask_queue.py RECIPE FOLDER [SCHEDULER]
"""

import subprocess
import sys

from dask.distributed import Client, wait


def turnpath(recipe, folder, *more):
    call = ["turnpath", "ablate", recipe, "-o", folder, *more]
    return subprocess.run(call, stdout=subprocess.PIPE, text=True)


if __name__ == "__main__":
    recipe, folder, *scheduler = sys.argv[1:]
    keys = turnpath(recipe, folder, "--plan=missing").stdout.split()
    client = Client(*scheduler) if scheduler else Client(n_workers=2, threads_per_worker=1)
    # A run whose worker dies is given to another one.
    runs = [client.submit(turnpath, recipe, folder, "--quiet", "--only", key, retries=2) for key in keys]
    wait(runs)
    merged = turnpath(recipe, folder, "--merge")
    print(merged.stdout, end="")
    client.close()
    sys.exit(merged.returncode)
