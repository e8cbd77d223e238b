// Opens pages of turnpath in a browser, and compares what is drawn with the files beside them.
//
//   node report.cjs CHROMIUM PICTURES RUN ABLATION
//
// RUN is the folder of a run with report.html, summary.json, toolpath.csv with points on whole turns, and
// map.gsf (300 cells, cusps far below the error); ABLATION that of an ablation. Pictures of the pages go to PICTURES, and report.png, that of
// docs/report.md. Needs playwright-core.
"use strict";
const fs = require("fs");
const path = require("path");
const { chromium } = require("playwright-core");

const [executablePath, pictures, run, ablation] = process.argv.slice(2);
const WIDTHS = [1400, 400];
const SCHEMES = ["light", "dark"];
// Values that are read out of each figure.
const VALUES = 10;
// A map of means differs from one of points by so much of the peak to valley, where cusps are low.
const CUSPS = 0.02;

let checks = 0;
function check(holds, what) {
  checks += 1;
  if (!holds) throw new Error(what);
}
function near(found, expected, share, what) {
  check(Math.abs(found - expected) <= share * Math.abs(expected) + 1e-12, `${what}: ${found}, not ${expected}`);
}
const decoded = (samples) => new Float32Array(new Uint8Array(Buffer.from(samples.bdata, "base64")).buffer);
const most = (values) => values.reduce((a, b) => (b > a ? b : a), -Infinity);

// A Gwyddion Simple Field: a text header, NULs up to a multiple of four bytes, then float32 rows.
function gsf(file) {
  const bytes = fs.readFileSync(file);
  const end = bytes.indexOf(0);
  const header = bytes.subarray(0, end).toString("utf8");
  const number = (key) => Number(header.match(new RegExp(`^${key}\\s*=\\s*(.*)$`, "m"))[1]);
  const begin = 4 * (Math.floor(end / 4) + 1);
  const [columns, rows] = [number("XRes"), number("YRes")];
  const data = new Float32Array(bytes.buffer.slice(bytes.byteOffset + begin, bytes.byteOffset + begin + 4 * columns * rows));
  return { columns, rows, data };
}

