//! The recipe that the tests start from.

/// The full example of the design, with what this version makes.
pub const FULL: &str = r#"format = 1
name = "Astigmatic mirror, 5 mm"
plugins = ["plugins"]
refine = true

[part]
aperture = "5 mm"
inner = "0 mm"

[surface]
use = "astigmatic"
k = "0.08 /mm"

[tool]
nose_radius = "1 mm"
included_angle = "120 deg"
clearance_angle = "30 deg"
interference = "refuse"

[tolerance]
interpolation = "100 nm"
residual = "100 nm"

[spindle]
speed = "500 rpm"

[path]
direction = "inward"
overrun = "none"
lead = false

[feed]
use = "atpg"

[sampler]
use = "atpg"
max_step = "45 deg"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"

[output]
posts = []
data = ["csv"]
z_reference = "tip"

[ablation]
mode = "all-pairs"
feed = [{ use = "constant" }, { use = "ats" }]
sampler = [{ use = "equal-angle", step = "6 deg" }]
velocity = [{ use = "three-point" }, { use = "analytic" }]
"#;
