//! Random recipes that hold what docs/recipe.md asks for: all surfaces, sums and poses, feeds,
//! samplers, compensators, solvers, machines and servos, on parts so small that a run is short.

use std::path::Path;

use super::seeded::SeededNumbers;

/// Feeds, each with parameters that it may have. The fit `cubic` of `atpg` is left out: on parts where
/// the feed varies much there is no such law.
const FEEDS: &[&[&str]] = &[
    &["constant", "feed = \"20 um/rev\"", "feed = \"0.05 mm\""],
    &["atpg", "residual = \"paper\""],
    &["ats", "inward = \"backwards\""],
    &[
        "fft-adaptive",
        "chord = \"full\"",
        "tolerance = \"300 nm\"",
        "limit_residual = false",
        "angles = 90",
    ],
];
/// Samplers likewise.
const SAMPLERS: &[&[&str]] = &[
    &["equal-angle", "step = \"10 deg\"", "max_step = \"0.3 rad\""],
    &["equal-arc"],
    &["integrated", "max_step = \"20 deg\""],
    &["atpg", "max_step = \"30 deg\""],
    &["ats", "max_step = \"90 deg\""],
    &["fft-adaptive", "chord = \"half\"", "curvature = \"start\""],
];
/// Velocity solvers likewise.
const SOLVERS: &[&[&str]] = &[
    &[
        "triangle-rotary",
        "ends = \"natural\"",
        "ends = \"not-a-knot\"",
    ],
    &["analytic"],
    &["three-point"],
    &["area", "c = 0.5", "c = 0.75"],
    &["linear"],
];
const COMPENSATORS: [&str; 3] = ["z-direction", "normal", "none"];
/// Keys of `[machine]`, each with a quantity that a machine may have.
const LIMITS: [&str; 8] = [
    "x_velocity = \"100 mm/s\"",
    "z_velocity = \"3 m/min\"",
    "x_acceleration = \"0.1 g\"",
    "z_acceleration = \"5 m/s^2\"",
    "x_jerk = \"10 m/s^3\"",
    "z_jerk = \"2000 m/s^3\"",
    "c_acceleration = \"100 rad/s^2\"",
    "c_jerk = \"5e3 deg/s^3\"",
];
/// Keys of `[output.pmac-pvt]`.
const LAYOUT: [&str; 7] = [
    "position_decimals = 6",
    "velocity_decimals = 5",
    "velocity_per = \"min\"",
    "c_sign = -1",
    "c_wrap = \"0-360\"",
    "positioning = \"incremental\"",
    "header = \"; {name}\\nCLOSE\\nOPEN PROG 7 CLEAR\"",
];
/// The fixture that changes the spindle's speed along the path. The recipes need its library.
pub const SPINDLE_PLUGIN: &str = "two-speeds";
/// Largest angle of a slope that a surface adds, as its tangent.
const STEEPEST: f64 = 0.12;

/// One of them.
pub struct ValidRecipe {
    /// Its text.
    pub text: String,
    /// The part's diameter, mm. A hole is less than a third of it.
    pub aperture: f64,
}

/// The arguments of a call on a recipe, with the folder of the plugins if it needs one.
pub fn with_plugins(text: &str, plugins: &Path, mut args: Vec<String>) -> Vec<String> {
    if text.contains(SPINDLE_PLUGIN) {
        args.extend(["--plugin-dir".to_owned(), plugins.display().to_string()]);
    }
    args
}

/// Makes one.
pub fn valid_recipe(random: &mut SeededNumbers) -> ValidRecipe {
    let aperture = random.of_any_size(0.3, 1.6);
    let mut text = format!("format = 1\nname = \"Random\"\n{}", refine(random));
    let hole = match random.one_in(4) {
        true => format!("inner = {}\n", length(0.3 * aperture, random)),
        false => String::new(),
    };
    text += &format!(
        "\n[part]\naperture = {}\n{hole}\n",
        length(aperture, random)
    );
    text += &surfaces(0.6 * aperture, random);
    text += &tool(random);
    let (feed, solver) = (*random.pick(FEEDS), *random.pick(SOLVERS));
    let straight = solver == ["linear"];
    let around = around(straight, random);
    text += &tolerance(around.contains("[servo]"), random);
    text += &spindle(random);
    text += &path(random);
    text += &strategy("feed", feed, "", random);
    text += &sampler(random);
    text += &strategy("velocity", solver, "", random);
    text += &around;
    ValidRecipe { text, aperture }
}