async function open(browser, folder, width, scheme) {
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme: scheme });
  const heard = [];
  page.on("console", (message) => heard.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => heard.push(`error: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) heard.push(`request: ${request.url()}`);
  });
  await page.goto(`file://${path.resolve(folder, "report.html")}`);
  await page.waitForFunction(() => document.documentElement.dataset.drawn, null, { timeout: 120000 });
  return { page, heard };
}

// What is drawn: of each figure its traces as plotly has them, and whether there is ink.
const figures = (page) => page.evaluate(() => [...document.querySelectorAll(".plot")].map((place) => ({
  id: place.id,
  ink: place.querySelectorAll("path.point, path.js-line, .heatmaplayer image, .points path").length,
  width: place.getBoundingClientRect().width,
  colour: getComputedStyle(place.querySelector(".xtitle, .ytitle, .infolayer text, .annotation-text, text")).fill,
  traces: (place.data || []).map(({ x, y, z, customdata }) => ({ x: x && [...x], y: y && [...y], z, customdata })),
  titles: ["xaxis", "yaxis"].map((axis) => place.layout[axis] && place.layout[axis].title && place.layout[axis].title.text),
})));

async function looks(browser, name, folder) {
  for (const width of WIDTHS) for (const scheme of SCHEMES) {
    const { page, heard } = await open(browser, folder, width, scheme);
    const what = `${name}, ${width} px, ${scheme}`;
    check(heard.length === 0, `${what}: ${heard.join("; ")}`);
    const all = await figures(page);
    const drawn = Number(await page.evaluate(() => document.documentElement.dataset.drawn));
    check(drawn === all.length && drawn >= 5, `${what}: ${drawn} of ${all.length} figures`);
    for (const one of all) {
      check(one.ink > 0, `${what}: nothing is drawn in ${one.id}`);
      check(one.width <= width, `${what}: ${one.id} is ${one.width} px wide`);
      if (one.id !== "error-maps" || name === "run") check(one.titles.every(Boolean), `${what}: ${one.id} has no titles`);
      const light = Number(one.colour.match(/\d+/)[0]) > 127;
      check(light === (scheme === "dark"), `${what}: the letters of ${one.id} are ${one.colour}`);
    }
    const whole = await page.evaluate(() => document.documentElement.scrollWidth);
    check(whole <= width, `${what}: the page is ${whole} px wide`);
    await page.screenshot({ path: path.join(pictures, `${name}-${width}-${scheme}.png`), fullPage: true });
    await page.close();
  }
}

// Ten of a figure's values are those of the page's data, in their order.
function same(drawn, expected, what) {
  const values = [...expected];
  check(drawn.length === values.length, `${what}: ${drawn.length} values, not ${values.length}`);
  const known = values.map((_, i) => i).filter((i) => Number.isFinite(values[i]));
  check(known.length > 0, `${what} has no values`);
  for (let k = 0; k < VALUES; k += 1) {
    const i = known[Math.floor((k * (known.length - 1)) / (VALUES - 1))];
    near(drawn[i], values[i], 1e-6, `${what}, value ${i}`);
  }
}

// On paper nothing is wider than the sheet, the letters are dark, and every figure is there.
async function prints(browser, name, folder) {
  const { page, heard } = await open(browser, folder, 720, "dark");
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await page.waitForTimeout(1500);
  const whole = await page.evaluate(() => document.documentElement.scrollWidth);
  check(whole <= 720, `${name} is ${whole} px wide on paper`);
  for (const one of await figures(page)) {
    check(one.ink > 0, `${name}: nothing is printed in ${one.id}`);
    check(Number(one.colour.match(/\d+/)[0]) < 128, `${name}: the letters of ${one.id} are ${one.colour} on paper`);
  }
  await page.screenshot({ path: path.join(pictures, `${name}-print.png`), fullPage: true });
  await page.pdf({ path: path.join(pictures, `${name}.pdf`), format: "A4", margin: { top: "15mm", bottom: "15mm", left: "10mm", right: "10mm" } });
  check(heard.length === 0, `${name} on paper: ${heard.join("; ")}`);
  await page.close();
}

async function runFigures(browser) {
  const { page } = await open(browser, run, 1400, "light");
  const clip = { x: 0, y: 0, width: 1400, height: 960 };
  await page.screenshot({ path: path.join(pictures, "report.png"), fullPage: true, clip });
  const drawn = Object.fromEntries((await figures(page)).map((one) => [one.id, one.traces]));
  const data = JSON.parse(await page.locator("#data").textContent());
  const summary = JSON.parse(fs.readFileSync(path.join(run, "summary.json"), "utf8"));
  const { sketch, surface } = data;
  check(JSON.stringify(data.report) === JSON.stringify(summary), "the page has another summary");
  const map = drawn["error-map"][0];
  same(map.z.flat(), decoded(sketch.map.error_nm), "error map");
  same(drawn.surface[0].z.flat(), decoded(surface.height_um), "surface");
  same(drawn.deviation[0].z.flat(), decoded(surface.deviation_um), "deviation");
  same(drawn["radial-mean"][0].y, decoded(sketch.radial_mean.error_nm), "radial mean");
  same(drawn.spectrum[1].y, decoded(sketch.harmonics_nm).slice(1), "spectrum");
  sketch.profiles.forEach((profile, i) => same(drawn.profile[i].y, decoded(profile.error_nm), `profile ${i}`));
  same(drawn.spiral[0].customdata, decoded(sketch.spiral.error_nm), "spiral");
  const { turns, edges } = sketch;
  const panels = (id) => drawn[id].filter((trace) => trace.y.length > 2).map((trace) => trace.y);
  const along = [turns.feed_um_per_rev, turns.points_per_turn, turns.spindle_rpm, turns.error_nm];
  along.forEach((samples, i) => same(panels("along")[i], decoded(samples), `along the radius ${i}`));
  for (const axis of ["x", "z"]) {
    const keys = ["velocity_mm_per_s", "acceleration_mm_per_s2", "jerk_mm_per_s3"];
    keys.forEach((key, i) => {
      same(panels(`${axis}-axis`)[i], decoded(turns[axis][key]), `${axis} ${key}`);
      near(most(panels(`${axis}-axis`)[i]), summary.axes[axis][`max_${key}`], 1e-5, `largest ${axis} ${key}`);
    });
  }
  same(panels("angle")[0], decoded(edges.residual_nm), "residual");
  same(panels("angle")[1], decoded(edges.rim_nm), "rim");
  near(most(drawn.spectrum[1].y.slice(2)), summary.spokes.amplitude_nm, 1e-5, "spokes");
  near(most(panels("along")[3]), summary.interpolation_error.max_nm, 1e-5, "interpolation error");
  near(most(drawn.spiral[0].customdata), summary.interpolation_error.max_nm, 1e-5, "error of the spiral");
  againstGwyddion(drawn, summary);
  againstTable(panels("along"), drawn.along.find((trace) => trace.y.length > 2).x);
  await page.close();
}

// The map of the page, its profile and its radial mean against the map that Gwyddion reads, which has points in
// place of means.
function againstGwyddion(drawn, summary) {
  const field = gsf(path.join(run, "map.gsf"));
  const map = drawn["error-map"][0].z;
  const size = map.length;
  check(field.columns === size && field.rows === size, "the maps have other cells");
  const bound = CUSPS * summary.surface_error.pv_nm;
  const there = (row, column) => 1e9 * field.data[row * size + column];
  const places = Array.from({ length: VALUES }, (_, k) => {
    const [angle, radius] = [0.3 + (2 * Math.PI * k) / VALUES, size * (0.1 + 0.03 * k)];
    return [0.5 * size + radius * Math.sin(angle), 0.5 * size + radius * Math.cos(angle)].map(Math.round);
  });
  const worst = (of) => most(places.map(([row, column]) => Math.abs(of(row, column) - there(row, column))));
  check(worst((row, column) => map[row][column]) < bound, "the map differs from that of Gwyddion");
  const wrong = {
    "upside down": (row, column) => map[size - 1 - row][column],
    "mirrored": (row, column) => map[row][size - 1 - column],
    "turned": (row, column) => map[column][row],
    "shifted by eight cells": (row, column) => map[row][column + 8],
    "four fifths as high": (row, column) => 0.8 * map[row][column],
  };
  for (const [how, of] of Object.entries(wrong)) check(worst(of) > bound, `a map that is ${how} would pass`);
  // The profile at C = 0 runs along the middle row.
  const half = (drawn["error-map"][0].x[size - 1] * size) / (size - 1);
  const profile = drawn.profile[0];
  for (let k = 0; k < VALUES; k += 1) {
    const at = Math.floor(((k + 0.5) * profile.x.length) / VALUES);
    const column = Math.floor((profile.x[at] / half + 1) * 0.5 * size);
    const mean = 0.5 * (there(size / 2 - 1, column) + there(size / 2, column));
    check(Math.abs(profile.y[at] - mean) < bound, `profile at ${profile.x[at]} mm: ${profile.y[at]}, not ${mean} nm`);
  }
  // The mean over the points of each ring.
  const mean = drawn["radial-mean"][0];
  for (let k = 1; k < VALUES; k += 1) {
    const at = Math.floor((k * (mean.x.length - 4)) / VALUES);
    const cells = [];
    for (let row = 0; row < size; row += 1) for (let column = 0; column < size; column += 1) {
      const [x, y] = [column, row].map((index) => ((2 * index + 1) / size - 1) * half);
      if (Math.abs(Math.sqrt(x * x + y * y) - mean.x[at]) < half / size) cells.push(there(row, column));
    }
    const of = cells.reduce((a, b) => a + b, 0) / cells.length;
    check(Math.abs(mean.y[at] - of) < bound, `radial mean at ${mean.x[at]} mm: ${mean.y[at]}, not ${of} nm`);
  }
}

// Feed, points and speed of the page against the rows of the table, on ten turns.
function againstTable([feed, points, speed], radii) {
  const [head, ...lines] = fs.readFileSync(path.join(run, "toolpath.csv"), "utf8").trim().split("\n");
  const names = head.split(",");
  const rows = lines.map((text) => Object.fromEntries(text.split(",").map((value, i) => [names[i], Number(value)])));
  const whole = rows.map((row, i) => ({ ...row, i })).filter((row) => Math.abs(row.c_deg / 360 - Math.round(row.c_deg / 360)) < 1e-9);
  check(whole.length > VALUES, `only ${whole.length} whole turns in the table`);
  // An entry of the page may stand for several turns.
  const turns = Math.round((whole.length - 1) / radii.length);
  for (let k = 0; k < VALUES; k += 1) {
    const at = Math.floor((k * (radii.length - 2)) / VALUES);
    const [from, to] = [whole[at * turns], whole[(at + 1) * turns]];
    near(feed[at], (1e3 * Math.abs(to.x_mm - from.x_mm)) / turns, 1e-5, `feed of turn ${at}`);
    near(points[at], (to.i - from.i) / turns, 1e-6, `points of turn ${at}`);
    near(speed[at], (60 * turns) / (to.time_s - from.time_s), 1e-5, `speed of turn ${at}`);
  }
}

async function ablationFigures(browser) {
  const { page } = await open(browser, ablation, 1400, "light");
  const drawn = Object.fromEntries((await figures(page)).map((one) => [one.id, one.traces]));
  const { runs } = JSON.parse(fs.readFileSync(path.join(ablation, "ablation.json"), "utf8"));
  const measured = runs.filter((one) => !one.error);
  same(drawn["points-error"][0].x, measured.map((one) => one.control_points), "points");
  same(drawn["points-error"][0].y, measured.map((one) => one.interpolation_error.max_nm), "errors");
  same(drawn["time-acceleration"][0].x, measured.map((one) => one.cutting_time_s), "times");
  measured.forEach((one, i) => {
    same(drawn["radial-means"][i].y, decoded(one.sketch.radial_mean.error_nm), `radial mean ${i}`);
    same(drawn.spectra[i].y, decoded(one.sketch.harmonics_nm).slice(1), `spectrum ${i}`);
  });
  const cells = drawn["error-maps"][0].z.flat().filter((value) => value !== null && Number.isFinite(value));
  const expected = measured.flatMap((one) => [...decoded(one.sketch.map.error_nm)].filter(Number.isFinite));
  check(cells.length === expected.length, `${cells.length} cells of maps, not ${expected.length}`);
  const sum = (values) => values.reduce((a, b) => a + b, 0);
  near(sum(cells), sum(expected), 1e-9, "sum of all cells");
  await sorts(page, runs);
  await page.close();
}

// Each heading sorts the rows, and a second click turns them round.
async function sorts(page, runs) {
  const heads = page.locator("table.runs th");
  const rows = () => page.evaluate(() => [...document.querySelectorAll("table.runs tbody tr")]
    .map((row) => [...row.cells].map((cell) => (cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value)))));
  const columns = await heads.count();
  check(columns > 5, `${columns} columns`);
  for (let column = 0; column < columns; column += 1) for (const direction of [1, -1]) {
    await heads.nth(column).click();
    const all = await rows();
    check(all.length === runs.length, `${all.length} rows, not ${runs.length}`);
    const values = all.map((row) => row[column]).filter((value) => value !== undefined && value !== "");
    for (let i = 1; i < values.length; i += 1) {
      const [one, other] = [values[i - 1], values[i]];
      if (typeof one !== typeof other) continue;
      const less = typeof one === "number" ? one - other : one.localeCompare(other, "en", { numeric: true });
      check(direction * less <= 0, `column ${column}: ${one} before ${other}`);
    }
  }
}

(async () => {
  fs.mkdirSync(pictures, { recursive: true });
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
  try {
    await looks(browser, "run", run);
    await prints(browser, "run", run);
    await runFigures(browser);
    await looks(browser, "ablation", ablation);
    await prints(browser, "ablation", ablation);
    await ablationFigures(browser);
  } finally {
    await browser.close();
  }
  console.log(`${checks} checks hold; look at the pictures in ${pictures}`);
})().catch((error) => {
  console.error(error.message);
  process.exit(1);
});
