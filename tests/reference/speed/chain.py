"""The numbers of equal-angle.toml, which both scripts make a program of."""

from math import ceil, pi

RADIUS = 1.04  # of the nose, mm
RIM = 25.0  # mm
K = 3.84e-6  # 1/mm: z = 2 k x y
TURN_S = 60.0 / 500.0  # time of a revolution
STEPS_PER_S = 4096 * 1000  # steps of the controller's time
FEED = 9.0912345e-3  # mm a revolution
PER_TURN = 360.0 / 0.33  # points of a revolution
TURNS = RIM / FEED
DEG = pi / 180.0
# Decimals of all numbers of a program.
DECIMALS = 7


def count():
    """The points of the path: those before its end, and its end."""
    whole = ceil(TURNS * PER_TURN)
    # A point that would coincide with the end is left out.
    return whole + 1 if TURNS * PER_TURN - (whole - 1) > 1e-6 else whole