fn refine(random: &mut SeededNumbers) -> &'static str {
    let lines: [&'static str; 3] = ["", "refine = true\n", "refine = false\n"];
    lines[random.below(lines.len())]
}

/// A length in one of the units, with digits enough for any of them.
pub fn length(mm: f64, random: &mut SeededNumbers) -> String {
    let units = [
        (1.0, "mm"),
        (1e3, "um"),
        (1e6, "nm"),
        (1e-3, "m"),
        (0.1, "cm"),
    ];
    let (per, unit) = random.pick(&units);
    format!("\"{:e} {unit}\"", mm * per)
}

/// A number of either sign and any size.
fn signed(low: f64, high: f64, random: &mut SeededNumbers) -> f64 {
    let size = random.of_any_size(low, high);
    if random.one_in(2) { size } else { -size }
}

/// One to three surfaces, and perhaps a pose. `reach` is a radius within which the path stays, mm.
pub fn surfaces(reach: f64, random: &mut SeededNumbers) -> String {
    let mut text = String::new();
    if random.one_in(3) {
        text += "[part.pose]\n";
        text += *random.pick(&["", "x = \"0.3 mm\"\n", "y = \"-200 um\"\nx = \"0 mm\"\n"]);
        text += *random.pick(&["", "level = true\n", "tilt_x = \"1 deg\"\n"]);
        text += "\n";
    }
    let count = *random.pick(&[1, 1, 1, 2, 3]);
    let header = match count {
        1 => *random.pick(&["[surface]", "[[surface]]"]),
        _ => "[[surface]]",
    };
    for _ in 0..count {
        text += &format!("{header}\n{}\n", surface(reach, random));
    }
    text
}

/// A surface whose slope stays small wherever it is placed.
fn surface(reach: f64, random: &mut SeededNumbers) -> String {
    let reach = reach + 0.5;
    let radius = |random: &mut SeededNumbers| {
        let mm = signed(reach / STEEPEST, 100.0, random);
        length(mm, random)
    };
    let mut text = match random.below(6) {
        0 => format!(
            "use = \"conic\"\nradius = {}\nconic = {:.3}\n",
            radius(random),
            random.between(-2.0, 1.0)
        ),
        1 => format!(
            "use = \"astigmatic\"\nk = \"{:e} /mm\"\n",
            signed(1e-6, 0.5 * STEEPEST / reach, random)
        ),
        2 => format!(
            "use = \"toric\"\nradius_rotation = {}\nradius_base = {}\n",
            radius(random),
            radius(random)
        ),
        3 => format!(
            "use = \"off-axis-paraboloid\"\nvertex_radius = {}\noff_axis_distance = {}\n",
            length(random.between(30.0, 300.0), random),
            length(random.between(0.0, 60.0), random)
        ),
        4 => {
            let (form, frequency) = (random.pick(&["sum", "product"]), random.between(0.05, 0.6));
            let amplitude = length(random.of_any_size(1e-6, 5e-3), random);
            format!(
                "use = \"sinusoidal-array\"\namplitude_x = {amplitude}\n\
                 frequency_x = \"{frequency:.4} /mm\"\nform = \"{form}\"\n"
            )
        }
        _ => {
            let share = STEEPEST / 4.0;
            // What a power of x and y of each degree has as its steepest slope.
            let slopes = [1.0, 2.0 * reach, 3.0 * reach * reach];
            let [one, two, three] = slopes.map(|slope| {
                let most = share / slope;
                random.between(-most, most)
            });
            format!(
                "use = \"xy-polynomial\"\n\
                 terms = [[1, 0, {one:e}], [0, 2, {two:e}], [2, 1, {three:e}]]\n"
            )
        }
    };
    text += &placement(random);
    text
}

fn placement(random: &mut SeededNumbers) -> String {
    let scale = *random.pick(&["scale = -1\n", "scale = 0.5\n"]);
    let keys = [
        scale,
        "decentre_x = \"0.2 mm\"\n",
        "decentre_y = \"-100 um\"\n",
        "clocking = \"30 deg\"\n",
        "piston = \"3 um\"\n",
    ];
    let kept = keys.iter().filter(|_| random.one_in(6));
    kept.copied().collect()
}

