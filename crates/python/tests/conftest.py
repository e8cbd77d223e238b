"""A small part that all tests cut: the astigmatic mirror of 5 mm."""

import copy

import pytest

PART = {
    "format": 1,
    "name": "test part",
    "part": {"aperture": "5 mm"},
    "surface": {"use": "astigmatic", "k": "0.08 /mm"},
    "tool": {"nose_radius": "1 mm", "included_angle": "120 deg", "clearance_angle": "30 deg"},
    "tolerance": {"interpolation": "100 nm", "residual": "200 nm"},
    "spindle": {"speed": "500 rpm"},
    "feed": {"use": "constant", "feed": "20 um/rev"},
    "sampler": {"use": "equal-angle", "step": "6 deg"},
    "compensator": {"use": "normal"},
    "velocity": {"use": "analytic"},
}


@pytest.fixture
def part():
    """The recipe as a dict that a test may change."""
    return copy.deepcopy(PART)
