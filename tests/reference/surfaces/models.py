"""The surfaces that values.py and series.py are about, with their parameters as a recipe has them.

A case: the model, its parameters in mm, and the radius of its aperture in mm. Coefficients stand
under their whole numbers.
"""

NOLL = {"1": 0.0004, "2": -0.0011, "3": 0.0007, "4": 0.0021, "5": -0.0013, "6": 0.0009,
        "7": 0.0005, "8": -0.0004, "9": 0.0003, "10": -0.0006, "11": 0.0008, "13": 0.00025,
        "22": -0.00015, "37": 0.00009}
LENSES = {"pitch": 1.25, "radius": 4.0, "conic": -0.5}

MODELS = [
    ("even-asphere", {"radius": 40.0, "conic": -0.8, "coefficients": {
        "2": 1e-4, "4": -2.5e-6, "6": 3e-8, "10": -1.5e-12}}, 12.0),
    ("even-asphere", {"radius": -25.0, "conic": 0.5, "coefficients": {
        "4": 1.5e-5, "8": -2e-9, "20": 1e-22}}, 10.0),
    ("even-asphere", {"coefficients": {"4": 2e-6}}, 10.0),
    ("odd-asphere", {"radius": 50.0, "conic": -1.2, "coefficients": {
        "1": 0.002, "3": -1e-5, "4": 3e-6, "7": -2e-9}}, 10.0),
    ("odd-asphere", {"radius": -30.0, "coefficients": {"3": 2e-5, "5": -1e-7}}, 8.0),
    ("biconic", {"radius_x": 40.0, "radius_y": 28.0, "conic_x": -0.7, "conic_y": 0.4}, 10.0),
    ("biconic", {"radius_x": -35.0, "radius_y": 60.0, "conic_x": -1.5, "conic_y": -2.0}, 10.0),
    ("biconic", {"radius_y": 30.0, "conic_y": -1.0}, 10.0),
    ("toroid-yz", {"radius_rotation": 50.0, "radius": 32.0, "conic": -0.6, "coefficients": {
        "4": -2e-6, "6": 4e-9}}, 10.0),
    ("toroid-yz", {"radius_rotation": -45.0, "radius": 38.0, "conic": 0.3}, 10.0),
    ("toroid-yz", {"radius": -30.0, "conic": -1.0, "coefficients": {"2": 1e-3}}, 8.0),
    ("off-axis-conic", {"vertex_radius": 300.0, "conic": -0.6, "off_axis_distance": 60.0}, 25.0),
    ("off-axis-conic", {"vertex_radius": -200.0, "conic": -1.8, "off_axis_distance": 45.0}, 25.0),
    ("off-axis-conic", {"vertex_radius": 150.0, "conic": 0.5, "off_axis_distance": -30.0}, 20.0),
    ("off-axis-conic", {"vertex_radius": 120.0, "conic": -1.0, "off_axis_distance": 40.0}, 20.0),
    ("lenslet-array", {"layout": "square", **LENSES}, 4.0),
    ("lenslet-array", {"layout": "hexagonal", **LENSES}, 4.0),
    ("lenslet-array", {"layout": "hexagonal", "pitch": 0.8, "radius": -2.5, "conic": 0.0}, 3.0),
    ("xy-polynomial", {"normalization_radius": 12.5, "coefficients": {
        "0,0": 0.001, "1,0": -0.002, "2,0": 0.013, "1,1": -0.02, "0,2": 0.031, "3,1": 1e-3,
        "0,5": -3e-4, "6,2": 1e-4}}, 10.0),
    ("zernike", {"indexing": "noll", "normalization_radius": 12.0, "coefficients": NOLL}, 12.0),
    ("zernike", {"indexing": "fringe", "normalization_radius": 12.0, "coefficients": NOLL}, 12.0),
    ("zernike", {"indexing": "osa", "normalization_radius": 12.0, "coefficients": NOLL}, 12.0),
    ("zernike", {"indexing": "noll", "normalization": "peak", "normalization_radius": 9.0,
                 "coefficients": {"7": 0.001, "12": -0.0004, "231": 0.0002}}, 9.0),
    ("zernike", {"indexing": "fringe", "normalization": "rms", "normalization_radius": 9.0,
                 "coefficients": {"5": 0.001, "9": -0.0004, "36": 0.0002}}, 9.0),
    ("forbes-qbfs", {"radius": 40.0, "normalization_radius": 12.0, "coefficients": {
        "0": 0.02, "1": -0.006, "2": 0.003, "3": 0.001, "5": -0.0004, "9": 0.0002}}, 12.0),
    ("forbes-qbfs", {"normalization_radius": 8.0, "coefficients": {"20": 0.001}}, 8.0),
    ("forbes-qcon", {"radius": -35.0, "conic": -0.7, "normalization_radius": 11.0,
                     "coefficients": {"0": 0.05, "1": -0.012, "2": 0.004, "4": 0.001,
                                      "8": -0.0003}}, 11.0),
    ("forbes-qcon", {"normalization_radius": 8.0, "coefficients": {"12": 0.001}}, 8.0),
    ("forbes-q2d", {"radius": 60.0, "normalization_radius": 12.0, "coefficients": {
        "0,0": 0.01, "2,0": -0.002, "0,1": 0.004, "1,1": -0.003, "2,1": 0.002, "3,1": 0.001,
        "5,1": -0.0006, "0,-1": 0.002, "4,-1": 0.0007, "0,2": -0.005, "2,2": 0.001,
        "1,-2": 0.0008, "3,-3": 0.0005, "0,5": 0.0004, "4,7": -0.0003}}, 12.0),
    ("forbes-q2d", {"radius": -50.0, "normalization_radius": 10.0, "coefficients": {
        "10,2": 0.001, "12,-1": 0.0007, "0,12": 0.001}}, 10.0),
    ("chebyshev", {"normalization_x": 12.0, "normalization_y": 9.0, "coefficients": {
        "0,0": 0.003, "2,0": 0.004, "0,3": -0.0012, "1,2": 0.0008, "5,4": 0.0003,
        "9,0": -0.0001}}, 8.5),
    ("chebyshev", {"normalization_x": 10.0, "coefficients": {"1,0": 0.01, "0,20": 0.0001}}, 10.0),
]


def numbers(key):
    """The whole numbers of a coefficient's key."""
    return tuple(int(part) for part in key.split(","))