pub fn tool(random: &mut SeededNumbers) -> String {
    let nose = length(random.of_any_size(0.05, 1.0), random);
    let edge = *random.pick(&["", "included_angle = \"120 deg\"\n"]);
    let flank = *random.pick(&["", "clearance_angle = \"0.5 rad\"\n"]);
    let which = random.below(COMPENSATORS.len());
    // What fits is where the nose first touches: it does not go with `normal`.
    let fits = match which {
        1 => "",
        _ => *random.pick(&["", "", "interference = \"cut-what-fits\"\n"]),
    };
    let compensator = COMPENSATORS[which];
    format!(
        "[tool]\nnose_radius = {nose}\n{edge}{flank}{fits}\n[compensator]\nuse = \"{compensator}\"\n\n"
    )
}

/// Interpolation and residual, or a form with none, one or both of them. A model of the servos may
/// have its own.
fn tolerance(has_servo: bool, random: &mut SeededNumbers) -> String {
    let mut text = "[tolerance]\n".to_owned();
    let has_form = random.one_in(4);
    if has_form {
        let form = length(random.of_any_size(3e-4, 5e-3), random);
        text += &format!("form = {form}\n");
    }
    for (key, least) in [("interpolation", 3e-5), ("residual", 1e-4)] {
        if !has_form || random.one_in(3) {
            let most = length(random.of_any_size(least, 3e-3), random);
            text += &format!("{key} = {most}\n");
        }
    }
    if has_servo && random.one_in(2) {
        let servo = length(random.of_any_size(1e-5, 1e-1), random);
        text += &format!("servo = {servo}\n");
    }
    text + "\n"
}

/// The spindle, sometimes with its strategy's name, and sometimes with that of [`SPINDLE_PLUGIN`].
fn spindle(random: &mut SeededNumbers) -> String {
    let speed = random.of_any_size(5.0, 2500.0);
    let plugin = format!("use = \"{SPINDLE_PLUGIN}\"\n");
    let chosen = *random.pick(&["", "", "use = \"constant\"\n", &plugin]);
    format!("[spindle]\n{chosen}speed = \"{speed:.3} rpm\"\n\n")
}

pub fn path(random: &mut SeededNumbers) -> String {
    let keys = [
        *random.pick(&["", "direction = \"outward\"\n", "direction = \"inward\"\n"]),
        *random.pick(&[
            "",
            "overrun = \"none\"\n",
            "overrun = \"contact\"\n",
            "overrun = \"20 um\"\n",
        ]),
        *random.pick(&["", "lead = false\n", "clearance = \"2 mm\"\n"]),
    ];
    format!("[path]\n{}\n", keys.concat())
}

/// A strategy's table, with one of the parameters that it may have.
pub fn strategy(slot: &str, parts: &[&str], more: &str, random: &mut SeededNumbers) -> String {
    let name = parts.first().copied().unwrap_or_default();
    let param = match random.below(parts.len()) {
        0 => String::new(),
        which => format!("{}\n", parts[which]),
    };
    format!("[{slot}]\nuse = \"{name}\"\n{param}{more}\n")
}

fn sampler(random: &mut SeededNumbers) -> String {
    let parts = *random.pick(SAMPLERS);
    let spacing = match parts.first() {
        Some(&("equal-arc" | "integrated")) => {
            format!("spacing = {}\n", length(random.between(0.02, 0.3), random))
        }
        _ => String::new(),
    };
    strategy("sampler", parts, &spacing, random)
}

/// Machine, servo and output.
fn around(straight: bool, random: &mut SeededNumbers) -> String {
    let mut text = String::new();
    if random.one_in(3) {
        text += "[machine]\n";
        // One limit at least belongs there.
        text += *random.pick(&[
            "c_velocity = \"2900 rpm\"\n",
            "preset = \"precitech-sts\"\n",
            "preset = \"generic-sts\"\n",
        ]);
        text += &some_of(&LIMITS, 4, random);
    }
    if random.one_in(2) {
        text += "[servo]\nbandwidth = \"60 Hz\"\n";
        text += *random.pick(&[
            "",
            "damping = 0.4\ndelay = \"1 ms\"\n",
            "z_bandwidth = \"0.1 kHz\"\nvelocity_feed_forward = 1\n\n",
        ]);
    }
    if !straight && random.one_in(2) {
        text += "[output]\nposts = [\"pmac-pvt\"]\n";
        text += *random.pick(&["", "z_reference = \"centre\"\n"]);
        text += "\n[output.pmac-pvt]\n";
        text += &some_of(&LAYOUT, 3, random);
    }
    text
}

/// Some of the lines.
fn some_of(lines: &[&str], one_in: usize, random: &mut SeededNumbers) -> String {
    let kept = lines.iter().filter(|_| random.one_in(one_in));
    kept.map(|line| format!("{line}\n")).collect::<String>() + "\n"
}
