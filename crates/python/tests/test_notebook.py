"""The notebook of docs/python runs, and its own assertions hold."""

from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).parents[3] / "docs" / "python" / "first-steps.ipynb"


def test_the_notebook_runs():
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    ran = nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    cells = [cell for cell in ran.cells if cell.cell_type == "code"]
    assert len(cells) >= 6 and all(cell.execution_count for cell in cells)
