#!/usr/bin/env python3
"""Opens toolpath.parquet by pyarrow and toolpath.npz by numpy, and holds them against toolpath.csv.

    columns.py DIR

DIR is the folder of a run with `[output] data = ["csv", "parquet", "npz"]`. The script needs numpy and
pyarrow. It prints what it found, and ends with 1 unless all numbers are equal to the last bit, and each
column of the parquet file has its unit in the metadata.
"""

import csv
import sys
from pathlib import Path

import numpy
import pyarrow.parquet

UNITS = {
    "time_s": "s",
    "c_deg": "deg",
    "x_mm": "mm",
    "z_mm": "mm",
    "vc_deg_per_s": "deg/s",
    "vx_mm_per_s": "mm/s",
    "vz_mm_per_s": "mm/s",
    "section": "1",
}


def main():
    folder = Path(sys.argv[1])
    with open(folder / "toolpath.csv") as file:
        names, *rows = csv.reader(file)
    columns = {name: numpy.array([float(row[k]) for row in rows]) for k, name in enumerate(names)}
    assert list(columns) == list(UNITS), names
    table = pyarrow.parquet.read_table(folder / "toolpath.parquet")
    assert table.column_names == names, table.column_names
    for name, unit in UNITS.items():
        said = table.schema.metadata[f"unit of {name}".encode()].decode()
        assert said == unit, (name, said)
        assert numpy.array_equal(table[name].to_numpy(), columns[name]), name
    arrays = numpy.load(folder / "toolpath.npz")
    assert sorted(arrays.files) == sorted(names), arrays.files
    for name in names:
        assert numpy.array_equal(arrays[name], columns[name]), name
    assert arrays["section"].dtype == numpy.uint8 and arrays["time_s"].dtype == numpy.float64
    encodings = pyarrow.parquet.ParquetFile(folder / "toolpath.parquet").metadata.row_group(0).column(0)
    print(f"{len(rows)} rows, {len(names)} columns: equal to the last bit")
    print(f"parquet: {encodings.compression}, {encodings.encodings}")
    for end in ("csv", "parquet", "npz"):
        print(f"toolpath.{end}: {(folder / f'toolpath.{end}').stat().st_size} bytes")


if __name__ == "__main__":
    main()
